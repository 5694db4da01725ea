"""Records of contact that is not axisymmetric, and of an object that moves sideways after pressing, in a prediction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NotRequired, TypedDict

from pneutouch.arrays import Array
from pneutouch.units import KPA


class ShearRecord(TypedDict):
    """A shear as ``predict`` prints it: lists of one length, and figures that are None if they are not reached."""

    shear_mm: list[float]
    contact_force_N: list[float]
    sideways_force_N: list[float]
    moment_N_mm: list[float]
    pressure_rise_kPa: list[float]
    sliding_percent: list[float]
    stiffness_N_per_mm: float | None
    peak_sideways_force_N: float | None
    slips_throughout_mm: float | None
    ended: str | None


@dataclass(frozen=True, slots=True)
class ShearCurve:
    """A shear at constant height (arrays of one length, mm, N, N mm, MPa; see `harmonic.shear`); ``travel`` and
    ``sideways`` are positive towards the offset."""

    travel: Array
    force: Array
    sideways: Array
    moment: Array
    rise: Array
    sliding: Array
    stiffness: float | None
    peak: float | None
    slips_from: float | None
    ended: str | None

    def scaled(self, force: float, rise: float) -> ShearCurve:
        """The curve with all forces and the pressure rise times factors."""
        return replace(
            self,
            force=force * self.force,
            sideways=force * self.sideways,
            moment=force * self.moment,
            rise=rise * self.rise,
            stiffness=None if self.stiffness is None else force * self.stiffness,
            peak=None if self.peak is None else force * self.peak,
        )

    def document(self) -> ShearRecord:
        """The curve in boundary units."""
        return {
            "shear_mm": self.travel.tolist(),
            "contact_force_N": self.force.tolist(),
            "sideways_force_N": self.sideways.tolist(),
            "moment_N_mm": self.moment.tolist(),
            "pressure_rise_kPa": (self.rise / KPA).tolist(),
            "sliding_percent": (100 * self.sliding).tolist(),
            "stiffness_N_per_mm": self.stiffness,
            "peak_sideways_force_N": self.peak,
            "slips_throughout_mm": self.slips_from,
            "ended": self.ended,
        }


class OffAxisRecord(TypedDict):
    """Additions of contact off the axis to a curve: the number of harmonics, the change by the last raise of their
    order (greatest of sensitivity, force, pressure rise and a shear's sideways force), and lists as long as the
    curve's."""

    harmonics: int
    last_change_percent: float
    sideways_force_N: list[float]
    moment_N_mm: list[float]
    shear: NotRequired[ShearRecord]


@dataclass(frozen=True, slots=True)
class RangeCurve:
    """A loading curve from first contact to the end of its range at equal steps (arrays of one length, mm, N, MPa), by
    Hermite cubics through the solved states and their slopes."""

    indentation: Array
    force: Array
    rise: Array


@dataclass(frozen=True, slots=True)
class OffAxisCurve:
    """Additions of contact off the axis to a loading curve (N, N mm; see `harmonic.press.OffAxisState`), the order of
    its harmonics, and the share by which the last raise of the order changed sensitivity, force or pressure rise.
    ``to_end`` is the curve between its points, to the very end of its range."""

    order: int
    last_change: float
    sideways: Array
    moment: Array
    to_end: RangeCurve
    shear: ShearCurve | None = None

    def scaled(self, force: float, rise: float) -> OffAxisCurve:
        """The curve with all forces and the pressure rise times factors."""
        sheared = None if self.shear is None else self.shear.scaled(force, rise)
        to_end = replace(self.to_end, force=force * self.to_end.force, rise=rise * self.to_end.rise)
        sideways, moment = force * self.sideways, force * self.moment
        return replace(self, sideways=sideways, moment=moment, to_end=to_end, shear=sheared)

    def document(self) -> OffAxisRecord:
        """The curve in boundary units."""
        record: OffAxisRecord = {
            "harmonics": self.order,
            "last_change_percent": 100 * self.last_change,
            "sideways_force_N": self.sideways.tolist(),
            "moment_N_mm": self.moment.tolist(),
        }
        if self.shear is not None:
            record["shear"] = self.shear.document()
        return record
