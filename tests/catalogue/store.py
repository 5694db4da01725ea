"""Write the stored figures that the catalogue test compares with. Run it, and look at the difference."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.pipeline import evaluate

ROOT = Path(__file__).resolve().parents[2]
STORED = Path(__file__).with_name("stored.json")
KINDS = {"port": "ports", "seat": "seats", "mount": "mounts"}


def cases(library: Library) -> list[tuple[str, dict[str, str]]]:
    """Every design with every combination of parts."""
    combinations = itertools.product(*(library.shelf(kind) for kind in KINDS.values()))
    parts = [dict(zip(KINDS, combination, strict=True)) for combination in combinations]
    return [(design, chosen) for design in library.shelf("designs") for chosen in parts]


def label(design: str, parts: dict[str, str]) -> str:
    return " ".join([design, *parts.values()])


def figures(library: Library, design: str, parts: dict[str, str]) -> dict[str, Any]:
    """Volumes and figures of one case, rounded to what should never change unnoticed."""
    evaluation = evaluate(design, [f"connector.{key}={value}" for key, value in parts.items()], library=library)
    prediction = evaluation.prediction
    return {
        "volume_mm3": {solid.name: round(solid.volume, 4) for solid in evaluation.assembly.solids},
        "mesh_volume_mm3": {body.name: round(body.volume, 3) for body in evaluation.assembly.bodies},
        "triangles": {body.name: len(body.triangles) for body in evaluation.assembly.bodies},
        "dead_volume_mm3": round(evaluation.assembly.dead_volume, 4),
        "limit_point_kPa": round(1e3 * prediction.limit_point.driving_pressure, 5),
        "sensitivity_kPa_per_N": [round(state.figures.sensitivity, 5) for state in prediction.states],
        "force_range_N": [round(state.figures.force_range[1], 4) for state in prediction.states],
        "findings": sorted({f"{finding.severity} {finding.rule}" for finding in evaluation.findings}),
    }


if __name__ == "__main__":
    shelves = Library((ROOT,))
    content = {label(*case): figures(shelves, *case) for case in cases(shelves)}
    STORED.write_text(json.dumps(content, indent=1, sort_keys=True) + "\n", encoding="utf-8")
