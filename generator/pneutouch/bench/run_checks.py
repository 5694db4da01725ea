"""Plausibility of a run against its campaign: wrong units, signs and columns are questioned, never corrected.

Runs that deviate from the others of their sensor, as a file of another sensor does.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.indents import HOLD, RELAXATION
from pneutouch.bench.record import Blocks, MeasuredCurve
from pneutouch.errors import InputError
from pneutouch.mechanics.response import figures
from pneutouch.spec.campaign import CampaignRun, ColumnMap, Rig
from pneutouch.tables.layout import ABSOLUTE as ABSOLUTE_UNIT
from pneutouch.tables.layout import UNITS
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

__all__ = ["ExpectedRun", "check_leak", "check_plausible"]

FAR = 3.0
"""Factor from the prediction beyond which a question is reported: our choice. The solid's predictions meet the paper's
table with a median error of 8 % and are off by two for its stiffest resin."""

UNIT_NEAR = 1.8
"""Factor within which another unit must bring a reading to the prediction: our choice, below half of `FAR`."""

RESET_KPA, RESET_SHARE = 1.0, 0.1
"""Largest distance of the pressure before contact from the driving pressure: our choice, a regulator's scatter."""

BEYOND = 10.0
"""Factor above the prediction of force or rise from which no sensor is the reason: our choice, three times `FAR`.
Another unit then explains a reading that it brings within `FAR`. A rise that is too small may be a leak."""

DRIVING_FAR = 3.0
"""Times `RESET_KPA` or `RESET_SHARE` beyond which no gauge zero and no regulator is the reason: our choice."""

ABSOLUTE = (0.6, 1.1)
"""Excess before contact, in standard atmospheres, that looks like an absolute pressure: up to 4 km above the sea."""

SWAP_MARGIN = math.log(2.0)
"""Margin (log of a factor) by which the swapped reading must be nearer to the prediction at no driving pressure."""

_RESTS = 0.05
"""Share of the greatest force or rise by which points may be negative: noise about the origin."""

LOADED = 0.1
"""Share of the greatest force from which one before contact may be a preload, and of the greatest rise that goes on
while the force stays: our choice."""

_FLAT_POINTS, _NOISES, _LEVEL = 3, 6.0, 2e-3
"""Points at the greatest force that may be a channel's end; noise, or share of the force, within which they count."""

_MINUS = {
    1: " (in `columns` a minus before the name turns the sign)",
    -1: " (in `columns` leave out the minus before the name)",
}
"""Replacements of a wrong sign that `workflows.characterize.parse_columns` takes, by the sign."""

_HOLD_FAR = 50.0
_WHY = "another resin (runs.resin) or design (design), a smaller plate, or a wrong calibration?"
_WHY_LEAK = "a leak, a dead volume that is not given (pneumatics.dead_volume_mL), another resin or design?"
_WHY_TIME = "holds of another protocol, another kind of run, or another column?"

_START = 1.0
"""Seconds in which a leaking line loses little, long enough to average the noise of a gauge: our choice."""

_SHAPE = 1.5
"""Exponent of force and rise over depth that scales a prediction without a curve to a shallower depth (Hertz)."""


@dataclass(frozen=True, slots=True)
class ExpectedRun:
    """The prediction of a run: force (N) and rise (MPa) at a depth (mm).

    ``curve`` are indentations (ascending, mm), forces and rises up to there, (n,) each, where they are available.
    """

    depth: float
    force: float
    rise: float
    curve: tuple[Array, Array, Array] | None = None

    def at(self, depth: float) -> tuple[float, float]:
        """Force and rise at a depth up to the prediction's."""
        if self.curve is None:
            share = (depth / self.depth) ** _SHAPE
            return self.force * share, self.rise * share
        travel, force, rise = self.curve
        return float(np.interp(depth, travel, force)), float(np.interp(depth, travel, rise))


def check_plausible(
    curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun | None, file: Path
) -> tuple[str, ...]:
    """Questions about a run that may nevertheless be correct and is used.

    Without a prediction (``expected`` None) only signs, times and the driving pressure are checked. Raises InputError
    for what is impossible: a sign that is wrong, force and pressure swapped, a magnitude that is off by more than `FAR`
    and right in another unit of `spec.campaign.UNITS` (beyond `BEYOND`: near in another unit), a pressure before
    contact that is `DRIVING_FAR` times as far from the driving pressure as a reset leaves it."""
    _check_signs(curve, columns, file)
    by_hand = curve.run.kind == "hand"
    if expected is not None and not by_hand:
        _check_swap(curve, columns, expected, file)
    time = None if by_hand else _check_time(curve, columns, file)
    magnitudes: list[str | None] = []
    if expected is not None:
        magnitudes = [_rise(curve, columns, expected, file)] if by_hand else _magnitudes(curve, columns, expected, file)
    asked = (
        *magnitudes,
        time,
        _driving(curve, columns, file),
        _kind(curve),
        _loaded(curve, columns),
        _flat(curve, columns),
    )
    return tuple(text for text in asked if text is not None)


def _kind(curve: MeasuredCurve) -> str | None:
    """Question about a stated kind of run whose record shows another."""
    stated, shows = curve.run.kind, curve.shows
    stays = {"steps": True, "saturation": True, "relaxation": True, "loop": False}
    if stated not in stays or stays[stated] == stays.get(shows):
        return None
    does = "stays at its deep ends" if stays.get(shows) else "turns at its deep ends without a stay"
    return f"stated as a run of kind {stated}, but the plate {does}, as in one of kind {shows}: state that kind?"


def _loaded(curve: MeasuredCurve, columns: ColumnMap) -> str | None:
    """Question about a force before contact that may be a preload."""
    zeros = [one.zero_force for one in curve.indents if not math.isnan(one.contact)]
    top = float(np.abs(curve.force).max())
    if not zeros or abs(zeros[0]) <= LOADED * top:
        return None
    return (
        f"column {columns.force.name}: reads {_number(zeros[0])} N before contact, {abs(zeros[0]) / top:.2g} times "
        "what the press adds; it is subtracted: a scale that was not zeroed, or was the sensor pressed already?"
    )


def _flat(curve: MeasuredCurve, columns: ColumnMap) -> str | None:
    """Question about a force that stays at its greatest value while the pressure goes on rising."""
    force, rise = curve.force, curve.rise
    if force.size < _FLAT_POINTS + 2 or not math.isfinite(curve.noise[0]):
        return None
    top = force >= force.max() - max(_NOISES * curve.noise[0], _LEVEL * float(force.max()))
    first = int(top.argmax())
    if force.size - first < _FLAT_POINTS or rise[-1] - rise[first] < LOADED * float(np.ptp(rise)):
        return None
    return (
        f"column {columns.force.name}: stays at {_number(float(force.max()))} N over the last {force.size - first} "
        f"points while the pressure rises by {_number(float(rise[-1] - rise[first]) / KPA)} kPa: is the force sensor "
        "at its end?"
    )


def _rise(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun, file: Path) -> str | None:
    """Question about the rise of a press by hand at its force, up to the prediction's."""
    if expected.curve is None:
        return None
    _, force, rise = expected.curve
    reach = min(float(curve.force[-1]), float(force[-1]))
    measured, target = float(np.interp(reach, curve.force, curve.rise)), float(np.interp(reach, force, rise))
    reads = f"rises by {_number(measured / KPA)} kPa at {_number(reach)} N"
    return _magnitude(
        file, columns, "pressure", measured / target, reads, f"the prediction has {_number(target / KPA)} kPa"
    )


def check_leak(blocks: Blocks, run: CampaignRun, rig: Rig) -> tuple[str, ...]:
    """Questions about a leak run that may nevertheless be correct; its pressure is the median of the first `_START`
    seconds.

    Raises InputError if the pressure is at the end of the gauge's range (`reading.CLIPPED`) or at a flat top for
    more than half of the run, or begins at more than `FAR` times or less than 1 / `FAR` of the driving pressure in the
    campaign."""
    questions: list[str] = []
    lost = [warning for warning in blocks.warnings if warning.kind == "clipped"]
    length, at = float(np.ptp(blocks.time)), sum(warning.end - warning.start for warning in lost)
    if at > 0.5 * length:
        raise InputError(
            f"a leak run of {length:.3g} s of which {at:.3g} s are clipped ({lost[0].why}); the gauge has a "
            f"range of {rig.pressure_range_kPa:g} kPa; must be run within it",
            file=blocks.file,
        )
    if lost:
        questions.append(f"{at:.2g} s of {length:.3g} s are clipped ({lost[0].why}); is the leak greater?")
    count = int(np.searchsorted(blocks.time, blocks.time[0] + _START))
    read_kPa, stated_kPa = float(np.median(blocks.pressure[: max(count, 1)])) / KPA, run.driving_pressure_kPa
    if abs(read_kPa - stated_kPa) <= max(RESET_KPA, RESET_SHARE * stated_kPa):
        return tuple(questions)
    stated = f"the campaign states driving_pressure_kPa = {stated_kPa:g}"
    problem = f"a leak run that begins at {read_kPa:.3g} kPa; {stated}"
    if stated_kPa > 0 and not stated_kPa / FAR <= read_kPa <= stated_kPa * FAR:
        raise InputError(
            f"{problem}; the unit of the pressure (columns.pressure.unit), or another run's file?", file=blocks.file
        )
    return (*questions, f"{problem}; was it left out, is the gauge not zeroed, or does the line lose it at once?")


def _magnitudes(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun, file: Path) -> list[str | None]:
    depth = float(curve.indentation[-1])
    ratio = depth / expected.depth
    goes, predicted = f"goes to {_number(depth)} mm in", f"the prediction goes to {_number(expected.depth)} mm"
    questions = [_magnitude(file, columns, "position", ratio, goes, predicted)]
    # Where the travel itself is suspect, the ends are compared.
    reach = min(depth, expected.depth) if questions[0] is None else depth
    force, rise = expected.at(reach) if questions[0] is None else (expected.force, expected.rise)
    for key, values, target, unit, name in (
        ("force", curve.force, force, 1.0, "N"),
        ("pressure", curve.rise, rise, KPA, "kPa"),
    ):
        measured = float(np.interp(reach, curve.indentation, values))
        what = "reads" if key == "force" else "rises by"
        reads = f"{what} {_number(measured / unit)} {name} at {_number(reach)} mm"
        predicted = f"the prediction has {_number(target / unit)} {name}"
        questions.append(_magnitude(file, columns, key, measured / target, reads, predicted))
    return questions


def _number(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 1e4 else f"{value:.1e}".replace("e+0", "e")


def _magnitude(file: Path, columns: ColumnMap, key: str, ratio: float, reads: str, predicted: str) -> str | None:
    """Question about an implausible ratio of measured to predicted; None for a plausible one. Raises an error if a unit
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
        same = " or ".join(unit for unit in off if math.isclose(UNITS[key][unit], UNITS[key][nearest]))
        is_exact = off[nearest] < math.log(UNIT_NEAR)
        then = "" if is_exact else f", {ratio * UNITS[key][nearest] / declared:.2g} times the prediction then"
        raise InputError(f"{problem}; is the column in {same}{then}? set columns.{key}.unit", file=file)
    why = _WHY_LEAK if key == "pressure" and ratio < 1.0 else _WHY_TIME if key == "time" else _WHY
    return f"{problem}; no unit explains that: {why}"


def _check_signs(curve: MeasuredCurve, columns: ColumnMap, file: Path) -> None:
    for key, values, unit, name in (("force", curve.force, 1.0, "N"), ("pressure", curve.rise, KPA, "kPa")):
        column = getattr(columns, key)
        deep = float(values[np.argmax(np.abs(values))])
        if deep < 0 and float(values.max()) <= _RESTS * -deep:
            raise InputError(
                f"column {column.name}: falls by {_number(-deep / unit)} {name} as the sensor is pressed",
                file=file,
                remedy=f"it must rise: set columns.{key}.sign = {-column.sign}{_MINUS[column.sign]}",
            )
    if curve.indentation[-1] <= 0:
        raise InputError(
            f"column {columns.position.name}: falls as the force rises",
            file=file,
            remedy=f"it must count into the sensor: set columns.position.sign = {-columns.position.sign}"
            f"{_MINUS[columns.position.sign]}",
        )


def _check_swap(curve: MeasuredCurve, columns: ColumnMap, expected: ExpectedRun, file: Path) -> None:
    """Force and pressure exchanged: each has the magnitude of the other, and the pressure before contact is in the
    force.

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
        before = f", and {_number(in_force / KPA)} before contact, the driving pressure" if driven else ""
        raise InputError(
            f"columns {columns.force.name} and {columns.pressure.name} look swapped: {columns.force.name} "
            f"rises by {force:.3g} where {expected_force:.3g} {columns.force.unit} are predicted and "
            f"{expected_rise:.3g} {columns.pressure.unit} of pressure{before}",
            file=file,
            remedy="exchange columns.force.name and columns.pressure.name",
        )


def _check_time(curve: MeasuredCurve, columns: ColumnMap, file: Path) -> str | None:
    """The length of holds reveals a wrong unit of time; holds may be a few times as long as in the paper."""
    if curve.run.kind == "loop" or not curve.indents:
        return None
    length = float(np.median([one.hold[1] - one.hold[0] for one in curve.indents]))
    usual = RELAXATION if curve.run.kind == "relaxation" else HOLD
    if 1 / _HOLD_FAR <= length / usual <= _HOLD_FAR:
        return None
    reads = f"holds last {_number(length)} s"
    return _magnitude(file, columns, "time", length / usual, reads, f"the protocol has {usual:g} s")


def _driving(curve: MeasuredCurve, columns: ColumnMap, file: Path) -> str | None:
    stated_kPa, read_kPa = curve.run.driving_pressure_kPa, curve.driving / KPA
    off_kPa, near_kPa = read_kPa - stated_kPa, max(RESET_KPA, RESET_SHARE * stated_kPa)
    if abs(off_kPa) <= near_kPa:
        return None
    problem = (
        f"column {columns.pressure.name}: {read_kPa:.3g} kPa before contact; the campaign states "
        f"driving_pressure_kPa = {stated_kPa:g}"
    )
    # No state reads below 0: that is a zero, whatever its size.
    if abs(off_kPa) <= DRIVING_FAR * near_kPa or read_kPa < 0.0:
        return f"{problem}; another run's file, or a gauge not zeroed?"
    set_so = f"state driving_pressure_kPa = {read_kPa:.0f} below its [[runs]] entry"
    if looks_absolute(off_kPa):
        problem += ", which looks like an absolute pressure"
        unit = f"{columns.pressure.unit}{ABSOLUTE_UNIT}"
        remedy = f'set columns.pressure.unit = "{unit}", of which the ambient pressure is subtracted, or {set_so}'
    else:
        remedy = f"name the right file, set columns.pressure.unit, subtract the gauge's zero in the file, or {set_so}"
    raise InputError(problem, file=file, remedy=remedy)


def looks_absolute(off_kPa: float) -> bool:
    """True if a pressure before contact is above the driving pressure by about an atmosphere."""
    return ABSOLUTE[0] < off_kPa * KPA / STANDARD_ATMOSPHERE < ABSOLUTE[1]


APART = 0.15
"""Share by which runs of one sensor may differ: our choice. The paper's three runs differ by 1 % in sensitivity, its
three identical sensors by 2 to 10 % (Fig. 7 and S2)."""

TIMES = 5.0
"""Factor on the scatter of the others (1.4826 times their median deviation) that must be exceeded too."""


def outliers(curves: Sequence[MeasuredCurve]) -> list[tuple[MeasuredCurve, str]]:
    """Runs that deviate from the others of one sensor, kind, driving pressure and age, and the reason.

    The force at the greatest common depth and the slope of pressure over force are compared, as logarithms: a run
    deviates where one of them is off the median of the others by more than `APART` and `TIMES` their scatter. Of two
    runs that differ by `APART` both are reported.
    """
    groups: dict[tuple[object, ...], list[MeasuredCurve]] = {}
    for curve in curves:
        run = curve.run
        groups.setdefault((run.sensor, run.kind, run.driving_pressure_kPa, run.age_days), []).append(curve)
    odd: list[tuple[MeasuredCurve, str]] = []
    for group in groups.values():
        odd += _apart(group)
    return odd


def _apart(group: list[MeasuredCurve]) -> list[tuple[MeasuredCurve, str]]:
    if len(group) < 2:
        return []
    depth = min(float(curve.indentation[-1]) for curve in group)
    forces = np.array([float(np.interp(depth, curve.indentation, curve.force)) for curve in group])
    slopes_kPa_per_N = np.array([_sensitivity(curve) for curve in group])
    reasons: dict[int, str] = {}
    for name, values in ((f"force at {depth:.3g} mm", forces), ("slope of pressure over force", slopes_kPa_per_N)):
        if not (values > 0).all():
            continue
        for k in range(len(group)):
            others = np.delete(values, k)
            middle = float(np.median(others))
            scatter = 1.4826 * float(np.median(np.abs(np.log(others / middle))))
            if abs(np.log(values[k] / middle)) > max(np.log1p(APART), TIMES * scatter):
                reasons.setdefault(k, f"{name} is {values[k] / middle:.2f} times that of")
    which = "the other run" if len(group) == 2 else f"the other {len(group) - 1} runs"
    question = "is one of them" if len(group) == 2 else "is it"
    return [
        (group[k], f"{why} {which} of sensor {group[k].run.sensor}; {question} of another sensor?")
        for k, why in sorted(reasons.items())
    ]


def _sensitivity(curve: MeasuredCurve) -> float:
    values = figures(curve.indentation, curve.force, curve.rise / KPA)
    return float("nan") if values is None else values.sensitivity
