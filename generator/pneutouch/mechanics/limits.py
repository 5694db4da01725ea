"""Limits of the driving pressure of a sensor: limit point, break strain of the resin, range of the gauge."""

from dataclasses import dataclass

RATED_SHARE = 0.9
"""Rated pressure over the binding limit; above it a warning is given: the dome grows fast near the limit point."""

LAW_RANGE = "law range"
"""Name of the limit and event beyond which the wall is stretched further than the data its law was fitted to."""


@dataclass(frozen=True, slots=True)
class LimitPoint:
    """The maximum of the inflation curve: apex heights in mm, driving pressure in MPa."""

    apex_inner: float
    apex_outer: float
    driving_pressure: float
    thickness_stretch: float

    @property
    def membrane_stretch(self) -> float:
        """In-plane stretch."""
        return float(self.thickness_stretch**-0.5)


@dataclass(frozen=True, slots=True)
class Limits:
    """Driving pressures (MPa) at which each limit is met; None if it is not met before the limit point.

    ``law_range``: pressure at which the wall leaves the stretches that its law was fitted over, if the law states them.
    """

    limit_point: float | None
    break_strain: float | None
    gauge: float
    law_range: float | None = None

    @property
    def binding(self) -> str:
        """Name of the limit met first."""
        return min(self.named(), key=lambda item: item[1])[0]

    @property
    def lowest(self) -> float:
        """The driving pressure at which the first limit is met, MPa."""
        return min(value for _, value in self.named())

    def named(self) -> list[tuple[str, float]]:
        """The limits that are met, with their names."""
        pairs = [
            ("limit point", self.limit_point),
            ("break strain", self.break_strain),
            (LAW_RANGE, self.law_range),
            ("gauge range", self.gauge),
        ]
        return [(name, value) for name, value in pairs if value is not None]
