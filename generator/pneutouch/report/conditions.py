"""Rows of a datasheet on environment, gauge, speed, contact off the axis and mixing curves."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.mechanics.prediction import CurveOutcome, SensorState
from pneutouch.parts.air_path import UNKNOWN_END
from pneutouch.report.blocks import Items, SheetBlock, SheetTable, Text, section
from pneutouch.report.numbers import DASH
from pneutouch.report.prose import WORDS
from pneutouch.units import KPA, ML
from pneutouch.wording import tenths_below

NOT_TESTED = "not tested"


def environment(sheet: SheetData) -> list[list[str]]:
    """Rows on the environment: quantity, value and basis."""
    rows = _air(sheet)
    material = sheet.scene.membrane_material
    if material.shore_a and material.shore_a_one_year:
        text = f"Shore A {material.shore_a.text()} to {material.shore_a_one_year.text()}"
        rows.append(["Ageing, one year in light and air", text, "paper, Table 1"])
    return [*rows, ["Humidity, oils, ozone, UV", NOT_TESTED, ""]]


def _air(sheet: SheetData) -> list[list[str]]:
    """Rows on zero drift and fast contact at the lowest driving pressure from ambient on and at the highest.

    Outside the atlas the drift is that at the lowest one, and fast contact is unknown."""
    gas, states = sheet.gas, sheet.prediction.states
    first = next((k for k, state in enumerate(states) if state.driving_pressure >= 0.0), 0)
    ends = sorted({first, len(states) - 1}) if gas is not None else [0]
    at = " and ".join(f"{states[k].driving_pressure / KPA:g}" for k in ends) + " kPa"

    def values(numbers: Array, form: str, unit: str) -> str:
        return _values([float(numbers[k]) for k in ends], form, unit)

    drift, over = f"ideal gas in the yielding dome at {at}, 20 °C", f"drift over the predicted sensitivity, at {at}"
    if gas is None:
        figures, drifts_kPa_per_K = states[0].figures, np.array([sheet.zero_drift_kPa_per_K])
        forces = np.array([np.nan]) if figures is None else drifts_kPa_per_K / figures.sensitivity
        fast = ["not known", "computed for sensors inside the atlas alone"]
    else:
        drifts_kPa_per_K, forces = gas.by_temperature_kPa_per_K, gas.force_by_temperature
        drift += f"; a rigid cavity would show {values(1 / gas.wall_give, '.1f', 'times')} as much"
        said = f"sensitivity with adiabatic over that with isothermal air, over the same travel at {at}"
        fast = [values(gas.fast_over_slow, ".2f", "times"), said]
    return [
        ["Zero drift of the sealed gas", values(drifts_kPa_per_K, ".2f", "kPa/K"), drift],
        ["the same as force", values(forces, ".2f", "N/K"), over],
        ["Fast contact", *fast],
    ]


def gauge_range(sheet: SheetData) -> list[str]:
    """Cells on the gauge: the range that it reads, its unit, and a note on it."""
    gauge, reading = sheet.scene.gauge, sheet.gauge
    note = f"{reading.title}, the paper's, assumed"
    if gauge is not None:
        # A space of no width after every eighth character, at which a narrow column may break the code.
        code = "\u200b".join(gauge.order_code[start : start + 8] for start in range(0, len(gauge.order_code), 8))
        note = f"{reading.title} ({code})"
    if gauge is not None and gauge.is_absolute:
        note += (
            f"; absolute, {gauge.range_kPa.low:g} to {gauge.range_kPa.high:g} kPa: it reads the ambient pressure too, "
            "which must be subtracted"
        )
    return [f"{reading.reads_from_kPa:.4g} to {reading.reads_to_kPa:.4g}", "kPa gauge", note]


def gauge_volume(sheet: SheetData) -> str:
    """Volume that the gauge adds to the dead volume, in words; empty if the design names no gauge."""
    gauge = sheet.scene.gauge
    if gauge is None:
        return ""
    if gauge.inner_volume_mL is None:
        return "; the gauge's own volume is not known and not counted"
    return f" and gauge {sheet.assembly.gauge_volume_mL:.3f} mL"


def detection(sheet: SheetData) -> list[list[str]]:
    """Rows (quantity, value, basis) on the smallest force detected, also at first contact, where it is known."""
    reading = sheet.gauge
    forces = [one for one in reading.states if one.smallest_force_N is not None] or reading.states
    ends = forces if len(forces) < 2 else (forces[0], forces[-1])
    at = " and ".join(f"{one.driving_pressure_kPa:g}" for one in ends) + " kPa"
    if reading.threshold_kPa is None:
        return [["Smallest force detected", "not known", f"{reading.limited_by} ({reading.title})"]]
    warming = _values([one.warming_that_reads_as_smallest_force_K for one in ends], ".2g", "K")
    smallest = _values([one.smallest_force_N for one in ends], ".2g", "N")
    touched = _values([one.smallest_force_at_first_contact_N for one in ends], ".2g", "N")
    band = "" if reading.rate_Hz is None else f", to {reading.rate_Hz / 2:g} Hz"
    basis = f"{reading.criterion}{band}, at {at}; limited by {reading.limited_by} ({reading.title})"
    return [
        ["Smallest force detected", smallest, basis],
        ["at first contact", touched, f"warming by {warming} reads as much as the row above, at {at}"],
    ]


def speed_rows(sheet: SheetData) -> list[list[str]]:
    """Rows (quantity, value, basis) on speed at the lowest and highest driving pressure; none if not computed."""
    if sheet.speed is None:
        return []
    first = {state.driving_pressure_kPa: state for state in reversed(sheet.speed.states)}
    states = [first[pressure] for pressure in sorted(first)]
    ends = [states[0], states[-1]] if len(states) > 1 else [states[0]]
    rate_Hz = sheet.speed.gauge_rate_Hz
    gauge = "" if rate_Hz is None else f"; the gauge reads {rate_Hz:g} times a second"
    bands = ", ".join(dict.fromkeys(state.bandwidth_limited_by or DASH for state in ends))
    narrow = ", ".join(dict.fromkeys(state.within_5_percent_limited_by or DASH for state in ends))
    resonances_Hz = _values([state.first_resonance_Hz for state in ends], ".3g", "Hz")
    lowest_Hz = [state.first_resonance_low_Hz for state in ends]
    lower = (
        ""
        if None in lowest_Hz
        else f"; {_values(lowest_Hz, '.3g', 'Hz')} with {UNKNOWN_END / ML:g} mL in the gauge, whose volume is not known"
    )
    bandwidths_Hz = _values([state.bandwidth_3_dB_Hz for state in ends], ".3g", "Hz")
    after = _values([state.delay_ms for state in ends], ".2g", "ms")
    rise = _values([state.rise_time_ms for state in ends], ".2g", "ms")
    return [
        ["At", _values([state.driving_pressure_kPa for state in ends], "g", "kPa"), "driving pressure"],
        ["First resonance", resonances_Hz, f"line as drawn, force at first contact{lower}"],
        ["Bandwidth", bandwidths_Hz, f"gain within 3 dB; limit: {bands}{gauge}"],
        ["Gain within 5 %", _values([state.within_5_percent_Hz for state in ends], ".2g", "Hz"), f"limit: {narrow}"],
        ["Rise time", rise, f"10 to 90 %, step of force; half after {after}"],
    ]


def _values(numbers: Sequence[float | None], form: str, unit: str) -> str:
    """Numbers side by side with their unit; a dash for one that is not known."""
    texts = [DASH if number is None or not np.isfinite(number) else format(number, form) for number in numbers]
    return f"{' and '.join(texts)} {unit}"


def off_axis(states: tuple[SensorState, ...]) -> list[SheetBlock]:
    """Tables on contact off the axis and on an object that then moves sideways; none without such contact."""
    blocks: list[SheetBlock] = []
    for rows, words in ((_off_axis_rows(states), WORDS["off_axis"]), (shear_rows(states), WORDS["shear"])):
        if rows:
            columns = range(len(words["head"]))
            blocks += [SheetTable(rows, words["head"], numeric=columns, turned=True), Text(words["note"], "muted")]
    return blocks


def _off_axis_rows(states: tuple[SensorState, ...]) -> list[list[str]]:
    """One row per driving pressure that was pressed off the axis."""
    rows = []
    for state in states:
        beyond = state.beyond_axis
        if beyond is None:
            continue
        end = min(state.range_end, float(state.indentation[-1]))
        curves = (state.force, beyond.sideways, beyond.moment)
        force, sideways, moment = (float(np.interp(end, state.indentation, curve)) for curve in curves)
        figures = f"{end:.2f}", f"{force:.3f}", f"{sideways:.3f}", f"{moment:.2f}", f"{beyond.order}"
        rows.append([f"{state.driving_pressure / KPA:g}", *figures, f"{100.0 * beyond.last_change:.2g}"])
    return rows


def shear_rows(states: tuple[SensorState, ...]) -> list[list[str]]:
    """One row per driving pressure at which the object moved sideways; a dash for a figure that was not reached."""
    rows = []
    for state in states:
        sheared = None if state.beyond_axis is None else state.beyond_axis.shear
        if sheared is None:
            continue
        columns = (
            (sheared.travel, ".2f"),
            (sheared.force, ".3f"),
            (sheared.sideways, ".3f"),
            (sheared.moment, ".2f"),
            (sheared.rise / KPA, ".2f"),
        )
        ends = [f"{column[-1]:{digits}}" if column.size else "-" for column, digits in columns]
        peak = "-" if sheared.peak is None else f"{sheared.peak:.3f}"
        slips = "-" if sheared.slips_from is None else f"{sheared.slips_from:.2f}"
        rows.append([f"{state.driving_pressure / KPA:g}", *ends, peak, slips])
    return rows


def mixing_section(sheet: SheetData) -> list[SheetBlock]:
    """Section on the design by each of its mixing curves, a column each, softest first; none without curves."""
    curves = sheet.curves
    head = ["Figure", *(f"{one.by_curve.curve}: {one.by_curve.place}" for one in curves), "Unit"]
    rows = [["Mean shear modulus", *(f"{one.by_curve.shear_modulus_MPa.nominal:.2f}" for one in curves), "MPa"]]
    for k, state in enumerate(sheet.prediction.states):
        at = f"at {state.driving_pressure / KPA:g} kPa"
        states = [one.states[k] if k < len(one.states) else None for one in curves]
        rows.append([f"Sensitivity {at}", *map(_sensitivity, states), "kPa/N"])
        rows.append([f"Force range {at}", *map(_range, states), "N"])
    rows.append(["Rated pressure", *map(_rated, curves), "kPa"])
    beyond = ", ".join(one.by_curve.curve for one in curves if one.by_curve.beyond)
    words = WORDS["mixing"]
    lines = [words["caption"], *([words["beyond"].format(curves=beyond)] if beyond else [])]
    blocks = (SheetTable(rows, head, numeric=range(1, len(head) - 1)), Items(lines)) if curves else ()
    return section("By every mixing curve", *blocks)


def _sensitivity(state: SensorState | None) -> str:
    return DASH if state is None or state.figures is None else f"{state.figures.sensitivity:.3f}"


def _range(state: SensorState | None) -> str:
    if state is None or state.figures is None:
        return DASH
    low, high = state.figures.force_range
    return f"{low:.1f} to {high:.1f}"


def _rated(outcome: CurveOutcome) -> str:
    return DASH if outcome.rated is None else f"{tenths_below(outcome.rated / KPA):.1f}"
