"""A material of a laboratory's own, from its tensile or puck test."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from pneutouch.api.fields import named_by_keyword, paths_of
from pneutouch.api.results import Result

if TYPE_CHECKING:
    from pneutouch.workflows.fit_material.fitted import FittedMaterial


def fit_material(
    data: str | Path | Sequence[str | Path],
    name: str,
    *,
    like: str | None = None,
    density_g_per_cm3: float | None = None,
    shore_a: Sequence[float] = (),
    gauge_length_mm: float | None = None,
    width_mm: float | None = None,
    thickness_mm: float | None = None,
    puck_mm: tuple[float, float] | None = None,
    bonded: bool = False,
    stretch_to: float | None = None,
    slack: float | None = None,
    lab: str | None = None,
) -> Result:
    """Fit a hyperelastic law to a tensile test (one file a specimen) or, with ``puck_mm``, to a puck test.

    ``puck_mm`` is its diameter and thickness. Nothing is written before `Result.save`, which writes the material file
    into the user's folder and plot and figures into the folder given. Raises InputError for data that make no law.
    """
    from pneutouch.bench.tensile.puck import PuckSize
    from pneutouch.bench.tensile.read import SpecimenSize
    from pneutouch.workflows.fit_material.document import document
    from pneutouch.workflows.fit_material.fitted import FitOptions, MaterialFacts
    from pneutouch.workflows.fit_material.run import fit_material as run

    files = paths_of(data, "data", "give the path of a table, or a list of such paths")
    size = SpecimenSize(gauge_length_mm, width_mm, thickness_mm)
    puck = None if puck_mm is None else PuckSize(*puck_mm, bonded)
    facts = MaterialFacts(like, density_g_per_cm3, tuple(shore_a), lab)
    with named_by_keyword():
        fitted = run(FitOptions(files, name, size, puck, stretch_to, slack, facts))
    return Result(f"Material {name}", document(fitted), partial(_written, fitted))


def _written(fitted: FittedMaterial, out: Path) -> Path:
    from pneutouch.workflows.fit_material.run import write_material

    return write_material(fitted, out)[0]
