"""Speed of a sensor's reading: its gas line as drawn, and the figures of every state."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics import Sensor, SensorPrediction, SensorState
from pneutouch.mechanics.line.dynamics import GasLine, LineElement, SensorDynamics
from pneutouch.mechanics.line.elements import AirState, Duct, GasVolume, Step
from pneutouch.mechanics.line.transient import BandFigures, StepFigures, band_figures, step_figures, with_end
from pneutouch.mechanics.viscous.prony import Prony, prony_series
from pneutouch.parts import Assembly
from pneutouch.parts.air_path import UNKNOWN_END, AirPiece, air_path
from pneutouch.results.behaviour import DynamicRecord, Dynamics, LinePiece
from pneutouch.units import KPA, ML
from pneutouch.wording import data_of, rounded

GAP = "gap"
"""Name of the piece of an air path that is a volume next to the cavity, not a duct."""

GAUGE_RATE = "sampling of the gauge"
"""Name of the limit of the bandwidth that the gauge sets; the other limit is named ``line``."""

_DIGITS = 6

EXCESS_GAIN, LONG = (1.5, 1.06), 1000.0
"""Greatest computed over measured gain of these tubes at the resonance: shorter than 1000 mm, and from there on."""

_SAME = 1e-6
"""Relative difference of dead volumes below which they count as equal."""


@dataclass(frozen=True, slots=True)
class DynamicState:
    """Dynamics at one driving pressure, MPa, by one ``source`` of relaxation data; None: the wall does not relax.

    ``lowest``: first resonance (Hz) and its gain with `UNKNOWN_END` at the gauge; None where the gauge's gas is known.
    """

    driving_pressure: float
    source: str | None
    dynamics: SensorDynamics
    band: BandFigures
    step: StepFigures
    lowest: tuple[float, float] | None = None

    def usable(self, rate_Hz: float | None) -> tuple[float | None, str | None]:
        """Bandwidth in Hz with a gauge of ``rate_Hz`` (None: unknown), and the effect that limits it."""
        line = self.band.bandwidth
        nyquist = None if rate_Hz is None else 0.5 * rate_Hz
        if nyquist is not None and (line is None or nyquist < line):
            return nyquist, GAUGE_RATE
        return line, None if line is None else "line"


@dataclass(frozen=True, slots=True)
class SensorBandwidth:
    """Limits of a sensor over time.

    Attributes:
        pieces: The air's path as drawn.
        end_volume: Gas behind the path, mm3: of the gauge, or the excess of the stated dead volume.
        note: Note if the stated dead volume is less than that of the path; else None.
        rate_Hz: Readings a second of the gauge; None if that is unknown.
        states: One for each driving pressure and series of relaxation data.
    """

    pieces: tuple[AirPiece, ...]
    end_volume: float
    note: str | None
    rate_Hz: float | None
    states: tuple[DynamicState, ...]


def sensor_bandwidth(assembly: Assembly, sensor: Sensor, prediction: SensorPrediction) -> SensorBandwidth:
    """Dynamics of every state for a small step of force at first contact, by every series of relaxation data."""
    pieces, end, note = line_of(assembly, sensor)
    series: tuple[Prony | None, ...] = prony_series(assembly.scene.membrane_material) or (None,)
    states = []
    for state in prediction.states:
        for one in series:
            dynamics = state_dynamics(assembly, sensor, state, one, free_compliance(prediction, state))
            source = None if one is None else one.source
            known = end > 0.0 or assembly.known_gauge_volume_mL is not None
            lowest = None if known else with_end(dynamics, UNKNOWN_END)
            figures = band_figures(dynamics), step_figures(dynamics), lowest
            states.append(DynamicState(state.driving_pressure, source, dynamics, *figures))
    return SensorBandwidth(pieces, end, note, gauge_rate_Hz(assembly.scene), tuple(states))


def line_of(assembly: Assembly, sensor: Sensor) -> tuple[tuple[AirPiece, ...], float, str | None]:
    """The path as drawn, the gas behind it (mm3), and a note where the stated dead volume is less than the path's."""
    pieces = air_path(assembly.scene, assembly.layout)
    drawn, stated = sum(piece.volume for piece in pieces), sensor.gas.dead_volume
    if stated >= drawn * (1.0 - _SAME):
        return pieces, max(0.0, stated - drawn) if stated > drawn * (1.0 + _SAME) else 0.0, None
    note = (
        f"the dead volume of {stated / ML:.3g} mL is less than the {drawn / ML:.3g} mL of connector and tube as drawn; "
        "the dynamics are those of the line as drawn"
    )
    return pieces, assembly.gauge_volume_mL * ML, note


def state_dynamics(
    assembly: Assembly, sensor: Sensor, state: SensorState, series: Prony | None, compliance: float
) -> SensorDynamics:
    """Linear dynamics of a state for small changes; ``compliance`` of the wall in mm3/MPa, ``series`` None: elastic."""
    pieces, end, _ = line_of(assembly, sensor)
    air = AirState(sensor.gas.ambient_pressure + state.driving_pressure)
    elements: list[LineElement] = [GasVolume(piece.volume) for piece in pieces if piece.name == GAP]
    ducts = [Duct(piece.length, piece.radius) for piece in pieces if piece.name != GAP]
    for before, duct in pairwise([Duct(0.0, np.inf), *ducts]):
        elements += [Step(before.radius, duct.radius), duct]
    if end:
        elements += [*(Step(duct.radius, np.inf) for duct in ducts[-1:]), GasVolume(end)]
    # The inflated wall is taken as a cap of a sphere over the base plane.
    radius = assembly.layout.inner_radius
    surface = np.pi * (2.0 * radius**2 + state.apex_inner**2)
    return SensorDynamics(
        GasVolume(state.cavity_volume, surface),
        GasLine(tuple(elements), air),
        compliance,
        () if series is None else tuple(series.excess.tolist()),
        () if series is None else series.times,
    )


def free_compliance(prediction: SensorPrediction, state: SensorState) -> float:
    """Volume compliance of the inflated dome without contact, mm3/MPa.

    At first contact it also holds under a constant force: the plate rides on the dome.
    """
    curve = prediction.inflation
    slope = float(np.interp(state.cavity_volume, curve.volume, np.gradient(curve.pressure, curve.volume)))
    return 1.0 / max(slope, 1e-12)


def gauge_rate_Hz(scene: ResolvedDesign) -> float | None:
    """Readings a second of the design's gauge; None if it names none or the rate is unknown."""
    gauge = scene.gauge
    rate = None if gauge is None else gauge.rate_Hz
    return None if rate is None else rate.nominal


def dynamics(figures: SensorBandwidth) -> Dynamics:
    """Record of the bandwidth in boundary units, see docs/background/dynamics.md."""
    record = Dynamics(
        basis=BASIS,
        line=tuple(
            LinePiece(piece.name, piece.length, 2.0 * piece.radius, piece.volume / ML) for piece in figures.pieces
        ),
        end_volume_mL=figures.end_volume / ML,
        gauge_rate_Hz=figures.rate_Hz,
        states=tuple(_state_record(state, figures.rate_Hz) for state in figures.states),
        note=figures.note,
    )
    return rounded(record, _DIGITS)


BASIS = tuple(data_of(__file__)["basis"])


def _state_record(state: DynamicState, rate_Hz: float | None) -> DynamicRecord:
    band, step, excess = state.band, state.step, EXCESS_GAIN[state.dynamics.line.length >= LONG]
    usable_Hz, limited = state.usable(rate_Hz)
    return DynamicRecord(
        driving_pressure_kPa=state.driving_pressure / KPA,
        relaxation_source=state.source,
        first_resonance_Hz=band.resonance,
        resonance_gain=band.resonance_gain,
        first_resonance_low_Hz=None if state.lowest is None else state.lowest[0],
        resonance_gain_low=None
        if state.lowest is None
        else min(state.lowest[1], (band.resonance_gain or 0.0) / excess),
        bandwidth_3_dB_Hz=usable_Hz,
        bandwidth_limited_by=limited,
        within_5_percent_Hz=band.within_tolerance,
        within_5_percent_limited_by=band.limited_by,
        delay_ms=1e3 * step.delay,
        rise_time_ms=1e3 * step.rise_time,
        overshoot_percent=100.0 * step.overshoot,
        fast_gas_over_slow=state.dynamics.at_once().fast_gas,
        fast_wall_over_slow=state.dynamics.fast_wall,
    )
