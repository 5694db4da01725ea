"""Selection over shapes of the dome: for each shape, by the solid, the design that meets a target best.

Each shape is tried in a few proportions, at a few radii, in every resin; the wall (or, where it is given, the radius)
is solved for. What is found passes the whole ``check``.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from pneutouch.catalogue import Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.errors import ComputationError, InputError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import Sensor
from pneutouch.parts import assemble
from pneutouch.results.selection import ShapeRecord, ShapesRecord
from pneutouch.selection import CandidateResin
from pneutouch.shape import DomeShape, ShapeError, key_of, shape_of, stated_sizes
from pneutouch.spec.target import SearchedShape, Target
from pneutouch.spec.toml_text import value_text
from pneutouch.units import KPA
from pneutouch.workflows.select.base import ANY, base_scene, setting_changes
from pneutouch.workflows.select.checks import base_sensor, connector_fit, judge, source_of
from pneutouch.workflows.select.document import Typed, in_file
from pneutouch.workflows.select.select import PLATE_SHARE, resins_of
from pneutouch.workflows.select.shape_trial import ShapeTrial, next_size, slope_of

VARIANTS: dict[SearchedShape, tuple[dict[str, float], ...]] = {
    "hemisphere": ({},),
    "cap": ({"rise": 0.35}, {"rise": 0.5}, {"rise": 0.7}),
    "ellipsoid": ({"rise": 0.6}, {"rise": 1.4}),
    "thimble": ({"side": 0.5, "rise": 1.0}, {"side": 1.0, "rise": 1.0}),
    "disc": ({}, {"boss_radius": 0.35, "boss_height": 0.2}),
    "corrugated": ({"rise": 0.1},),
    "torus": ({"rise": 0.2}, {"rise": 0.3}),
}
"""Sizes over the inner radius in which each shape is tried: our choice."""

BALL_MM = 5.0
"""Radius of the small ball whose reading is set beside the plate's."""
_RADII = (1.0, 0.75)
"""Inner radii tried, over the greatest that the limits of the target leave: our choice."""
_WALL_SHARE, _DRAWN_SHARES, _THICKEST = 0.16, (0.2, 0.15, 0.1, 0.05), 0.4
"""Walls over the inner radius: at which a search begins, for which the outer sizes are drawn, and the greatest."""
_SOLVES, _MET = 7, 0.3
"""Most solves for one wall; share of the tolerance within which a wall is taken: our choice."""
_JUDGED = 3
"""Designs of a shape that are checked, best first, until one passes."""
_SHORTEST = 0.1
"""Least range of a design over the depth of its test: our choice; where a plate soon lies on the flange it is less."""
_STEP = 0.01
"""Radii and walls are multiples of this, mm."""
Missed = tuple[str, tuple[Mapping[str, float], ...]]
"""Why a shape has no design, and changes of the target's fields each of which one of its designs meets."""


@dataclass(frozen=True)
class ShapeDesign:
    """The best design of a shape, its rated pressure (MPa), and its reading under the small ball over the plate's."""

    trial: ShapeTrial
    rated: float
    ball: float | None

    @property
    def assignments(self) -> list[str]:
        """Changes that turn the base into the design, as ``table.key=value``."""
        return _texts(self.trial.changes)

    @property
    def record(self) -> ShapeRecord:
        """The design as ``select`` prints it."""
        trial, figures, dome = self.trial, self.trial.figures, self.trial.sensor.dome
        return ShapeRecord(
            shape=dome.shape.key,
            material=trial.resin.name,
            inner_radius_mm=dome.inner_radius,
            wall_thickness_mm=dome.wall_thickness,
            sizes=stated_sizes(dome.shape),
            height_mm=dome.shape.outer_height,
            footprint_mm=trial.footprint,
            driving_pressure_kPa=trial.state.driving_pressure / KPA,
            rated_pressure_kPa=self.rated / KPA,
            sensitivity_kPa_per_N=figures.sensitivity,
            stiffness_N_per_mm=figures.stiffness,
            force_range_end_N=figures.force_high,
            travel_mm=trial.state.range_end,
            ball_reading_ratio=self.ball,
        )


@dataclass(frozen=True)
class ShapeSelection:
    """The best design of each shape, best first; why others have none; resins left out; presses solved."""

    target: Target
    base: ResolvedDesign
    designs: tuple[ShapeDesign, ...]
    missed: Mapping[str, Missed]
    left_out: Mapping[str, str]
    solves: int

    @property
    def record(self) -> ShapesRecord:
        """The selection as ``select`` prints it."""
        rows = tuple(one.record for one in self.designs)
        return ShapesRecord(bool(rows), rows, self.reasons(), dict(self.left_out), self.solves)

    def reasons(self, typed: Typed = in_file) -> dict[str, str]:
        """Why shapes have no design; ``typed`` writes a field of the target with what a design meets."""
        offers = {
            name: " or ".join(" ".join(typed(*one) for one in met.items()) for met in changes)
            for name, (_, changes) in self.missed.items()
        }
        return {
            name: why + (f"; met by {offers[name]}" if offers[name] else "") for name, (why, _) in self.missed.items()
        }


def select_shapes(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    progress: Callable[[int, int, str], None] = lambda done, total, step: None,
) -> ShapeSelection:
    """Search the shapes of ``setting.shapes``. Raises InputError for an unknown name."""
    library = CachedLibrary((library or Library.default()).folders)
    shapes = [shape for shape in VARIANTS if {ANY, shape} & set(target.setting.shapes or ())]
    scene = base_scene(target, where, library)
    resins, left_out = resins_of(target, where, scene, base_sensor(scene), library)
    search = _Search(target, scene, library)
    designs: list[ShapeDesign] = []
    missed: dict[str, Missed] = {}
    for number, shape in enumerate(shapes):
        progress(2 * number, 2 * len(shapes), shape)
        met = sorted(search.trials(shape, resins), key=search.order)
        progress(2 * number + 1, 2 * len(shapes), f"{shape}, print rules")
        found, why = search.passing(met)
        if found is None:
            missed[shape] = (why, ()) if why else search.missed(shape)
        else:
            designs.append(found)
    designs.sort(key=lambda one: search.order(one.trial))
    return ShapeSelection(target, scene, tuple(designs), missed, left_out, search.solves)


@dataclass
class _Search:
    """Trials for a target on a base. ``nearest``: least miss of each shape, by the one field that is missed or by "";
    ``refused``: why the last trial has no press."""

    target: Target
    base: ResolvedDesign
    library: Library
    solves: int = 0
    nearest: dict[tuple[str, str], tuple[float, str, Mapping[str, float]]] = field(default_factory=dict)
    refused: str = "none of its designs has a range that a straight line explains"
    _balls: dict[int, tuple[ShapeTrial, float | None]] = field(default_factory=dict)

    def trials(self, shape: SearchedShape, resins: tuple[CandidateResin, ...]) -> Iterator[ShapeTrial]:
        """Designs of a shape that meet the target."""
        for sizes in VARIANTS[shape]:
            for radius, resin, pressure in product(self._radii(shape, sizes), resins, self._pressures()):
                trial = self._solved(shape, sizes, resin, radius, pressure)
                if trial is not None and self._meets(trial):
                    yield trial

    def order(self, trial: ShapeTrial) -> float:
        """Key by which designs are sorted, least first; the print error of the wall is the same for all."""
        prefer = self.target.weights.prefer or "robust"
        if prefer == "ball":
            ball = self.ball(trial)
            return np.inf if ball is None else abs(float(np.log(ball)))
        return {
            "robust": float(np.nan_to_num(abs(trial.slope), nan=np.inf)) / trial.sensor.dome.wall_thickness,
            "travel": -trial.state.range_end,
            "force": -trial.figures.force_high,
            "low": trial.sensor.dome.shape.outer_height,
        }[prefer]

    def ball(self, trial: ShapeTrial) -> float | None:
        """Reading under a ball of `BALL_MM` over that under the plate, at one force; None without a line."""
        if id(trial) not in self._balls:
            plate, pressure = dict(trial.changes), trial.state.driving_pressure
            ball = {**plate, "contact.object": "ball", "contact.ball_radius_mm": BALL_MM}
            found = self._pressed(ball, pressure)
            # Most balls end their range early: both are pressed that deep, in steps that resolve it.
            end = {} if found is None else {"indentation.depth_mm": round(0.999 * found[1].range_end, 4)}
            pressed = [self._pressed({**one, **end}, pressure) for one in (ball, plate) if found]
            states = [each[1] for each in pressed if each is not None]
            force = min((float(state.force[-1]) for state in states), default=0.0)
            read = [float(np.interp(force, state.force, state.pressure_rise)) for state in states]
            # The trial is kept with it, so that no other gets its id.
            self._balls[id(trial)] = trial, read[0] / read[1] if len(read) == 2 and read[1] > 0.0 else None
        return self._balls[id(trial)][1]

    def passing(self, trials: list[ShapeTrial]) -> tuple[ShapeDesign | None, str | None]:
        """The first of ``trials`` that passes ``check`` at a rated pressure, or why the last one does not."""
        why = None
        for trial in trials[:_JUDGED]:
            reason, evaluation = judge(source_of(self.base, _texts(trial.changes)), self.library, predicted=True)
            if reason is not None or evaluation is None:
                why = f"`check` refuses the best: {'' if reason is None else reason[1]}"
                continue
            rated = evaluation.rating.pressure
            if rated < trial.state.driving_pressure:
                why = f"the best is rated for {rated / KPA:.3g} kPa"
                continue
            return ShapeDesign(trial, rated, self.ball(trial)), None
        return None, why

    def _pressures(self) -> list[float]:
        """Driving pressures that are tried, MPa: the target's, else none and the middle one of the base."""
        if (stated_kPa := self.target.target.driving_pressure_kPa) is not None:
            return [stated_kPa * KPA]
        listed_kPa = sorted(self.base.design.pneumatics.driving_pressures_kPa)
        return sorted({0.0, listed_kPa[len(listed_kPa) // 2] * KPA})

    def _radii(self, shape: str, sizes: Mapping[str, float]) -> list[float]:
        """Inner radii to try, mm: shares of the greatest that the target leaves, else of the base's."""
        figures, given = self.target.target, self.target.given
        if given.inner_radius_mm is not None:
            return [given.inner_radius_mm]
        unit, limits = _drawn(shape, sizes), []
        if figures.max_diameter_mm is not None:
            limits.append(0.5 * figures.max_diameter_mm * 10.0 / unit.outer_radius)
        if figures.max_height_mm is not None and unit.outer_height > 0.0:
            limits.append(figures.max_height_mm * 10.0 / unit.outer_height)
        if figures.max_footprint_mm is not None:
            tried = np.linspace(1.0, 0.5 * figures.max_footprint_mm, 40)
            fits = connector_fit(self.base)(tried, _WALL_SHARE * tried).diameter <= figures.max_footprint_mm
            limits.append(float(tried[fits].max(initial=0.0)))
        greatest = min([*limits, *([] if limits else [self.base.design.membrane.inner_radius_mm])])
        return [radius for share in _RADII if (radius := _rounded(share * greatest)) >= 1.0]

    def _solved(
        self, shape: str, sizes: Mapping[str, float], resin: CandidateResin, radius: float, pressure: float
    ) -> ShapeTrial | None:
        """The trial whose wall, or radius if the wall is given, gives the sensitivity; the nearest if none does."""
        wall, wanted_kPa_per_N = self.target.given.wall_thickness_mm, self.target.target.sensitivity_kPa_per_N
        low, high, at = self._bounds(radius, wall)
        known: dict[float, float] = {}
        best = None
        while low <= high and len(known) < _SOLVES and (at := min(max(_rounded(at), low), high)) not in known:
            found = self._trial(shape, sizes, resin, *((radius, at) if wall is None else (at, wall)), pressure)
            if found is None:
                # So thin or thick a wall bears no pressure or gives no straight line.
                usual = _WALL_SHARE * radius
                low, high = (at + _STEP, high) if at < usual else (low, at - _STEP)
                at = float(np.sqrt(at * next(iter(known), usual)))
                if at in known or (not known and at == usual):
                    break
                continue
            gap = known[at] = (
                0.0 if wanted_kPa_per_N is None else float(np.log(found.figures.sensitivity / wanted_kPa_per_N))
            )
            if [*_misses(self.target, found)] == ["sensitivity"]:
                self._meets(found)
            best = found if abs(gap) == min(map(abs, known.values())) else best
            if abs(gap) < _MET * self.target.target.tolerance_percent / 100 and len(known) > 1:
                break
            at = next_size(known, low, high, falls=wall is None)
        return None if best is None else replace(best, slope=slope_of(known))

    def _bounds(self, radius: float, wall: float | None) -> tuple[float, float, float]:
        """Least and greatest size solved for, mm, and the first one: of the wall, or of the radius if that is given."""
        if wall is not None:
            given = self.target.given.inner_radius_mm
            return (given, given, given) if given is not None else (max(wall / _THICKEST, 1.0), radius, radius)
        feature = self.base.printer.smallest.wall("elastomer")
        least = feature.least or feature.recommended
        return float(np.ceil(least / _STEP) * _STEP), _THICKEST * radius, max(least, _WALL_SHARE * radius)

    def _trial(
        self, shape: str, sizes: Mapping[str, float], resin: CandidateResin, radius: float, wall: float, pressure: float
    ) -> ShapeTrial | None:
        own = {f"membrane.{key_of(name)}": _rounded(share * radius) for name, share in sizes.items()}
        changes: dict[str, Any] = {
            **setting_changes(self.target, self.library),
            "membrane.shape": shape,
            "membrane.material": resin.name,
            "membrane.inner_radius_mm": radius,
            "membrane.wall_thickness_mm": wall,
            **own,
            "pneumatics.driving_pressures_kPa": sorted({0.0, round(pressure / KPA, 6)}),
        }
        design = self.base.design
        plate = float(np.ceil(2 * PLATE_SHARE * radius))
        stated = "plate_diameter_mm" in design.indentation.model_fields_set
        if design.contact.is_plate and not stated and plate > design.indentation.plate_diameter_mm:
            changes["indentation.plate_diameter_mm"] = plate
        if (pressed := self._pressed(changes, pressure)) is None:
            return None
        sensor, state, _ = pressed
        usable = state.figures is not None and state.figures.sensitivity > 0.0
        short = state.range_end < _SHORTEST * sensor.protocol.depth
        return ShapeTrial(shape, resin, changes, *pressed) if usable and not short else None

    def _pressed(self, changes: Mapping[str, Any], pressure: float) -> tuple[Sensor, SensorState, float] | None:
        """Sensor with these changes, its state by the solid, and the diameter of the whole; None if it has none."""
        self.solves += 1
        try:
            scene = load_scene(source_of(self.base, _texts(changes)), {"indentation.checked_waves": 0}, self.library)
            assembly = assemble(scene)
            sensor = sensor_of(assembly)
            return sensor, solid_states(sensor, np.array([pressure]))[0], 2.0 * assembly.layout.plate_radius
        except (InputError, ComputationError) as error:
            self.refused = "; ".join(part for part in (error.problem, error.remedy) if part)
            return None

    def missed(self, shape: str) -> Missed:
        """Why a shape has no design, with changes of one field that would do, else of what its nearest misses."""
        if not (nearest := self.nearest.get((shape, ""))):
            return self.refused, ()
        _, why, met = nearest
        alone = sorted((size, key) for (of, key), (size, *_) in self.nearest.items() if of == shape and key)
        return why, tuple(self.nearest[shape, key][2] for _, key in alone) or (met,)

    def _meets(self, trial: ShapeTrial) -> bool:
        """True if a trial meets the target; what the nearest misses is kept."""
        misses = _misses(self.target, trial)
        if not misses:
            return True
        size = max(miss for miss, _, _ in misses.values())
        listed = ", ".join(f"{name} by {100 * miss:.3g} %" for name, (miss, _, _) in misses.items())
        met = {f"target.{key}": float(f"{value:.3g}") for _, key, value in misses.values()}
        for alone in ("", *(misses if len(misses) == 1 else ())):
            if size < self.nearest.get((trial.shape, alone), (np.inf,))[0]:
                why = f"the nearest, in {trial.resin.name}, misses {listed}"
                self.nearest[trial.shape, alone] = size, why, met
        return False


def _drawn(shape: str, sizes: Mapping[str, float]) -> DomeShape:
    """The shape at an inner radius of 10 mm, with the greatest of `_DRAWN_SHARES` that it can have."""
    own = {name: 10.0 * share for name, share in sizes.items()}
    for wall in _DRAWN_SHARES[:-1]:
        with suppress(ShapeError):
            return shape_of(shape, 10.0, 10.0 * wall, own)
    return shape_of(shape, 10.0, 10.0 * _DRAWN_SHARES[-1], own)


def _misses(target: Target, trial: ShapeTrial) -> dict[str, tuple[float, str, float]]:
    """Requirements that a trial misses, each with the share by which it does, its field, and what the trial meets."""
    wanted, figures = target.target, trial.figures
    stiffness, shape = figures.stiffness_at(wanted.stiffness_depth_mm), trial.sensor.dome.shape
    outer = 2.0 * max(shape.outer_radius, trial.sensor.dome.inner_radius)
    bounds = [
        ("force range", figures.force_high, True, "force_range_N"),
        ("least stiffness", stiffness, True, "stiffness_least_N_per_mm"),
        ("greatest stiffness", stiffness, False, "stiffness_most_N_per_mm"),
        ("diameter", outer, False, "max_diameter_mm"),
        ("footprint", trial.footprint, False, "max_footprint_mm"),
        ("height", shape.outer_height, False, "max_height_mm"),
    ]
    misses = {}
    if (wanted_kPa_per_N := wanted.sensitivity_kPa_per_N) is not None:
        gap = abs(figures.sensitivity / wanted_kPa_per_N - 1.0)
        if gap > wanted.tolerance_percent / 100:
            misses["sensitivity"] = gap, "sensitivity_kPa_per_N", figures.sensitivity
    for name, has, least, key in bounds:
        bound = getattr(wanted, key)
        if bound and not (has >= bound if least else has <= bound):
            misses[name] = abs(has / bound - 1.0), key, (0.995 if least else 1.005) * has
    return misses


def _texts(changes: Mapping[str, Any]) -> list[str]:
    return [f"{key}={value_text(value)}" for key, value in changes.items()]


def _rounded(size: float) -> float:
    return float(round(np.floor(size / _STEP + 1e-6) * _STEP, 2))
