"""Selection, or search for a grade, as a record, and as text for the terminal and the studio."""

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.contact_object import contact_document
from pneutouch.parts import assemble
from pneutouch.results.record import SENSITIVITY_KEY, extended
from pneutouch.results.selection import (
    ConstantMembrane,
    DroppedChoice,
    FoundDesign,
    FoundGrade,
    GradedRecord,
    GradeFigures,
    NearestDesign,
    RankedDesign,
    RejectedChoice,
    SearchCost,
    SelectionRecord,
    SingleChange,
    SolidCheck,
)
from pneutouch.selection import Candidate, DroppedRequirement
from pneutouch.selection.choose import missed_percent
from pneutouch.selection.graded import GradeTrial, shares
from pneutouch.spec.target import Target
from pneutouch.spec.toml_text import value_text
from pneutouch.units import KPA, ML
from pneutouch.wording import counted, finite, tenths_below
from pneutouch.workflows.select.checks import RejectedDesign, contact_notes, contact_text
from pneutouch.workflows.select.graded import GradedSelectionRun
from pneutouch.workflows.select.select import Confirmation, SelectionRun


class WorkingChange(NamedTuple):
    """A change of one field of the target, ``table.key``, with which designs meet it: its value and the selection."""

    field: str
    value: Any
    run: SelectionRun

    @property
    def best(self) -> str:
        """The best design as text."""
        choice = self.run.answer.designs[0]
        radius, wall, figures = float(choice.pool.radius[0]), float(choice.pool.wall[0]), choice.pool.figures
        return f"{choice.resin.name}, R0 {radius:.2f} mm, t0 {wall:.2f} mm, {figures.sensitivity:.3f} kPa/N"


RelaxedValue = tuple[str, float]
"""Field of a target, ``table.key``, and its value."""


class Relief(NamedTuple):
    """For a target that no design meets: single changes that suffice, and by requirement the value that relaxes it."""

    changes: Sequence[WorkingChange] = ()
    options: Mapping[str, RelaxedValue] = MappingProxyType({})


NO_RELIEF: Relief = Relief()


def selected(selection: SelectionRun, relief: Relief = NO_RELIEF) -> SelectionRecord:
    """Selection as a record, as ``select`` prints it."""
    answer = selection.answer
    confirmed = [*selection.confirmed, *[None] * (len(answer.designs) - len(selection.confirmed))]
    return SelectionRecord(
        target=selection.target.model_dump(mode="json"),
        base=selection.base.where,
        dead_volume_note=assemble(selection.base).dead_volume_note or None,
        contact=_contact(selection),
        met=bool(answer.designs),
        candidates=answer.candidates,
        designs=tuple(
            extended(
                RankedDesign,
                _choice(selection, choice, solid),
                rank=rank,
                runner_up=any(choice.resin.name == before.resin.name for before in answer.designs[: rank - 1]),
                passes_check=True if rank in selection.judged else None,
            )
            for rank, (choice, solid) in enumerate(zip(answer.designs, confirmed, strict=True), start=1)
        ),
        nearest=None
        if answer.nearest is None
        else extended(
            NearestDesign,
            _choice(selection, answer.nearest),
            misses_percent=missed_percent(selection.problem, answer.nearest),
        ),
        dropped_requirements=tuple(
            DroppedChoice(each.requirement, would_need(selection, each), field, value, _choice(selection, each.best))
            for each in answer.dropped
            for field, value in [relief.options.get(each.requirement, (None, None))]
        ),
        single_changes=tuple(
            SingleChange(each.field, each.value, _choice(each.run, each.run.answer.designs[0]))
            for each in relief.changes
        ),
        rejected=tuple(
            RejectedChoice(each.rule, each.reason, _choice(selection, each.choice)) for each in selection.rejected
        ),
        left_out=selection.left_out,
        gauges=selection.gauges,
    )


def _contact(selection: SelectionRun) -> Mapping[str, Any] | None:
    """Pressing object and search by the solid, as data; None for a contact that the atlas covers."""
    search = selection.by_solid
    if search is None:
        return None
    notes = contact_notes(search, selection.base)
    record = contact_document(selection.base).get("contact", {"label": contact_text(selection.base)})
    return {**record, "notes": notes, "rounds": search.rounds, "solves": search.solves}


def _choice(selection: SelectionRun, choice: Candidate, solid: Confirmation | None = None) -> FoundDesign:
    pool, figures = choice.pool, choice.pool.figures
    batch = selection.problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure)
    by_solid = choice.contact
    return FoundDesign(
        material=choice.resin.name,
        mix=None if choice.resin.grade is None else choice.resin.grade.model_dump(by_alias=True, exclude_none=True),
        inner_radius_mm=float(pool.radius[0]),
        wall_thickness_mm=float(pool.wall[0]),
        driving_pressure_kPa=float(pool.pressure[0]) / KPA,
        outer_diameter_mm=2 * float(pool.radius[0] + pool.wall[0]),
        footprint_mm=selection.footprint(choice),
        dead_volume_mL=float(batch.dead_volume[0]) / ML,
        sensitivity_kPa_per_N=figures.sensitivity,
        expanded_uncertainty_kPa_per_N=finite(figures.sensitivity * choice.expanded),
        expanded_uncertainty_relative=finite(choice.expanded),
        coverage_factor=2,
        place_uncertainty_relative=choice.place if selection.problem.anywhere else None,
        r_squared=figures.r_squared,
        force_range_N=(0.0, figures.reach),
        range_end_mm=float(pool.response.range_end[0]),
        range_ends_with=choice.ends_with,
        stiffness_N_per_mm=figures.stiffness,
        stiffness_at_1mm_N_per_mm=finite(figures.stiffness_1mm),
        stiffness_at_3mm_N_per_mm=finite(figures.stiffness_3mm),
        limit_point_kPa=float(pool.response.limit_pressure[0]) / KPA,
        rated_pressure_kPa=choice.rated / KPA,
        above_rated_pressure=choice.margins["rated pressure"] < 0,
        sensitivity_at_0kPa_and_rated_kPa_per_N=tuple(finite(end) for end in choice.span),
        margins={name: finite(margin) for name, margin in choice.margins.items()},
        binding=choice.binding,
        model="atlas" if by_solid is None else "solid",
        plate_sensitivity_kPa_per_N=None if by_solid is None else by_solid.plate_kPa_per_N,
        rounds=None if by_solid is None else by_solid.rounds,
        solid=None if solid is None else SolidCheck(finite(solid.sensitivity), solid.within),
        set=tuple(selection.assignments(choice)),
    )


def would_need(selection: SelectionRun, dropped: DroppedRequirement) -> str:
    """Text for the value that a requirement would need for the best design found without it."""
    pool, figures = dropped.best.pool, dropped.best.pool.figures
    if dropped.requirement == "sensitivity":
        return f"{figures.sensitivity:.3g} kPa/N instead of {selection.problem.sensitivity:g}"
    if dropped.requirement == "force range":
        return f"{figures.reach:.3g} N instead of {selection.problem.force_range:g}"
    if dropped.requirement == "stiffness":
        return f"{figures.stiffness_at(selection.problem.stiffness_depth):.3g} N/mm"
    if dropped.requirement == "footprint":
        return f"{selection.footprint(dropped.best):.4g} mm instead of {selection.problem.max_footprint:g}"
    if dropped.requirement == "rated pressure":
        rated_kPa = tenths_below(dropped.best.rated / KPA)
        return f"rated {rated_kPa:.1f} kPa, driven at {float(pool.pressure[0]) / KPA:g} kPa"
    return f"{2 * float(pool.radius[0] + pool.wall[0]):.4g} mm instead of {selection.problem.max_diameter:g}"


def relaxed(selection: SelectionRun, dropped: DroppedRequirement) -> tuple[str | None, float | None]:
    """Field of the target, ``table.key``, and the value, rounded to the safe side, with which the best design without a
    requirement meets it; None for the rated pressure, as at another pressure the sensitivity is another."""
    pool, figures = dropped.best.pool, dropped.best.pool.figures
    least, stiffness = selection.problem.stiffness[0], figures.stiffness_at(selection.problem.stiffness_depth)
    if dropped.requirement == "sensitivity":
        return f"target.{SENSITIVITY_KEY}", float(f"{figures.sensitivity:.4g}")
    if dropped.requirement == "force range":
        return "target.force_range_N", _rounded(figures.reach, math.floor)
    if dropped.requirement == "stiffness" and least is not None and stiffness < least:
        return "target.stiffness_least_N_per_mm", _rounded(stiffness, math.floor)
    if dropped.requirement == "stiffness":
        return "target.stiffness_most_N_per_mm", _rounded(stiffness, math.ceil)
    if dropped.requirement == "footprint":
        return "target.max_footprint_mm", _rounded(selection.footprint(dropped.best), math.ceil)
    if dropped.requirement == "outer diameter":
        return "target.max_diameter_mm", _rounded(2 * float(pool.radius[0] + pool.wall[0]), math.ceil)
    return None, None


def _rounded(value: float, to: Callable[[float], int]) -> float:
    """The value rounded to a hundredth by ``to`` (floor or ceil)."""
    return to(100 * value) / 100


_FEW = 9.95
"""Percentages below this are shown with a decimal."""


def headline(selection: SelectionRun) -> str:
    """Line on the number of designs found, or that there is none."""
    answer = selection.answer
    if answer.designs:
        return f"{counted(len(answer.designs), 'design')} of {answer.candidates} candidates, on {selection.base.where}"
    if selection.rejected:
        return "no design that meets the target passes the check"
    return "no design meets the target"


def search_notes(selection: SelectionRun) -> list[str]:
    """Notes on the pressing object and on the search with the solid; empty for a contact that the atlas covers."""
    return [] if selection.by_solid is None else contact_notes(selection.by_solid, selection.base)


def missed_text(selection: SelectionRun, nearest: Candidate) -> str:
    """Text for the requirements that the nearest design misses, in percent of the required value."""
    parts = []
    for name, percent in missed_percent(selection.problem, nearest).items():
        allowed = f" ({100 * selection.problem.tolerance:g} % is allowed)" if name == "sensitivity" else ""
        digits = 1 if percent is not None and percent < _FEW else 0
        parts.append(f"{name}, not known" if percent is None else f"{name} by {percent:.{digits}f} %{allowed}")
    cavity = float(nearest.pool.response.cavity_volume[0])
    behind = float(selection.problem.dead_volume(nearest.pool.radius)[0])
    why = f"; {behind / ML:.2f} mL of gas lie behind a cavity of {cavity / ML:.2f} mL"
    return (", ".join(parts) or "nothing once rounded") + (why if nearest.binding == "sensitivity" else "")


Typed = Callable[[str, Any], str]
"""Function from a field of a target, ``table.key``, and its value to the text that a person types."""


def in_file(field: str, value: Any) -> str:
    """Line of a target file for a field and its value."""
    return f"{field} = {value_text(value)}"


def dropped_lines(selection: SelectionRun, relief: Relief = NO_RELIEF, typed: Typed = in_file) -> list[str]:
    """Lines on each single requirement without which a design fits, with the value reached; or one line on none."""
    lines = []
    for dropped in selection.answer.dropped:
        needs = f"{would_need(selection, dropped)} ({dropped.best.resin.name})"
        known = relief.options.get(dropped.requirement)
        option = "" if known is None else f": {typed(*known)}"
        lines.append(f"without the requirement on {dropped.requirement} alone a design fits: {needs}{option}")
    none = "no design fits with any single requirement dropped" if selection.problem.resins else "no resin was searched"
    return lines or [none]


def relief_lines(selection: SelectionRun, relief: Relief, typed: Typed) -> list[str]:
    """`dropped_lines`, and the changes each of which alone lets a design meet the target, requirements unchanged."""
    lines = [f"{typed(change.field, change.value)}: {change.best}" for change in relief.changes]
    head = ["with the same requirements, one of these alone is enough:"] if lines else []
    return [*dropped_lines(selection, relief, typed), *head, *lines]


def remarks(selection: SelectionRun) -> list[str]:
    """Lines on the mount for a finger, the gauges considered, designs that the check rejects, resins left out, and
    the walls searched if no design was found."""
    return [
        *mount_note(selection.target, selection.base),
        *(f"gauge {'chosen' if one.chosen else 'out'}: {one.gauge}: {one.why}" for one in selection.gauges),
        *(_rejected_words(one) for one in selection.rejected),
        *left_out_lines(selection),
    ]


def left_out_lines(selection: SelectionRun) -> list[str]:
    """Lines on the resins left out, and on the walls searched if no design was found."""
    box = selection.problem.recipe
    walls = f"searched: walls of {box.thinnest:g} to {box.thickest:g} R0, which the atlas covers"
    lines = grouped(selection.left_out)
    return lines if selection.answer.designs or not selection.problem.resins else [*lines, walls]


def grouped(left: Mapping[str, str]) -> list[str]:
    """Lines on what was left out, by name, those with one reason together."""
    return [
        f"left out: {', '.join(name for name in left if left[name] == why)}: {why}"
        for why in dict.fromkeys(left.values())
    ]


def mount_note(target: Target, base: ResolvedDesign) -> list[str]:
    """Line on the sleeve for the target's finger, if its name states another finger's diameter; else none."""
    diameter_mm, name = target.target.finger_diameter_mm, base.design.connector.mount
    if diameter_mm is None or name.endswith(f"-{diameter_mm:g}"):
        return []
    return [f"mount: {base.mount.title}: {name} with connector.finger_diameter_mm = {diameter_mm:g}"]


def _rejected_words(one: RejectedDesign) -> str:
    """Line on a design that the check rejects, with the reason."""
    pool = one.choice.pool
    size = f"{one.choice.resin.name}, R0 {pool.radius[0]:.2f} mm, t0 {pool.wall[0]:.2f} mm"
    return f"rejected: {size}: {one.rule + ': ' if one.rule else ''}{one.reason}"


def graded(selection: GradedSelectionRun) -> GradedRecord:
    """Search for a graded wall as a record, as ``select`` prints it."""
    search, sensor = selection.search, selection.sensor
    return GradedRecord(
        target=selection.target.model_dump(mode="json"),
        base=selection.base.where,
        contact=contact_document(selection.base).get("contact"),
        met=search.met,
        design=extended(
            FoundGrade,
            _figures(selection, search.best),
            material=selection.grade.model_dump(by_alias=True, exclude_none=True),
            inner_radius_mm=sensor.dome.inner_radius,
            wall_thickness_mm=sensor.dome.wall_thickness,
            dead_volume_mL=sensor.gas.dead_volume / ML,
            share_used=shares(selection.grade_target, search.best),
            passes_check=True if selection.passes else None,
            set=tuple(selection.assignments()),
        ),
        rejected=selection.rejected,
        constant=tuple(
            extended(ConstantMembrane, _figures(selection, each.trial), name=each.name, fraction=each.fraction)
            for each in selection.constants
        ),
        nearest_constant_mix=selection.nearest.name,
        cost=SearchCost(selection.solves, len(search.trials)),
        model="solid",
        left_out=selection.left_out,
    )


def _figures(selection: GradedSelectionRun, trial: GradeTrial) -> GradeFigures:
    return GradeFigures(
        driving_pressures_kPa=tuple(p / KPA for p in selection.grade_target.pressures),
        sensitivity_kPa_per_N=tuple(map(finite, trial.sensitivity)),
        difference_percent=finite(100 * trial.difference),
        force_range_end_N=tuple(map(finite, trial.force)),
        range_ends_with=tuple(trial.ends),
        rated_pressure_kPa=None if trial.note else trial.rated / KPA,
        above_rated_pressure=max(selection.grade_target.pressures) > trial.rated,
        meets=selection.meets(trial),
        reason=trial.note or None,
    )


def graded_missed(selection: GradedSelectionRun) -> list[str]:
    """Lines on requirements that the best grade misses, and on the sensitivities of all grades tried at this size."""
    grade_target, best = selection.grade_target, selection.search.best
    values = ", ".join(f"{value:.3f}" for value in best.sensitivity)
    texts = {
        "sensitivity": f"{values} kPa/N instead of {grade_target.sensitivity:g} within "
        f"{100 * grade_target.tolerance:g} %",
        "same sensitivity": f"{100 * best.difference:+.1f} % apart instead of "
        f"{100 * (grade_target.same_within or 0):g} %",
        "limit pressure": f"0.9 of it is {best.highest / KPA:.1f} kPa, less than "
        f"{max(grade_target.pressures) / KPA:g} kPa",
        "force range": f"{best.reach:.3g} N instead of {grade_target.force or 0:g}",
        "no figures": best.note or "no straight part to fit",
    }
    lines = [f"{name}: {texts[name]}" for name, used in shares(grade_target, best).items() if used > 1.0]
    known_kPa_per_N = np.array(
        [trial.sensitivity for trial in selection.search.trials if np.isfinite(trial.sensitivity).all()]
    )
    if known_kPa_per_N.size:
        lines.append(
            f"all grades tried of this size have {known_kPa_per_N[:, 0].min():.2f} to "
            f"{known_kPa_per_N[:, 0].max():.2f} kPa/N at {grade_target.pressures[0] / KPA:g} kPa"
        )
    return lines


def rated_warning(selection: GradedSelectionRun) -> str | None:
    """Warning text for a driving pressure above the rated one; None if there is none."""
    best, highest = selection.search.best, max(selection.grade_target.pressures)
    if best.note or highest <= best.rated:
        return None
    return (
        f"{highest / KPA:g} kPa is above the grade's rated pressure of {tenths_below(best.rated / KPA):.1f} kPa: its "
        "modulus follows from an assumed mixing curve; measure it on coupons first, or ask for no more than that"
    )
