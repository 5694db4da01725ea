"""Plausibility of a run against its prediction: wrong units, signs and columns are reported, never corrected."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.questions import (
    DRIVING_FAR,
    FAR,
    RESET_KPA,
    RESET_SHARE,
    check_unpressed,
    looks_absolute,
    number,
    run_questions,
)
from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.source import as_option, exchanged, otherwise
from pneutouch.errors import InputError, shown
from pneutouch.spec.campaign import Column, ColumnMap
from pneutouch.tables.unit_words import ABSOLUTE as ABSOLUTE_UNIT
from pneutouch.tables.unit_words import UNITS
from pneutouch.units import KPA

UNIT_NEAR = 1.8
"""Factor within which another unit must bring a reading to the prediction: our choice, below `FAR`."""

BEYOND = 10.0
"""Ratio to the predicted force or rise that no other sensor explains: our choice, three times `FAR`. Above it another
unit explains a reading that it brings within `FAR`. A rise that is too small may be a leak."""

SWAP_MARGIN = math.log(2.0)
"""Margin (log of a factor) by which swapped readings must be nearer to the prediction, at zero driving pressure."""

_RESTS = 0.05
"""Share of the greatest force or rise by which points may be negative: noise about the origin."""

_STARTED, _STARTS, _REACHED, _LIKE, _UNLIKE = 4, 81, 0.8, 0.05, 0.3
"""Least number of points; number of places inside the dome tried as begin of a record; least share of its depth that is
compared; relative distances from the prediction below which it is met and above which it is missed: our choice."""

_LOST = 10.0
"""Multiple of its noise below which a force may be lost in it: our choice."""

_YIELDS, _AGREES = 8.0, 1.2
"""Greatest ratio of predicted to measured force that a rig that yields explains, and of the rise at that force to the
prediction's, or its inverse: our choice, less than a wrong unit of the force makes of it."""

_SPEEDS = 0.01, 50.0
"""Least and greatest mean speed of a plate going in, mm/s, without a question on the unit of time: our choice."""
_WAYS, _BENT = 3, 0.05
"""Greatest number of readings of a press by hand that are asked about; distance from a multiple of its prediction above
which a press is of another shape: our choice, four times that of a wall, radius or dead volume that is another."""
_WHY = "another resin (`membrane.material`, runs.resin) or design (`design`), a smaller plate, or a wrong calibration?"
_WHY_LEAK = "a leak, a dead volume that is not given (`pneumatics.dead_volume_mL`), another resin or design?"


@dataclass(frozen=True, slots=True)
class ExpectedRun:
    """The prediction of a run: indentations (ascending, mm), forces (N) and rises (MPa), (n,) each."""

    indentation: Array
    force: Array
    rise: Array

    @property
    def depth(self) -> float:
        """Greatest indentation, mm."""
        return float(self.indentation[-1])

    def at(self, depth: float) -> tuple[float, float]:
        """Force (N) and rise (MPa) at a depth (mm) up to the prediction's."""
        force, rise = (float(np.interp(depth, self.indentation, values)) for values in (self.force, self.rise))
        return force, rise


def check_plausible(
    curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun | None, file: Path
) -> tuple[str, ...]:
    """Questions about a run that may be correct and is used; where a channel is late, on that and the time alone.

    Without a prediction (``expected`` None) only the record itself is checked: signs, times, driving pressure. Raises
    InputError for the impossible: a wrong sign, force and pressure swapped, a record begun inside the dome, a magnitude
    off by more than `FAR` and right in another unit (above `BEYOND`: within `FAR` in another unit), a pressure before
    contact `DRIVING_FAR` times as far from the driving pressure as a reset leaves it (a question if below zero)."""
    time = None if curve.run.kind == "hand" else _speed(curve, columns)
    try:
        questions = _questions(curve, columns, expected, file)
    except InputError:
        if curve.late is None:
            raise
        raise InputError(f"{curve.late}, as it cannot be used", file=file) from None
    return tuple(text for text in (time, *(questions if curve.late is None else [curve.late])) if text is not None)


def _questions(
    curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun | None, file: Path
) -> Sequence[str | None]:
    _check_signs(curve, columns, file)
    magnitudes: list[str | None] = []
    if expected is not None and curve.run.kind == "hand":
        magnitudes = [_rise(curve, columns, expected, file)]
    elif expected is not None:
        _check_start(curve, expected, file)
        _check_swap(curve, columns, expected, file)
        magnitudes = _magnitudes(curve, columns, expected, file)
    return *magnitudes, _driving(curve, columns, file), *run_questions(curve, columns)


def _rise(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun, file: Path) -> str | None:
    """Question about the rise of a press by hand at its greatest force (or the prediction's), or None, with the
    readings that would explain it. Near the prediction a unit of both may still be wrong, as in kgf and psi: then the
    curve is of another shape. Raises InputError if off by more than `BEYOND`."""
    reach = min(float(curve.force[-1]), float(expected.force[-1]))
    measured = float(np.interp(reach, curve.force, curve.rise))
    target = float(np.interp(reach, expected.force, expected.rise))
    shape, ways = _compared(curve.force, curve.rise, expected)[0], _read_otherwise(curve, columns, expected)
    near, bent = 1 / FAR <= measured / target <= FAR, shape > _BENT and bool(ways) and 3 * min(ways)[0] < shape
    if near and not bent:
        return None
    problem = (
        f"columns {columns.force.name} and {columns.pressure.name}: the pressure rises by {number(measured / KPA)} "
        f"kPa at {number(reach)} N where the prediction has {number(target / KPA)} kPa"
        f"{', and along another curve' if near else ''}"
    )
    likely = [ways[at] for at in sorted(ways) if at[0] <= 3 * min(ways)[0] + _BENT / 3][:_WAYS]
    why = "; ".join(likely) or "are they swapped, or is the unit of one of them another (`columns`)"
    if 1 / BEYOND <= measured / target <= BEYOND:
        return f"{problem}: {why}, or is it {_WHY}"
    raise InputError(f"{problem}; {why}?", file=file)


def _compared(force: Array, rise: Array, expected: ExpectedRun) -> tuple[float, float]:
    """Greatest distance of a press from a multiple of its prediction, as a share of its rise, and that multiple."""
    at = np.linspace(0.05, 1.0, 40) * min(float(force[-1]), float(expected.force[-1]))
    measured, target = np.interp(at, force, rise), np.interp(at, expected.force, expected.rise)
    times = max(float(measured @ target), 0.0) / max(float(target @ target), 1e-300)
    return float(np.abs(measured - times * target).max() / max(float(np.abs(measured).max()), 1e-300)), times


def _read_otherwise(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun) -> dict[tuple[float, float], str]:
    """Questions on an exchange or units that bring a press by hand within `UNIT_NEAR` of its prediction, with the
    option that says so, by the distance of the curve's shape, in hundredths, and by that of its magnitude."""
    force, pressure, found = columns.force, columns.pressure, dict[tuple[float, float], str]()
    of_force, of_pressure = UNITS["force"][force.unit], UNITS["pressure"][pressure.unit]

    def consider(question: str, forces: Array, rises: Array, **read: Column) -> None:
        shape, times = _compared(forces, rises, expected)
        off = abs(math.log(max(times, 1e-300)))
        if off < math.log(UNIT_NEAR):
            found.setdefault((round(shape, 2), round(off, 9)), f"{question} ({as_option(**read)})")

    turned = force.model_copy(update={"name": pressure.name}), pressure.model_copy(update={"name": force.name})
    values = curve.rise * of_force / of_pressure, curve.force * of_pressure / of_force
    consider("are they exchanged", *values, force=turned[0], pressure=turned[1])
    units = [
        unit for unit in UNITS["pressure"] if unit.endswith(ABSOLUTE_UNIT) == pressure.unit.endswith(ABSOLUTE_UNIT)
    ]
    for units_read in itertools.product([force.unit, *UNITS["force"]], [pressure.unit, *units]):
        other = {
            key: column.model_copy(update={"unit": unit})
            for key, column, unit in zip(("force", "pressure"), (force, pressure), units_read, strict=True)
            if unit != column.unit
        }
        factors = UNITS["force"][units_read[0]] / of_force, UNITS["pressure"][units_read[1]] / of_pressure
        named = " and ".join(f"the {key} in {column.unit}" for key, column in other.items())
        if other and factors != (1.0, 1.0):
            consider(f"is {named}", curve.force * factors[0], curve.rise * factors[1], **other)
    return found


def _magnitudes(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun, file: Path) -> list[str | None]:
    depth = float(curve.indentation[-1])
    ratio = depth / expected.depth
    goes, predicted = f"goes to {number(depth)} mm in", f"the prediction goes to {number(expected.depth)} mm"
    questions = [_magnitude(file, columns, "position", ratio, goes, predicted)]
    # Where the travel itself is suspect, the ends are compared.
    reach = min(depth, expected.depth) if questions[0] is None else depth
    force, rise = expected.at(reach if questions[0] is None else expected.depth)
    pushes, rises = (float(np.interp(reach, curve.indentation, values)) for values in (curve.force, curve.rise))
    # Where force and pressure agree, the travel is greater than the dome's; a stiffness too low is asked about.
    alike = rises / float(np.interp(pushes, expected.force, expected.rise))
    if force / _YIELDS < pushes < force and 1 / _AGREES < alike < _AGREES:
        return questions
    for key, values, target, unit, name in (
        ("force", curve.force, force, 1.0, "N"),
        ("pressure", curve.rise, rise, KPA, "kPa"),
    ):
        measured = float(np.interp(reach, curve.indentation, values))
        what = "reads" if key == "force" else "rises by"
        reads = f"{what} {number(measured / unit)} {name} at {number(reach)} mm"
        predicted = f"the prediction has {number(target / unit)} {name}"
        questions.append(_magnitude(file, columns, key, measured / target, reads, predicted))
    return questions


def _magnitude(file: Path, columns: ColumnMap, key: str, ratio: float, reads: str, predicted: str) -> str | None:
    """Question about a ratio of measured to predicted; None if it is plausible. Raises InputError if another unit
    explains it."""
    if 1 / FAR <= ratio <= FAR:
        return None
    column = getattr(columns, key)
    times = f"{ratio:.2g} times it" if ratio < 100 else f"{ratio:.0f} times it"
    problem = f"column {column.name}: {reads} where {predicted}, {times}"
    declared = UNITS[key][column.unit]
    near = FAR if key in ("force", "pressure") and ratio > BEYOND else UNIT_NEAR
    gauges = {unit: factor for unit, factor in UNITS[key].items() if not unit.endswith(ABSOLUTE_UNIT)}
    off = {unit: abs(math.log(max(ratio, 1e-12) * factor / declared)) for unit, factor in gauges.items()}
    nearest = min(off, key=lambda unit: off[unit])
    if nearest != column.unit.removesuffix(ABSOLUTE_UNIT) and off[nearest] < math.log(near):
        same = " or ".join(shown(unit) for unit in off if math.isclose(UNITS[key][unit], UNITS[key][nearest]))
        is_exact = off[nearest] < math.log(UNIT_NEAR)
        then = "" if is_exact else f", {ratio * UNITS[key][nearest] / declared:.2g} times the prediction then"
        right = otherwise(columns, key, nearest)
        raise InputError(f"{problem}; its unit looks like {same}{then}", file=file, remedy=right)
    why = _WHY_LEAK if key == "pressure" and ratio < 1.0 else _WHY
    return f"{problem}; no unit explains that: {why}"


def _check_signs(curve: MeasuredCurve, columns: ColumnMap, file: Path) -> None:
    for key, values, unit, name in (("force", curve.force, 1.0, "N"), ("pressure", curve.rise, KPA, "kPa")):
        column = getattr(columns, key)
        deep = float(values[np.argmax(np.abs(values))])
        if deep < 0 and float(values.max()) <= _RESTS * -deep:
            raise InputError(
                f"column {column.name}: falls by {number(-deep / unit)} {name} as the sensor is pressed",
                file=file,
                remedy=f"it must rise: {otherwise(columns, key)}",
            )
    if curve.indentation[-1] <= 0:
        raise InputError(
            f"column {columns.position.name}: falls as the force rises",
            file=file,
            remedy=f"it must count into the sensor: {otherwise(columns, 'position')}",
        )


def _check_start(curve: MeasuredCurve, expected: ExpectedRun, file: Path) -> None:
    """Raise InputError if the record begins inside the dome, or first contact is found late: force and rise are the
    prediction's from some depth on, and no multiple of the prediction from first contact."""
    if curve.indentation.size < _STARTED:
        return
    travel, predictions, depths = expected.indentation, (expected.force, expected.rise), curve.indentation

    def off(start: float, *, scaled: bool = False) -> float:
        """Greatest distance of force and rise from the prediction's beyond ``start``, as a share of their greatest."""
        shared, parts = depths + start <= travel[-1], []
        for measured, predicted in zip((curve.force, curve.rise), predictions, strict=True):
            beyond = (np.interp(depths + start, travel, predicted) - np.interp(start, travel, predicted))[shared]
            values = measured[shared]
            factor = float(values @ beyond / max(beyond @ beyond, 1e-300)) if scaled else 1.0
            parts.append(np.abs(values - factor * beyond).max() / max(float(values.max()), 1e-300))
        return float(max(parts))

    farthest = float(travel[-1]) - _REACHED * float(depths[-1])
    if farthest <= 0 or off(0.0) < _UNLIKE:
        return
    starts = np.linspace(0.0, farthest, _STARTS)
    found = [off(start) for start in starts]
    best = int(np.argmin(found))
    if found[best] >= min(_LIKE, 0.5 * off(0.0, scaled=True)):
        return
    start, noise = float(starts[best]), curve.noise[0]
    begun = float(np.interp(start, travel, predictions[0]))
    if begun < _LOST * noise:
        raise InputError(
            f"first contact is found {number(start)} mm late: there the predicted force is {number(begun)} N, and the "
            f"force has a noise of {number(noise)} N",
            file=file,
            remedy="record with a force sensor of less noise, or give `kind` hand, which does without the travel",
        )
    raise InputError(
        f"force and pressure are those predicted from {number(start)} mm inside the dome on",
        file=file,
        remedy="start the recording, and zero force and gauge, clear of the dome",
    )


def _check_swap(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun, file: Path) -> None:
    """Raise InputError if force and pressure are exchanged: each has the magnitude of the other, and the pressure
    before contact is in the force.

    The numbers in the columns are compared. At a driving pressure the values before contact decide, otherwise the
    magnitudes, where they differ enough.
    """
    force_unit, pressure_unit = UNITS["force"][columns.force.unit], UNITS["pressure"][columns.pressure.unit]
    depth = min(float(curve.indentation[-1]), expected.depth)
    predicted = expected.at(max(depth, 0.0))
    force = float(np.interp(depth, curve.indentation, curve.force)) / force_unit
    rise = float(np.interp(depth, curve.indentation, curve.rise)) / pressure_unit
    expected_force, expected_rise = predicted[0] / force_unit, predicted[1] / pressure_unit
    if min(force, rise, expected_force, expected_rise) <= 0:
        return
    as_stated = abs(math.log(force / expected_force)) + abs(math.log(rise / expected_rise))
    swapped = abs(math.log(force / expected_rise)) + abs(math.log(rise / expected_force))
    driving = curve.run.driving_pressure_kPa * KPA
    zeros = [one.zero_force for one in curve.indents if not math.isnan(one.contact)]
    in_force = (float(np.mean(zeros)) if zeros else 0.0) / force_unit * pressure_unit
    allowed = max(RESET_KPA * KPA, RESET_SHARE * driving)
    driven = driving > 3 * RESET_KPA * KPA
    rests = abs(in_force - driving) <= allowed and abs(curve.driving - driving) > allowed
    if swapped < 2 * math.log(FAR) and ((driven and rests) or (not driven and swapped + SWAP_MARGIN < as_stated)):
        before = f", and {number(in_force / KPA)} before contact, the driving pressure" if driven else ""
        raise InputError(
            f"columns {columns.force.name} and {columns.pressure.name} look swapped: {columns.force.name} "
            f"rises by {force:.3g} where {expected_force:.3g} {columns.force.unit} are predicted and "
            f"{expected_rise:.3g} {columns.pressure.unit} of pressure{before}",
            file=file,
            remedy=exchanged(columns, "force", "pressure"),
        )


def _speed(curve: MeasuredCurve, columns: ColumnMap) -> str | None:
    """Question about a plate slower or faster than stages are, as in a wrong unit of time; else None."""
    speeds = [one.indentation / (one.hold[0] - one.contact) for one in curve.indents if one.hold[0] > one.contact]
    if not speeds or _SPEEDS[0] <= (speed := float(np.median(speeds))) <= _SPEEDS[1]:
        return None
    of, units = UNITS["time"][columns.time.unit], UNITS["time"]
    unit = min(units, key=lambda unit: abs(math.log(speed * of / units[unit])))
    goes = f"column {columns.time.name}: the plate goes in at {number(speed)} mm/s; are the times in {unit}?"
    return f"{goes} {otherwise(columns, 'time', unit)}"


def _driving(curve: MeasuredCurve, columns: ColumnMap, file: Path) -> str | None:
    stated_kPa, read_kPa = curve.run.driving_pressure_kPa, curve.driving / KPA
    off_kPa, near_kPa = read_kPa - stated_kPa, max(RESET_KPA, RESET_SHARE * stated_kPa)
    if abs(off_kPa) <= near_kPa:
        return None
    problem = (
        f"column {columns.pressure.name}: {read_kPa:.3g} kPa before contact, where "
        f"driving_pressure_kPa = {stated_kPa:g} is stated"
    )
    # No state reads below 0: that is a zero, whatever its size.
    if abs(off_kPa) <= DRIVING_FAR * near_kPa or read_kPa < 0.0:
        return f"{problem}; another run's file, or, with {off_kPa:.3g} kPa to subtract in the file, a gauge not zeroed?"
    if not looks_absolute(off_kPa):
        check_unpressed(curve, stated_kPa, file)
    set_so = f"state driving_pressure_kPa = {read_kPa:.0f} below its [[runs]] entry"
    if looks_absolute(off_kPa):
        problem += ", which looks like an absolute pressure"
        absolute = otherwise(columns, "pressure", f"{columns.pressure.unit}{ABSOLUTE_UNIT}")
        remedy = f"{absolute}, of which the ambient pressure is subtracted, or {set_so}"
    else:
        remedy = f"name the right file, or the unit by `columns`, subtract the gauge's zero in the file, or {set_so}"
    raise InputError(problem, file=file, remedy=remedy)
