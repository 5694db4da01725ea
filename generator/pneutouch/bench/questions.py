"""Questions about runs that look wrong but may be right, and runs that deviate from others of the same sensor."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from pneutouch.arrays import grouped
from pneutouch.bench.record import Blocks, MeasuredCurve
from pneutouch.bench.source import otherwise
from pneutouch.errors import InputError
from pneutouch.mechanics.response import figures
from pneutouch.spec.campaign import CampaignRun, ColumnMap, Rig
from pneutouch.tables.unit_words import ABSOLUTE as ABSOLUTE_UNIT
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

FAR = 3.0
"""Ratio of measured to predicted or stated value, or its inverse, that raises a question: our choice. The solid's
predictions meet the paper's table with a median error of 8 % and are off by a factor of two for its stiffest resin."""

RESET_KPA, RESET_SHARE = 1.0, 0.1
"""Largest difference of the pressure before contact from the driving pressure, in kPa or as a share of it, whichever is
more: our choice, a regulator's scatter."""

DRIVING_FAR = 3.0
"""Multiple of that which no gauge zero or regulator explains: our choice."""

ABSOLUTE = (0.6, 1.1)
"""Range of that difference, in standard atmospheres, that looks like an absolute pressure: up to 4 km above the sea."""

_SURELY_ABSOLUTE = (0.85, 1.1)
"""`ABSOLUTE` where the pressure may be off for other reasons: up to 1.3 km above the sea."""

LOADED = 0.1
"""Share of the greatest force beyond which a force before contact may be a preload: our choice."""

_PARTS, _SWINGS, _NOISY = 200, 0.3, 12.0
"""Parts of a leak run whose means show presses; least rise and fall, in their span and their noise: our choice."""

_START = 1.0
"""Seconds in which a leaking line loses little, long enough to average the noise of a gauge: our choice."""


def number(value: float) -> str:
    """Text of a number with two significant digits."""
    return f"{value:.2g}" if abs(value) < 1e4 else f"{value:.1e}".replace("e+0", "e")


def looks_absolute(off_kPa: float, within: tuple[float, float] = ABSOLUTE) -> bool:
    """True if ``off_kPa``, pressure before contact less driving pressure, is within a range of standard atmospheres."""
    return within[0] < off_kPa * KPA / STANDARD_ATMOSPHERE < within[1]


def run_questions(curve: MeasuredCurve, columns: ColumnMap) -> list[str]:
    """Questions that a record raises by itself: on its kind, a preload, its warnings."""
    doubts = (warning.why for warning in curve.warnings if warning.kind == "asked")
    asked = (_kind(curve), _loaded(curve, columns), *doubts)
    return [text for text in asked if text is not None]


def _kind(curve: MeasuredCurve) -> str | None:
    """Question about a stated kind of run whose record shows another; None if it agrees."""
    stated, shows = curve.run.kind, curve.shows
    stays = {"steps": True, "saturation": True, "relaxation": True, "loop": False}
    if stated not in stays or stays[stated] == stays.get(shows):
        return None
    does = "stays at its deep ends" if stays.get(shows) else "turns at its deep ends without a stay"
    return f"stated as a run of kind {stated}, but the plate {does}, as in one of kind {shows}: state that kind?"


def _loaded(curve: MeasuredCurve, columns: ColumnMap) -> str | None:
    """Question about a force before contact that may be a preload; None if it is small."""
    zero, top = _before_contact(curve)
    if abs(zero) <= LOADED * top:
        return None
    return (
        f"column {columns.force.name}: reads {number(zero)} N before contact, {abs(zero) / top:.2g} times "
        "what the press adds; it is subtracted: a scale that was not zeroed, or was the sensor pressed already?"
    )


def _before_contact(curve: MeasuredCurve) -> tuple[float, float]:
    """Force before the first contact, and the greatest that presses add, N."""
    zeros = (one.zero_force for one in curve.indents if not math.isnan(one.contact))
    return next(zeros, 0.0), float(np.abs(curve.force).max())


def check_unpressed(curve: MeasuredCurve, stated_kPa: float, file: Path | str) -> None:
    """Raise InputError for a pressure before contact that is far above the one stated where the force, too, tells that
    the sensor was pressed: it reads much before contact, or rises as soon as the plate moves."""
    (zero, top), read_kPa = _before_contact(curve), curve.driving / KPA
    loaded = zero > LOADED * top
    if read_kPa - stated_kPa <= max(DRIVING_FAR * RESET_KPA, RESET_SHARE * stated_kPa) or not (loaded or curve.at_once):
        return
    also = f"the force reads {number(zero)} N" if loaded else "the force rises as soon as the plate moves"
    raise InputError(
        f"{read_kPa:.3g} kPa before contact instead of {stated_kPa:g}, and {also}: the sensor was pressed already",
        file=file,
        remedy="start the recording, and zero force and gauge, clear of the dome",
    )


def check_leak(blocks: Blocks, run: CampaignRun, rig: Rig) -> tuple[str, ...]:
    """Questions about a leak run that may nevertheless be correct; it begins at its median pressure over `_START`.

    Raises InputError if that looks like an absolute pressure, or is more than `FAR` times or less than 1 / `FAR` of the
    driving pressure stated in the campaign (unchecked if none is stated), or if more than half of the run is clipped:
    at the end of the gauge's range (`reading.CLIPPED`) or at a flat top."""
    questions: list[str] = []
    started = int(np.searchsorted(blocks.time, blocks.time[0] + _START))
    read_kPa, stated_kPa = float(np.median(blocks.pressure[: max(started, 1)])) / KPA, run.driving_pressure_kPa
    if looks_absolute(read_kPa - stated_kPa, _SURELY_ABSOLUTE):
        problem = f"a leak run that begins at {read_kPa:.4g} kPa, which looks like an absolute pressure"
        absolute = otherwise(blocks.columns, "pressure", f"{blocks.columns.pressure.unit}{ABSOLUTE_UNIT}")
        raise InputError(problem, file=blocks.file, remedy=f"{absolute}, of which the ambient pressure is subtracted")
    if (swing := _swing(blocks)) is not None:
        questions.append(swing)
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
    if "driving_pressure_kPa" not in run.model_fields_set or abs(read_kPa - stated_kPa) <= max(
        RESET_KPA, RESET_SHARE * stated_kPa
    ):
        return tuple(questions)
    stated = f"the campaign states driving_pressure_kPa = {stated_kPa:g}"
    problem = f"a leak run that begins at {read_kPa:.3g} kPa; {stated}"
    if stated_kPa > 0 and not stated_kPa / FAR <= read_kPa <= stated_kPa * FAR:
        raise InputError(
            f"{problem}; another unit of the pressure (`columns`), or another run's file?", file=blocks.file
        )
    return (*questions, f"{problem}; was it left out, is the gauge not zeroed, or does the line lose it at once?")


def _swing(blocks: Blocks) -> str | None:
    """Question about a leak run whose pressure goes both up and down, as under presses; None if it does not."""
    parts = np.array_split(blocks.pressure, _PARTS)
    means = np.array([part.mean() for part in parts if part.size])
    up = float((means - np.minimum.accumulate(means)).max())
    down = float((np.maximum.accumulate(means) - means).max())
    noise = float(np.median(np.abs(np.diff(means))))
    if min(up, down) <= max(_SWINGS * float(np.ptp(means)), _NOISY * noise):
        return None
    return (
        f"the pressure goes up and down by {number(float(np.ptp(means)) / KPA)} kPa: presses, whose force is not named?"
    )


APART = 0.15
"""Relative difference that runs of one sensor may have: our choice. The paper's three runs differ by 1 % in
sensitivity, its three identical sensors by 2 to 10 % (Fig. 7 and S2)."""

TIMES = 5.0
"""Multiple of the other runs' scatter (1.4826 times their median deviation) that a deviation must exceed too."""


def outliers(curves: Sequence[MeasuredCurve]) -> list[tuple[MeasuredCurve, str]]:
    """Runs that deviate from the others of the same sensor, kind, driving pressure and age, each with the reason.

    The force at the greatest common depth and the slope of pressure over force are compared, as logarithms: a run
    deviates where one of them differs from the median of the others by more than `APART` and by more than `TIMES` their
    scatter. Of two runs that differ by `APART` both are reported.
    """
    runs = ((curve.run, curve) for curve in curves)
    groups = grouped(((run.sensor, run.kind, run.driving_pressure_kPa, run.age_days), curve) for run, curve in runs)
    return [odd for group in groups.values() for odd in _apart(group)]


def _apart(group: list[MeasuredCurve]) -> list[tuple[MeasuredCurve, str]]:
    if len(group) < 2:
        return []
    depth = min(float(curve.indentation[-1]) for curve in group)
    forces = np.array([float(np.interp(depth, curve.indentation, curve.force)) for curve in group])
    reach = min(float(curve.force.max()) for curve in group)
    slopes_kPa_per_N = np.array([_sensitivity(curve, reach) for curve in group])
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


def _sensitivity(curve: MeasuredCurve, reach: float) -> float:
    """Sensitivity of a curve up to the force ``reach`` (N), kPa/N; NaN if the points do not determine it."""
    to = curve.force <= reach
    values = figures(curve.indentation[to], curve.force[to], curve.rise[to] / KPA)
    return float("nan") if values is None else values.sensitivity
