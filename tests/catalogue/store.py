"""Write the stored figures that the catalogue test compares with. Run it, and look at the difference."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation import evaluate
from pneutouch.parts import Assembly, assemble
from pneutouch.spec.read import parse_changes

ROOT = Path(__file__).resolve().parents[2]
STORED = Path(__file__).with_name("stored.json")
KINDS = {"port": "ports", "seat": "seats", "mount": "mounts"}
BASE = "stiff-dome"
"""A design whose bodies one machine prints, so that every seat can be made."""

SMALL = ("membrane.inner_radius_mm=8", "membrane.wall_thickness_mm=1.2")
"""A dome that every seat, port and mount has room for."""


CAST = {"cast-ring": ("print.profile=silicone-casting", "membrane.material=DragonSkin20")}
"""What the base design needs for seats that only a cast membrane takes."""


def printed_combinations(library: Library) -> list[tuple[str, str, str]]:
    """Those of `combinations` that a printed membrane takes."""
    return [parts for parts in combinations(library) if parts[1] not in CAST]


def combinations(library: Library) -> list[tuple[str, str, str]]:
    """Every port with every seat and every mount."""
    return list(itertools.product(*(library.paths(kind) for kind in KINDS.values())))


def assembled(library: Library, parts: tuple[str, str, str], *more: str) -> Assembly:
    """The base design with a combination of parts and further overrides."""
    chosen = [f"connector.{key}={value}" for key, value in zip(KINDS, parts, strict=True)]
    chosen += CAST.get(parts[1], ())
    return assemble(load_scene(BASE, parse_changes([*chosen, *more]), library))


def shape_figures(assembly: Assembly) -> dict[str, Any]:
    """Volumes and triangles of an assembly, rounded to what should never change unnoticed."""
    return {
        "volume_mm3": {solid.name: round(solid.volume, 4) for solid in assembly.solids},
        "mesh_volume_mm3": {body.name: round(body.volume, 3) for body in assembly.bodies},
        "triangles": {body.name: len(body.triangles) for body in assembly.bodies},
        "internal_volume_mm3": round(assembly.internal_volume, 4),
    }


def design_figures(library: Library, design: str) -> dict[str, Any]:
    """Figures and findings of a design as it is shipped."""
    evaluation = evaluate(design, library=library)
    prediction, point = evaluation.prediction, evaluation.prediction.limit_point
    return {
        **shape_figures(evaluation.assembly),
        "dead_volume_mm3": round(evaluation.assembly.dead_volume, 4),
        "limit_point_kPa": None if point is None else round(1e3 * point.driving_pressure, 5),
        "sensitivity_kPa_per_N": [round(state.figures.sensitivity, 5) for state in prediction.states],
        "force_range_N": [round(state.figures.force_range[1], 4) for state in prediction.states],
        "findings": sorted({f"{finding.severity} {finding.rule}" for finding in evaluation.findings}),
    }


if __name__ == "__main__":
    library = Library((ROOT,))
    content = {
        "designs": {design: design_figures(library, design) for design in library.paths("designs")},
        "parts": {" ".join(parts): shape_figures(assembled(library, parts, *SMALL)) for parts in combinations(library)},
    }
    STORED.write_text(json.dumps(content, indent=1, sort_keys=True) + "\n", encoding="utf-8")
