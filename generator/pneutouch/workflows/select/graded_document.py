"""A search for a grade as a record, and in words."""

import numpy as np

from pneutouch.evaluation.contact_object import contact_document
from pneutouch.results.record import extended
from pneutouch.results.selection import ConstantMembrane, FoundGrade, GradedRecord, GradeFigures, SearchCost
from pneutouch.rounding import tenths_below
from pneutouch.selection.graded import GradeTrial, shares
from pneutouch.units import KPA, ML
from pneutouch.workflows.select.graded import GradedSelectionRun


def graded(selection: GradedSelectionRun) -> GradedRecord:
    """The search as ``select`` prints it."""
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
        sensitivity_kPa_per_N=_known(trial.sensitivity),
        difference_percent=_known((100 * trial.difference,))[0],
        force_range_end_N=_known(trial.force),
        range_ends_with=tuple(trial.ends),
        rated_pressure_kPa=None if trial.note else trial.rated / KPA,
        above_rated_pressure=max(selection.grade_target.pressures) > trial.rated,
        meets=selection.meets(trial),
        reason=trial.note or None,
    )


def _known(values: tuple[float, ...]) -> tuple[float | None, ...]:
    return tuple(float(value) if np.isfinite(value) else None for value in values)


def missed(selection: GradedSelectionRun) -> list[str]:
    """Requirements that the best grade misses, and the range over which it can be moved at this size, in words."""
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
            f"{known_kPa_per_N[:, 0].max():.2f} kPa/N at "
            f"{grade_target.pressures[0] / KPA:g} kPa"
        )
    return lines


def rated_warning(selection: GradedSelectionRun) -> str | None:
    """Warning of a driving pressure above the rated one, in words; None if there is none."""
    best, highest = selection.search.best, max(selection.grade_target.pressures)
    if best.note or highest <= best.rated:
        return None
    return (
        f"{highest / KPA:g} kPa is above the grade's rated pressure of {tenths_below(best.rated / KPA):.1f} kPa: its "
        "modulus follows from an assumed mixing curve; measure it on coupons before driving it so far"
    )
