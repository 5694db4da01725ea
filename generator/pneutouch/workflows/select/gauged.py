"""A selection with its gauge: the one named, or of all the one that covers the range and detects the smallest force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from pneutouch.catalogue import Library
from pneutouch.catalogue.cached_library import CachedLibrary
from pneutouch.errors import InputError
from pneutouch.mechanics.gauge_reading import GaugeReading, gauge_reading
from pneutouch.spec.gauge import Gauge
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.select.base import base_scene
from pneutouch.workflows.select.gauge_trial import ANY, GaugeTrial
from pneutouch.workflows.select.run import SelectionRun
from pneutouch.workflows.select.run import select as select_by_target

_UNKNOWN = "its noise is not stated, so the smallest force is not known"


@dataclass(frozen=True, slots=True)
class _Part:
    """A gauge by name, and its reading at the ambient pressure."""

    name: str
    reading: GaugeReading

    def trial(self, why: str, *, chosen: bool = False, force: float | None = None) -> GaugeTrial:
        return GaugeTrial(self.name, self.reading.title, chosen, why, force)

    @property
    def reach(self) -> str:
        return f"it reads to {self.reading.limit / KPA:.4g} kPa"


def select(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    written: int | None = None,
    progress: Callable[[str], None] = lambda step: None,
) -> SelectionRun:
    """Answer a target as `run.select` does; with ``setting.gauge`` "any" also choose the gauge.

    Gauges are tried in the order of the smallest force that they detect; the first one whose range no selected design
    leaves is taken. Those whose noise is not stated come last. Without one the answer has no design.
    """
    library = CachedLibrary((library or Library.default()).folders)
    named = target.setting.gauge
    if named != ANY:
        if named is not None:
            library.load("gauges", named, file=where, key="setting.gauge")
        return select_by_target(target, where, library, written=written, progress=progress)
    trials: list[GaugeTrial] = []
    last: SelectionRun | None = None
    for part in (parts := _parts(target, where, library)):
        if (why := _below_driving(part, target)) is not None:
            trials.append(part.trial(why))
            continue
        last = select_by_target(_with(target, part.name), where, library, written=written, progress=progress)
        if (why := _not_covered(part, last, written)) is not None:
            trials.append(part.trial(why))
            continue
        slope = float(last.answer.designs[0].pool.response.lines.sensitivity_kPa_per_N[0]) * KPA
        trials += _judged(part, parts[len(trials) :], slope, target)
        return replace(last, gauges=tuple(trials))
    if last is None:
        raise InputError(
            "no gauge reads above the driving pressure",
            file=where,
            key="target.driving_pressure_kPa",
            remedy="lower it",
        )
    none = replace(last.answer, designs=[])
    return replace(last, answer=none, judged={}, confirmed=(), gauges=tuple(trials))


def _parts(target: Target, where: str, library: Library) -> list[_Part]:
    """All gauges that read above the ambient pressure, those first that detect the smallest change of pressure."""
    ambient_kPa = base_scene(_with(target, None), where, library).design.pneumatics.ambient_pressure_kPa
    gauges = library.all("gauges", Gauge)
    parts = [_Part(name, gauge_reading(gauge, ambient_kPa * KPA)) for name, gauge in gauges.items()]

    def order(part: _Part) -> tuple[bool, float, str]:
        threshold = part.reading.threshold
        return threshold is None, threshold or 0.0, part.name

    return sorted((part for part in parts if part.reading.limit > 0), key=order)


def _with(target: Target, gauge: str | None) -> Target:
    return target.model_copy(update={"setting": target.setting.model_copy(update={"gauge": gauge})})


def _below_driving(part: _Part, target: Target) -> str | None:
    """Reason why a gauge cannot read the required driving pressure; None if it can."""
    driving_kPa = target.target.driving_pressure_kPa or 0.0
    below = part.reading.limit <= driving_kPa * KPA
    return f"{part.reach}, not above the driving pressure of {driving_kPa:g} kPa" if below else None


def _not_covered(part: _Part, run: SelectionRun, written: int | None) -> str | None:
    """Reason why a gauge does not cover the designs selected with it; None if it does."""
    designs = run.answer.designs[: written or 1]
    if not designs:
        return f"{part.reach}, with which no design meets the target"
    ended = next((choice for choice in designs if "gauge" in choice.ends_with), None)
    if ended is None:
        return None
    return f"{part.reach}, where the range of the best design ends ({float(ended.pool.force[0]):.3g} N)"


def _judged(chosen: _Part, parts: list[_Part], slope: float, target: Target) -> list[GaugeTrial]:
    """The gauge chosen and those after it; ``slope`` is the best design's sensitivity, MPa/N."""
    threshold = chosen.reading.threshold
    force = None if threshold is None else threshold / slope
    detects = (
        "" if force is None else f"covers the range and detects {force:.2g} N, limited by {chosen.reading.limited_by}"
    )
    why = detects or f"covers the range; {_UNKNOWN}"
    trials = [chosen.trial(why, chosen=True, force=force)]
    for part in parts:
        if part is chosen:
            continue
        other = None if part.reading.threshold is None else part.reading.threshold / slope
        why = _below_driving(part, target) or (_UNKNOWN if other is None else f"detects no less than {other:.2g} N")
        trials.append(part.trial(why, force=other))
    return trials
