"""A selection as data and as text; and the chosen design as a file."""

from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.errors import InputError
from pneutouch.evaluation.contact_object import contact_document
from pneutouch.parts import assemble
from pneutouch.rounding import tenths_below
from pneutouch.selection import Candidate, DroppedRequirement
from pneutouch.selection.missed import missed_percent
from pneutouch.units import KPA, ML
from pneutouch.workflows.select.contact import contact_notes, contact_text
from pneutouch.workflows.select.passing import RejectedDesign, write_assigned
from pneutouch.workflows.select.run import Confirmation, SelectionRun


def document(selection: SelectionRun) -> dict[str, Any]:
    """The selection as ``select`` prints it."""
    answer = selection.answer
    idealised = assemble(selection.base).dead_volume_note
    confirmed = [*selection.confirmed, *[None] * (len(answer.designs) - len(selection.confirmed))]
    return {
        "target": selection.target.model_dump(mode="json"),
        "base": selection.base.where,
        **({"dead_volume_note": idealised} if idealised else {}),
        **_contact(selection),
        "met": bool(answer.designs),
        "candidates": answer.candidates,
        "designs": [
            {
                "rank": rank,
                "runner_up": _is_runner_up(answer.designs, rank - 1),
                "passes_check": True if rank in selection.judged else None,
                **_choice(selection, choice, solid),
            }
            for rank, (choice, solid) in enumerate(zip(answer.designs, confirmed, strict=True), start=1)
        ],
        "nearest": None
        if answer.nearest is None
        else {
            **_choice(selection, answer.nearest, None),
            "misses_percent": missed_percent(selection.problem, answer.nearest),
        },
        "dropped_requirements": [_dropped(selection, dropped) for dropped in answer.dropped],
        "rejected": [_rejected(selection, rejected) for rejected in selection.rejected],
        "left_out": selection.left_out,
        **({"gauges": [trial.document() for trial in selection.gauges]} if selection.gauges else {}),
    }


def _contact(selection: SelectionRun) -> dict[str, Any]:
    """Pressing object and search with the solid, as data; empty for a contact that the atlas covers."""
    search = selection.by_solid
    if search is None:
        return {}
    notes = contact_notes(search, selection.base)
    record = contact_document(selection.base).get("contact", {"label": contact_text(selection.base)})
    return {"contact": {**record, "notes": notes, "rounds": search.rounds, "solves": search.solves}}


def _rejected(selection: SelectionRun, rejected: RejectedDesign) -> dict[str, Any]:
    design = _choice(selection, rejected.choice, None)
    return {"rule": rejected.rule, "reason": rejected.reason, "design": design}


def _dropped(selection: SelectionRun, dropped: DroppedRequirement) -> dict[str, Any]:
    best = _choice(selection, dropped.best, None)
    return {"requirement": dropped.requirement, "attainable": would_need(selection, dropped), "design": best}


def _is_runner_up(designs: list[Candidate], index: int) -> bool:
    return any(designs[index].resin.name == other.resin.name for other in designs[:index])


def _choice(selection: SelectionRun, choice: Candidate, solid: Confirmation | None) -> dict[str, Any]:
    pool, lines = choice.pool, choice.pool.response.lines
    sensitivity_kPa_per_N = float(lines.sensitivity_kPa_per_N[0])
    batch = selection.problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure)
    return {
        "material": choice.resin.name,
        "mix": None if choice.resin.grade is None else choice.resin.grade.model_dump(by_alias=True, exclude_none=True),
        "inner_radius_mm": float(pool.radius[0]),
        "wall_thickness_mm": float(pool.wall[0]),
        "driving_pressure_kPa": float(pool.pressure[0]) / KPA,
        "outer_diameter_mm": 2 * float(pool.radius[0] + pool.wall[0]),
        "footprint_mm": selection.footprint(choice),
        "dead_volume_mL": float(batch.dead_volume[0]) / ML,
        "sensitivity_kPa_per_N": sensitivity_kPa_per_N,
        "expanded_uncertainty_kPa_per_N": _known(sensitivity_kPa_per_N * choice.expanded),
        "expanded_uncertainty_relative": _known(choice.expanded),
        "coverage_factor": 2,
        **({"place_uncertainty_relative": choice.place} if selection.problem.anywhere else {}),
        "r_squared": float(lines.r_squared[0]),
        "force_range_N": [0.0, float(pool.force[0])],
        "range_end_mm": float(pool.response.range_end[0]),
        "range_ends_with": choice.ends_with,
        "stiffness_N_per_mm": float(lines.stiffness[0]),
        "limit_point_kPa": float(pool.response.limit_pressure[0]) / KPA,
        "rated_pressure_kPa": choice.rated / KPA,
        "above_rated_pressure": choice.margins["rated pressure"] < 0,
        "sensitivity_at_0kPa_and_rated_kPa_per_N": [_known(end) for end in choice.span],
        "margins": {name: _known(margin) for name, margin in choice.margins.items()},
        "binding": choice.binding,
        **_how(choice),
        "solid": None
        if solid is None
        else {
            "sensitivity_kPa_per_N": _known(solid.sensitivity_kPa_per_N),
            "within_expanded_uncertainty": solid.within,
        },
        "set": selection.assignments(choice),
    }


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _how(choice: Candidate) -> dict[str, Any]:
    """The model of the figures; of the solid's also the atlas's sensitivity under its plate, and the searches made."""
    if choice.contact is None:
        return {"model": "atlas"}
    plate_kPa_per_N = choice.contact.plate_kPa_per_N
    return {"model": "solid", "plate_sensitivity_kPa_per_N": plate_kPa_per_N, "rounds": choice.contact.rounds}


def would_need(selection: SelectionRun, dropped: DroppedRequirement) -> str:
    """Value that a requirement would need for the best design without it."""
    pool, lines = dropped.best.pool, dropped.best.pool.response.lines
    if dropped.requirement == "sensitivity":
        return (
            f"{float(lines.sensitivity_kPa_per_N[0]):.3g} kPa/N instead of {selection.problem.sensitivity_kPa_per_N:g}"
        )
    if dropped.requirement == "force range":
        return f"{float(pool.force[0]):.3g} N instead of {selection.problem.force_range:g}"
    if dropped.requirement == "stiffness":
        return f"{float(lines.stiffness[0]):.3g} N/mm"
    if dropped.requirement == "footprint":
        return f"{selection.footprint(dropped.best):.4g} mm instead of {selection.problem.max_footprint:g}"
    if dropped.requirement == "rated pressure":
        rated_kPa = tenths_below(dropped.best.rated / KPA)
        return f"rated {rated_kPa:.1f} kPa, driven at {float(pool.pressure[0]) / KPA:g} kPa"
    return f"{2 * float(pool.radius[0] + pool.wall[0]):.4g} mm instead of {selection.problem.max_diameter:g}"


def write_choice(
    selection: SelectionRun, choice: Candidate, name: str, folder: Path, *, overwrite: bool = False
) -> Path:
    """Save a choice as ``folder/name.toml``, a design that ``build`` takes; over a file with ``overwrite`` alone."""
    return write_assigned(selection.base.design, selection.assignments(choice), name, folder, overwrite=overwrite)


def pick(selection: SelectionRun, rank: int) -> Candidate:
    """The design of a rank, from 1. Raises InputError if there is none."""
    designs = selection.answer.designs
    if not 1 <= rank <= len(designs):
        raise InputError(f"must be from 1 to {len(designs)}", key="pick", value=rank)
    return designs[rank - 1]
