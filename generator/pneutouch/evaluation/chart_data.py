"""What the trade-off chart and the tuning chart draw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from pneutouch.arrays import Array
from pneutouch.selection.front import TradeOffFront


class TuningCurve(NamedTuple):
    """Sensitivity (kPa/N) over driving pressure (kPa), (n,) each."""

    label: str
    pressure: Array
    sensitivity: Array


@dataclass(frozen=True)
class TuningChart:
    """One design's curve from no pressure to its rated one.

    Attributes:
        chosen: The curve.
        low: Lower end of its k = 2 interval, kPa/N, (n,).
        high: Upper end, (n,).
        working: Driving pressures it is meant for and the sensitivities there, kPa to kPa/N.
        others: Designs to compare with.
        published: Measured sensitivities of this very sensor, kPa to kPa/N.
    """

    chosen: TuningCurve
    low: Array
    high: Array
    working: dict[float, float]
    others: tuple[TuningCurve, ...] = ()
    published: tuple[tuple[float, float], ...] = ()


class ChartPoint(NamedTuple):
    """A design on the chart: title of its resin, what to call it, kPa/N and N."""

    resin: str
    label: str
    sensitivity: float
    force: float


@dataclass(frozen=True)
class TradeOff:
    """Fronts at one driving pressure.

    Attributes:
        fronts: One a resin; empty ones are left out.
        pressure: Driving pressure, kPa.
        gauge: Pressure rise that the pressure sensor has left, kPa.
        window: Least and greatest sensitivity wanted (kPa/N), None where free.
        force: Least force range wanted, N; None where free.
        spots: Designs, the first picked out.
    """

    fronts: tuple[TradeOffFront, ...]
    pressure: float
    gauge: float
    spots: tuple[ChartPoint, ...]
    window: tuple[float, float] | None = None
    force: float | None = None

    @property
    def known(self) -> tuple[TradeOffFront, ...]:
        """The fronts with a line to draw."""
        return tuple(front for front in self.fronts if front.sensitivity.size > 1)
