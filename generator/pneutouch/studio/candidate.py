"""Designs that a search found, as the page shows them: figures, page state, and the command that saves each.

A page state is a base that the page has open, and the fields in which the design differs from it.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pneutouch.catalogue import DesignSource, Library, ResolvedDesign
from pneutouch.cli.select import saving_command
from pneutouch.errors import InputError
from pneutouch.output.new import free_name
from pneutouch.results.selection import ShapeRecord
from pneutouch.selection import Candidate
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import validate
from pneutouch.spec.target import Shelf, Target
from pneutouch.spec.toml_text import assignments, flat
from pneutouch.studio.form import PAGE, Question, version_of
from pneutouch.units import KPA
from pneutouch.wording import tenths_below
from pneutouch.workflows.select.checks import assigned
from pneutouch.workflows.select.graded import GradedSelectionRun
from pneutouch.workflows.select.select import SelectionRun

FigureRow = tuple[str, str, str]
"""Name of a figure, its value with the unit, and a remark, which may be empty."""


@dataclass(frozen=True, slots=True)
class ChartPlace:
    """Place of a design on the trade-off chart."""

    sensitivity_kPa_per_N: float
    force_N: float


@dataclass(frozen=True, slots=True)
class CandidateFigures:
    """A design that was found: resin, rows of figures, and place on the chart; None for a rank or place it has not."""

    rank: int | None
    resin: str
    title: str
    at: ChartPlace | None
    rows: tuple[FigureRow, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CandidateCard(CandidateFigures):
    """A design as the page shows it, with the state that opens it there, and the command that saves it, if any."""

    kind: str
    label: str
    note: str
    passes: bool
    state: Question
    command: str | None


def candidate_figures(selection: SelectionRun, choice: Candidate, rank: int | None = None) -> CandidateFigures:
    """Figures of a candidate; ``rank`` is its place from 1, None if it does not meet the target."""
    pool = choice.pool
    sensitivity, force = float(pool.response.lines.sensitivity[0]), float(pool.force[0])
    rows = (*_figures(selection, choice), *_sizes(selection, choice), *_limits(selection, choice, rank))
    place = ChartPlace(sensitivity, force)
    return CandidateFigures(rank, choice.resin.name, choice.resin.material.label, place, rows)


def grade_figures(selection: GradedSelectionRun) -> CandidateFigures:
    """Figures of the best grade; it has no place on a chart."""
    best, dome = selection.search.best, selection.sensor.dome
    pressures_kPa = [p / KPA for p in selection.grade_target.pressures]
    rows: list[FigureRow] = []
    for at_kPa, sensitivity, force in zip(pressures_kPa, best.sensitivity, best.force, strict=True):
        rows.append((f"Sensitivity at {at_kPa:g} kPa", f"{sensitivity:.3f} kPa/N", ""))
        rows.append((f"Force range at {at_kPa:g} kPa", f"0 to {force:.1f} N", ""))
    rows += [("Inner radius R0", f"{dome.inner_radius:g} mm", ""), ("Wall t0", f"{dome.wall_thickness:g} mm", "")]
    if not best.note:
        rows.append(("Rated pressure", f"{tenths_below(best.rated / KPA):.1f} kPa", ""))
    title = selection.grade.label
    return CandidateFigures(1 if selection.passes else None, title, title, None, tuple(rows))


def shape_figures(found: ShapeRecord, rank: int) -> CandidateFigures:
    """Figures of the best design of a shape, of a rank from 1; it has no place on a chart."""
    ball = found.ball_reading_ratio
    sizes = [
        (key.removesuffix("_mm").replace("_", " ").capitalize(), f"{size:g} mm", "")
        for key, size in found.sizes.items()
    ]
    rows: list[FigureRow] = [
        ("Sensitivity", f"{found.sensitivity_kPa_per_N:.3f} kPa/N", "by the solid"),
        ("Driving pressure", f"{found.driving_pressure_kPa:g} kPa", "gauge, before contact"),
        ("Force range", f"0 to {found.force_range_end_N:.2f} N", f"travel {found.travel_mm:.2f} mm"),
        ("Stiffness", f"{found.stiffness_N_per_mm:.3g} N/mm", ""),
        (
            "Under a small ball",
            "no straight line" if ball is None else f"{100 * (ball - 1):+.0f} %",
            "of the sensitivity",
        ),
        ("Inner radius R0", f"{found.inner_radius_mm:g} mm", ""),
        ("Wall t0", f"{found.wall_thickness_mm:g} mm", ""),
        *sizes,
        ("Height", f"{found.height_mm:.1f} mm", "of the dome over its flange"),
        ("Diameter", f"{found.footprint_mm:.1f} mm", "of the whole sensor"),
        ("Rated pressure", f"{tenths_below(found.rated_pressure_kPa):.1f} kPa", ""),
    ]
    return CandidateFigures(rank, found.material, f"{found.shape}, {found.material}", None, tuple(rows))


def _figures(selection: SelectionRun, choice: Candidate) -> list[FigureRow]:
    lines, at_kPa = choice.pool.response.lines, float(choice.pool.pressure[0]) / KPA
    sensitivity, width = float(lines.sensitivity[0]), choice.expanded
    low_kPa_per_N, high_kPa_per_N = sensitivity * np.exp([-width, width])
    interval = f"{low_kPa_per_N:.2f} to {high_kPa_per_N:.2f} (k = 2)" if np.isfinite(width) else "interval not known"
    rows = [
        ("Sensitivity", f"{sensitivity:.3f} kPa/N", interval),
        ("Driving pressure", f"{at_kPa:.2f} kPa", "gauge, before contact"),
        ("Force range", f"0 to {float(choice.pool.force[0]):.2f} N", f"ends with {choice.ends_with}"),
        ("Stiffness", f"{float(lines.stiffness[0]):.3g} N/mm", ""),
    ]
    if selection.problem.anywhere and choice.place is not None:
        rows.append(("Unknown place of contact", f"{100 * choice.place:.0f} %", "of the sensitivity (k = 1)"))
    return rows


def _sizes(selection: SelectionRun, choice: Candidate) -> list[FigureRow]:
    radius, wall = float(choice.pool.radius[0]), float(choice.pool.wall[0])
    return [
        ("Inner radius R0", f"{radius:.2f} mm", ""),
        ("Wall t0", f"{wall:.2f} mm", ""),
        ("Diameter", f"{selection.footprint(choice):.1f} mm", f"dome {2 * (radius + wall):.2f} mm"),
    ]


def _limits(selection: SelectionRun, choice: Candidate, rank: int | None) -> list[FigureRow]:
    span = [f"{end:.2f}" if np.isfinite(end) else "none" for end in choice.span]
    rows = [
        ("Rated pressure", f"{tenths_below(choice.rated / KPA):.1f} kPa", f"S {span[0]} to {span[1]} kPa/N up to it"),
        ("Binds", choice.binding, choice.binding_margin),
    ]
    if choice.contact is not None:
        return [*rows, ("Under a plate", f"{choice.contact.plate_kPa_per_N:.3f} kPa/N", "by the atlas")]
    if rank is not None and rank <= len(selection.confirmed):
        solid = selection.confirmed[rank - 1]
        value = f"{solid.sensitivity:.3f} kPa/N" if np.isfinite(solid.sensitivity) else "none"
        rows.append(("By the solid", value, "in the interval" if solid.within else "outside the interval"))
    return rows


def state_of(design: DesignFile, base: str, bases: Mapping[str, str], library: Library) -> Question:
    """Page state of ``design``: ``base``, by the page's name for it, and by ``table.key`` the texts of the values that
    differ from the base's file, None for a key that is left out.

    Raises InputError if the page has no such base, or its file is wrong.
    """
    if base not in bases:
        raise InputError("unknown design", key="base", value=base)
    file = DesignSource.of(bases[base], library)
    before, after = (flat(one.model_dump(by_alias=True)) for one in (file.changed({}), design))
    values: dict[str, str | None] = {}
    for name in sorted(before | after):
        value = after.get(name)
        if value != before.get(name):
            values[name] = None if value is None else assignments({name: value})[0].partition("=")[2]
    return Question(base, values, version_of(file))


class CandidateStates:
    """Maker of page states of the designs found, and of the commands that save them under a free name."""

    def __init__(self, question: Question, bases: Mapping[str, str], library: Library, target: Target) -> None:
        self._bases, self._library, self._target, self._name = bases, library, target, free_name()
        if question.base not in bases:
            raise InputError("unknown design", key="base", value=question.base)
        named = (name for name, design in bases.items() if design == target.setting.base)
        self._base = question.base if target.setting.base is None else next(named)

    def state(self, base: ResolvedDesign, changes: list[str]) -> Question:
        """Page state of the design that ``select`` saves: ``base`` with the assignments ``changes``."""
        design = validate(DesignFile, assigned(base.design, changes, self._name), PAGE)
        return state_of(design, self._base, self._bases, self._library)

    def command(self, rank: int) -> str | None:
        """Command that saves the design of a rank; None if the target has a shelf, which only a file can give."""
        return saving_command(self._target, rank, self._name) if self._target.have == Shelf() else None
