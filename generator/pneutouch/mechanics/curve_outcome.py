"""A record: a sensor in a mix by one of the mixing curves of its pair."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pneutouch.mechanics.prediction import SensorState
from pneutouch.spec.material import MixByCurve
from pneutouch.units import KPA


@dataclass(frozen=True)
class CurveOutcome:
    """The sensor by one mixing curve.

    states: as many of the design's driving pressures as it can be inflated to, from the lowest. rated: rated pressure,
    MPa; None if nothing could be solved.
    """

    by_curve: MixByCurve
    states: tuple[SensorState, ...]
    rated: float | None

    def document(self) -> dict[str, Any]:
        """The outcome as data."""
        by_curve = self.by_curve
        return {
            "curve": by_curve.curve,
            "place": by_curve.place,
            "shear_modulus_MPa": by_curve.shear_modulus_MPa.nominal,
            "beyond_last_point": by_curve.beyond,
            "rated_pressure_kPa": None if self.rated is None else self.rated / KPA,
            "states": [self._state(state) for state in self.states],
        }

    @staticmethod
    def _state(state: SensorState) -> dict[str, Any]:
        figures = state.figures
        return {
            "driving_pressure_kPa": state.driving_pressure / KPA,
            "sensitivity_kPa_per_N": None if figures is None else figures.sensitivity_kPa_per_N,
            "force_range_end_N": None if figures is None else figures.force_range[1],
        }
