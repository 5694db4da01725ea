"""Pads for a wanted resolution: patterns of similar cells, each read back under random balls; and pads side by side."""

import math
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.mechanics.gauge_reading import PAPER_NOISE, gauge_reading
from pneutouch.mechanics.touch.cell import RADII, CellTable
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.mechanics.touch.objects import random_objects
from pneutouch.mechanics.touch.reader_table import reader_table
from pneutouch.mechanics.touch.resolution import resolution
from pneutouch.output.files import CHARTS_MANIFEST, replace_own
from pneutouch.report.chart import Chart, Panel, PlotLine, drawn_svg
from pneutouch.report.style import FAINT
from pneutouch.spec.pad import MOST_CELLS, PadTable
from pneutouch.units import KPA, ML, STANDARD_ATMOSPHERE
from pneutouch.workflows.pad.campaign import noise_kPa
from pneutouch.workflows.pad.fault import pad_reader
from pneutouch.workflows.pad.load import ResolvedPad
from pneutouch.workflows.pad.pad_sheet import pad_record
from pneutouch.workflows.pad.touch import Tabulate, pad_model, pad_pressure_kPa

SIMILAR = Path(__file__).with_name("similar_cell.npz")
"""Table of a cell of R0 2.78 mm, wall 1 mm, of TangoPlus, at 12 kPa, pitch 9 mm, with 1.5 mL behind it; all cells are
similar to it (`python -m benchmarks.pads` writes it)."""
PITCH, BEHIND = 9.0, 1.5 * ML
"""Pitch of that table's pad, mm, and gas behind its cell, mm3, which a larger cell has alike."""
_PITCHES, _CONTACTS, _LOUD = (6.0, 40.0), 48, 20.0
"""Least and greatest pitch tried, mm; number of balls that each pad reads, and rise in noises from which they count."""


class PadTarget(NamedTuple):
    """Wanted of a pad: extent of the area, mm; median errors of force, relative, and of place, mm, under balls of a
    radius, mm; most gauges; greatest height of the unloaded domes over their flange, mm."""

    area: tuple[float, float]
    force_error: float
    place_error: float
    ball: float
    gauges: int
    gauge: str | None = None
    height: float = math.inf


class PadTrial(NamedTuple):
    """A pad tried: its pattern, pitch, and median errors of force, relative, and of place, mm, under random balls, and
    the share of them that it reads."""

    layout: str
    cells: int
    pitch: float
    force_error: float
    place_error: float
    read: float

    def meets(self, target: PadTarget) -> bool:
        """True if both errors and the height are at most what is wanted."""
        low = sum(self.sizes) <= target.height
        return low and self.force_error <= target.force_error and self.place_error <= target.place_error

    @property
    def sizes(self) -> tuple[float, float]:
        """Inner radius and wall of its cells, mm."""
        table = similar_cell()
        return table.radius * self.pitch / PITCH, (table.outer - table.radius) * self.pitch / PITCH


@cache
def similar_cell() -> CellTable:
    """The shipped table."""
    with np.load(SIMILAR) as file:
        return CellTable.of({name: file[name].astype(float) for name in file.files})


def select_pads(target: PadTarget) -> list[PadTrial]:
    """The pads tried, by their number of cells, each the widest grid of its number whose domes cover the area.

    Raises InputError for an area or a ball that none fits."""
    noise = _noise(target.gauge)
    grids: list[tuple[str, float]] = []
    for cells in range(2, min(target.gauges, MOST_CELLS) + 1):
        rows = min(
            (n for n in range(1, cells + 1) if cells % n == 0),
            key=lambda n: max(target.area[0] * n / cells, target.area[1] / n),
        )
        pitch = max(target.area[0] * rows / cells, target.area[1] / rows)
        tabulated = RADII[0] <= target.ball / (similar_cell().radius * pitch / PITCH) <= RADII[-1]
        # More cells of the same pitch only reach beyond the area.
        finer = not grids or pitch < grids[-1][1] * (1.0 - 1e-9)
        if _PITCHES[0] <= pitch <= _PITCHES[1] and tabulated and finer:
            grids.append((f"grid:{rows}x{cells // rows}", pitch))
    if not grids:
        pitches = "{:g} to {:g} mm".format(*_PITCHES)
        problem = f"no grid of at most {target.gauges} cells, {pitches} apart, covers this under such a ball"
        remedy = "give another area, more gauges, or a ball of 1 to 20 inner radii of a cell, each a third of the pitch"
        raise InputError(problem, key="pad", value="{:g}x{:g}".format(*target.area), remedy=remedy)
    return [_trial(target, *grid, noise) for grid in grids]


def _trial(target: PadTarget, layout: str, pitch: float, noise: float) -> PadTrial:
    places = np.array(PadTable(cell="cell", layout=layout, pitch_mm=pitch).places)
    table = similar_cell().scaled(pitch / PITCH)
    own = BEHIND * (pitch / PITCH) ** 3
    model = PadModel.alike(places, table, np.full(len(places), (own + table.cavity) / (BEHIND + table.cavity)))
    balls = random_objects(model, "ball", 12 * _CONTACTS, np.random.default_rng(2))
    balls[:, 2] = table.radius / target.ball
    half = 0.5 * np.array(target.area)
    balls = balls[(np.abs(balls[:, :2]) <= half).all(axis=1)]
    known = model.under_balls(balls[:, :2], np.full(len(balls), target.ball), balls[:, 3])
    loud = np.flatnonzero(known.inside & (known.rise.max(axis=1) > _LOUD * noise))[:_CONTACTS]
    reader, random = pad_reader(reader_table(model, noise / KPA)), np.random.default_rng(3)
    rises_kPa = (known.rise[loud] + noise * random.standard_normal((loud.size, len(places)))) / KPA
    told = [reader.read(cells_kPa) for cells_kPa in rises_kPa.tolist()]
    force, x, y = np.array([(one.force_N, one.x_mm, one.y_mm) for one in told]).reshape(-1, 3).T
    read = np.isfinite(force)
    if not read.any():
        return PadTrial(layout, len(places), pitch, math.inf, math.inf, 0.0)
    off, away = np.abs(force / known.force[loud] - 1.0), np.column_stack([x, y]) - known.centre[loud]
    errors = float(np.median(off[read])), float(np.median(np.hypot(*away[read].T)))
    return PadTrial(layout, len(places), pitch, *errors, float(read.mean()))


def _noise(name: str | None) -> float:
    """Standard deviation of a reading of a gauge, MPa; of the paper's without a name, or where it is unknown."""
    gauge = None if name is None else Library.default().load("gauges", name, key="gauge")
    scatter = gauge_reading(gauge, STANDARD_ATMOSPHERE).scatter
    return PAPER_NOISE if scatter is None else scatter


def compared(pad: ResolvedPad, made_by: Tabulate | None = None) -> dict[str, str]:
    """Values of a pad by what they are, for a comparison: those of its record, and the median standard deviations of a
    reading of random balls. Raises InputError as `pad_model`."""
    record, model = pad_record(pad), pad_model(pad, pad_pressure_kPa(pad), made_by)
    balls = random_objects(model, "ball", 1000, np.random.default_rng(1))
    left = resolution(model, "ball", balls, noise_kPa(pad) * KPA)
    values = {
        "cells": f"{len(record.cells)}, {record.layout}",
        "pitch, mm": f"{record.pitch_mm:.3g}",
        "size, mm": "{:.1f} x {:.1f}".format(*record.width_mm),
        "manifold, mm": f"{record.thickness_mm:.3g}",
        "mass, g": f"{sum(solid.mass for solid in pad.solids):.3g}",
        "force of a ball +-, N, median": f"{np.median(left.force):.2g}",
        "its place +-, mm, median": f"{np.median(left.place):.2g}",
    }
    for number, _ in pad.worst_kinds:
        cell = record.cells[pad.file.pad.group_of.index(number)]
        for one in cell.states:
            values[f"cell {cell.number} at {one.driving_pressure_kPa:g} kPa, kPa/N"] = one.text
    return values


def write_pad_chart(trials: list[PadTrial], target: PadTarget, folder: Path) -> None:
    """Write ``pad-trade-off.svg``: both errors over the number of cells, with what is wanted. Raises InputError as
    `replace_own`."""
    cells = tuple(one.cells for one in trials)
    panels = []
    for y, key, scale, wanted in (
        ("median error of force  (%)", "force_error", 100.0, target.force_error),
        ("median error of place  (mm)", "place_error", 1.0, target.place_error),
    ):
        errors = [scale * getattr(one, key) for one in trials]
        line = PlotLine(cells, errors, marker="o", filled=True)
        limit = PlotLine([cells[0], cells[-1]], [scale * wanted] * 2, "wanted", tone=FAINT, width=3.0, over=2)
        panels.append(Panel("number of cells over the same area", y, (limit, line), zero="y", ticks=cells))
    svg = drawn_svg(Chart(tuple(panels), (150.0, 75.0), across=2)).encode()
    replace_own({folder / "pad-trade-off.svg": svg}, folder / CHARTS_MANIFEST, "charts")
