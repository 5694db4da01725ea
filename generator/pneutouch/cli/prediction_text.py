"""Predictions, findings and lists as text for people: tables that fit a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pneutouch.arrays import grouped
from pneutouch.cli.terminal import table_text
from pneutouch.mechanics.events import WARNED
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.wording import SIMULATED, counted, held_by, tenths_below, unknown_at

if TYPE_CHECKING:
    from pneutouch.results.behaviour import CalibratedBy, ContactAnywhere, DynamicRecord, Dynamics, Viscous
    from pneutouch.results.prediction import LimitPointRecord, PredictionRecord, RatingRecord, StateRecord
    from pneutouch.results.uncertainty import FigureRecord, IntervalRecord


def dynamics_lines(dynamics: Dynamics) -> list[str]:
    """Bandwidth and rise time at the highest driving pressure, one line a series of relaxation data."""
    highest_kPa = dynamics.states[-1].driving_pressure_kPa
    states = [state for state in dynamics.states if state.driving_pressure_kPa == highest_kPa]
    lines = []
    for k, state in enumerate(states):
        data = "" if state.relaxation_source is None else f", data {chr(ord('A') + k)}"
        lines.append(f"at {highest_kPa:g} kPa{data}: {_figures(state)}")
    return [*lines, *([f"note: {dynamics.note}"] if dynamics.note is not None else [])]


def _figures(state: DynamicRecord) -> str:
    parts = []
    if state.first_resonance_Hz is not None:
        low_Hz, low = state.first_resonance_low_Hz, state.resonance_gain_low
        least_Hz, least = ("", "") if low_Hz is None else (f"{low_Hz:.3g} to ", f"{low:.2g} to ")
        peak_Hz, gain = f"{least_Hz}{state.first_resonance_Hz:.3g} Hz", f"{least}{state.resonance_gain:.2g}"
        parts.append(f"first resonance {peak_Hz} (gain {gain})")
    if state.bandwidth_3_dB_Hz is not None:
        parts.append(f"gain within 3 dB up to {state.bandwidth_3_dB_Hz:.3g} Hz ({state.bandwidth_limited_by})")
    if state.within_5_percent_Hz is not None:
        parts.append(f"within 5 % up to {state.within_5_percent_Hz:.2g} Hz ({state.within_5_percent_limited_by})")
    parts.append(f"step of force: delay {state.delay_ms:.2g} ms, rise {state.rise_time_ms:.2g} ms")
    return ", ".join(parts)


def prediction_text(prediction: PredictionRecord) -> str:
    """The prediction as a table, with limits, events, the interval of the sensitivity and the model's error."""
    closure = f" ({prediction.closure} contact)" if prediction.closure else ""
    error = prediction.error_estimate
    far = "unknown" if error.sensitivity_relative is None else f"up to {error.sensitivity_relative:.0%}"
    idealised = ", the paper's idealisation" if prediction.dead_volume_note is not None else ""
    assert prediction.rating is not None and prediction.viscous is not None and prediction.dynamics is not None
    lines = [
        f"{prediction.design}: model {prediction.model}{closure}, dead volume {prediction.dead_volume_mL:.3f} mL"
        f"{idealised}",
        *_calibrated(prediction.calibration),
        f"{_reach(prediction.limit_point)}; the {prediction.limits.binding} binds",
        *_rating(prediction.rating),
        "",
        _state_table(prediction.states),
        "",
        *_as_drawn(prediction),
        *(_filled(prediction.filled) if prediction.filled else ()),
        *_warned(prediction),
        *_sheared(prediction.states),
        f"error in sensitivity {far}: {error.sensitivity_basis}",
        *([] if error.model_choice is None else [f"model {prediction.model}: {error.model_choice}"]),
        *_uncertainty(prediction.states),
        *_anywhere(prediction.contact_anywhere),
        *_viscous(prediction.viscous),
        *dynamics_lines(prediction.dynamics),
    ]
    if aged := prediction.aged:
        lines.append(f"aged one year: modulus times {aged.modulus_ratio:.3f} by its hardness; {aged.assumes}")
    return "\n".join(lines)


def _anywhere(contact: ContactAnywhere | None) -> list[str]:
    """Line on the uncertainty of the force read if place and object of contact are unknown; empty if not stated."""
    if contact is None:
        return []
    if contact.unknown is not None:
        return [f"contact anywhere: not stated, {contact.unknown}"]
    shares = [
        f"{state.standard_uncertainty_relative:.0%} at {state.driving_pressure_kPa:g} kPa" for state in contact.states
    ]
    return [f"contact anywhere: standard uncertainty of the force read {', '.join(shares)}, counted in the interval"]


def _calibrated(calibration: CalibratedBy | None) -> list[str]:
    """Line on the specimen, measured or simulated, that the figures hold for; empty without calibration."""
    if calibration is None:
        return []
    made = f"{SIMULATED}: " if calibration.simulated else ""
    return [f"{made}calibration {calibration.name}: the figures are those of sensor {calibration.sensor} alone"]


def _reach(point: LimitPointRecord | None) -> str:
    if point is None:
        return "no limit point"
    inner, outer = point.apex_height_inner_mm, point.apex_height_outer_mm
    return f"limit point {point.driving_pressure_kPa:.2f} kPa at {inner:.2f} mm inside, {outer:.2f} mm outside"


def _rating(rating: RatingRecord) -> list[str]:
    """The rated pressure with its basis, advice that would raise it, and the driving pressures above it."""
    lines = [f"rated pressure {tenths_below(rating.rated_pressure_kPa):.1f} kPa: {rating.basis}"]
    lines += [] if rating.remedy is None else [f"to raise it: {rating.remedy}"]
    lines += [] if rating.least_pressure_basis is None else [f"least driving pressure {rating.least_pressure_basis}"]
    return lines + [f"{finding.severity}: {finding.message}" for finding in rating.findings]


def _state_table(states: Sequence[StateRecord]) -> str:
    sampled = ["sampled"] if any(_sampled(state) is not None for state in states) else []
    head = ["kPa", "apex in mm", "apex out mm", "S kPa/N", "interval (k = 2)", *sampled]
    head += ["R2", "N/mm at 1 mm", "3 mm", "mean", "range N", "range ends at"]
    rows = []
    for state in states:
        row = [
            f"{state.driving_pressure_kPa:g}",
            f"{state.apex_height_inner_mm:.3f}",
            f"{state.apex_height_outer_mm:.3f}",
            _optional(state.sensitivity_kPa_per_N, ".3f"),
            _known(state, SENSITIVITY_KEY),
            *(_interval(_sampled(state)) for _ in sampled),
            _optional(state.r_squared, ".4f"),
            _optional(state.stiffness_at_1mm_N_per_mm, ".3f"),
            _optional(state.stiffness_at_3mm_N_per_mm, ".3f"),
            _optional(state.stiffness_N_per_mm, ".3f"),
            "-" if state.force_range_N is None else f"0-{state.force_range_N[1]:.2f}",
            _range_end(state),
        ]
        rows.append(row)
    return table_text(head, rows)


def _as_drawn(prediction: PredictionRecord) -> list[str]:
    """Lines on the figures with the gas as drawn, if the design states a dead volume of zero; else empty."""
    volume_mL = prediction.dead_volume_as_drawn_mL
    if volume_mL is None:
        return []
    head = f"with the {volume_mL:.2f} mL that connector and tube hold as drawn"
    if not prediction.as_drawn:
        return [f"{head}: --set pneumatics.dead_volume_mL={volume_mL:.2f}", ""]
    rows = [[f"{state.driving_pressure_kPa:g}", *_figures_cells(state)] for state in prediction.as_drawn]
    return [f"{head} ({prediction.as_drawn_model}):", table_text(["kPa", *_FIGURES_HEAD], rows), ""]


def _filled(states: Sequence[StateRecord]) -> list[str]:
    """Lines on the states of a prediction that are given by their filling."""
    rows = []
    for state in states:
        held = state.held
        assert held is not None
        rows.append(
            [
                f"{held.injected_volume_mL:.3f}",
                f"{state.driving_pressure_kPa:.3f}",
                _known(state, "driving_pressure_kPa", ".1f"),
                f"{state.apex_height_outer_mm:.3f}",
                held_by(held.stable_regulated, held.stable_sealed),
                _known(state, SENSITIVITY_KEY),
                *_figures_cells(state),
            ]
        )
    head = ["mL in", "kPa", "kPa (k = 2)", "apex out mm", "held by", "S (k = 2)", *_FIGURES_HEAD]
    return ["by injected gas, mL at ambient pressure:", table_text(head, rows), ""]


_FIGURES_HEAD = ["S kPa/N", "N/mm", "range N", "range ends at"]


def _figures_cells(state: StateRecord) -> list[str]:
    return [
        _optional(state.sensitivity_kPa_per_N, ".3f"),
        _optional(state.stiffness_N_per_mm, ".3f"),
        "-" if state.force_range_N is None else f"0-{state.force_range_N[1]:.2f}",
        _range_end(state),
    ]


def _range_end(state: StateRecord) -> str:
    ends = [event.kind for event in state.events if event.ends_range]
    return f"{ends[0] if ends else 'depth'}, {state.range_end_mm:.2f} mm"


def _warned(prediction: PredictionRecord) -> list[str]:
    """Events to warn of, one line a kind with the travels at which it begins."""
    places = grouped(
        ((event.kind, event.message), f"{event.indentation_mm:.2f} mm at {state.driving_pressure_kPa:.4g} kPa")
        for state in (*prediction.states, *prediction.filled)
        for event in state.events
        if event.kind in WARNED
    )
    return [f"warning: {kind} from {', '.join(found)}: {words}" for (kind, words), found in places.items()]


def _sheared(states: Sequence[StateRecord]) -> list[str]:
    """Figures of an object that moves sideways after pressing, one line a driving pressure."""
    lines = []
    for state in states:
        sheared = None if state.off_axis is None else state.off_axis.shear
        if sheared is None:
            continue
        peak, slips = sheared.peak_sideways_force_N, sheared.slips_throughout_mm
        parts = [] if peak is None else [f"greatest sideways force {peak:.3f} N"]
        parts += [f"slips throughout from {slips:.2f} mm"] if slips is not None else []
        parts += [f"ended: {sheared.ended}"] if sheared.ended is not None else []
        lines.append(f"moved sideways at {state.driving_pressure_kPa:g} kPa: {', '.join(parts)}")
    return lines


def _sampled(state: StateRecord) -> IntervalRecord | None:
    """The sampled interval of the sensitivity; None if nothing was sampled."""
    samples = None if state.uncertainty is None else state.uncertainty.monte_carlo
    return None if samples is None else samples.figures.get(SENSITIVITY_KEY)


def _known(state: StateRecord, figure: str, form: str = ".2f") -> str:
    return _interval(None if state.uncertainty is None else state.uncertainty.known.get(figure), form)


def _interval(ends: IntervalRecord | FigureRecord | None, form: str = ".2f") -> str:
    return "-" if ends is None else f"{ends.low:{form}} to {ends.high:{form}}"


def _uncertainty(states: Sequence[StateRecord]) -> list[str]:
    """Lines on where and why the uncertainty is not known, and on what to measure first for the highest pressure."""
    known = [(state.driving_pressure_kPa, state.uncertainty) for state in states if state.uncertainty is not None]
    summary = [f"at {at:g} kPa: {last.summary}" for at, last in known[-1:] if last.summary is not None]
    return [*unknown_at((pressure_kPa, one.unknown) for pressure_kPa, one in known), *summary]


def _viscous(viscous: Viscous) -> list[str]:
    """Relaxation and hysteresis at the highest driving pressure, over the sources; or why nothing is known."""
    if viscous.unknown is not None:
        return [f"relaxation and hysteresis not known: {viscous.unknown}"]
    last = viscous.states[-1]
    held = [one.relaxation.pressure_rise_loss_percent for one in last.by_source]
    quick = [one.hysteresis[-1] for one in last.by_source]
    wide = [getattr(one, "width_percent", None) for one in quick]
    speed = f"{quick[0].speed_mm_per_s:g} mm/s" if quick else ""
    return [
        f"held at {viscous.depth_mm:.2f} mm and {last.driving_pressure_kPa:g} kPa the pressure rise loses "
        f"{_span(held)} from 1 s to 600 s; hysteresis at {speed} {_span(wide)} of full scale "
        f"({counted(len(viscous.sources), 'source')} of relaxation data)",
        *viscous.basis[2:],
    ]


def _span(percents: list[float | None]) -> str:
    """Range of the known percentages, or a note that none is known."""
    known = [value for value in percents if value is not None]
    if not known:
        return "not known"
    ends = f"{min(known):.1f} %" if len(known) == 1 else f"{min(known):.1f} to {max(known):.1f} %"
    return ends if len(known) == len(percents) else f"{ends} (not known by every source)"


def _optional(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)
