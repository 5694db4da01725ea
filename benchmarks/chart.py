"""Write docs/background/accuracy.md with its charts: ``python -m benchmarks.chart``; with ``stored`` the page alone, from what is stored."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import full_depth, laws, peers, shares, speed_accuracy, validation, validity
from benchmarks.pages import off_axis_speed, speed
from benchmarks.pages.accuracy_text import LIMITS, answer, contact_section, inflation_section
from benchmarks.pages.speed_chart import chart
from benchmarks.scenes import SCENES
from benchmarks.theory import ship_errors, table_s1
from pneutouch.catalogue import Library

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"


def measure(library: Library) -> None:
    """Measure and store everything that takes minutes, and draw the charts."""
    ship_errors(library)
    speeds = {**speed_accuracy.measure(), "profile_shares": shares.shares()}
    paper = next(scene for scene in speeds["scenes"] if scene["scene"] == SCENES[1].name)
    programs = peers.measure(1e-3 * paper["reference"]["limit_pressure_kPa"])
    map_rows = validity.measure()
    _write("speed-accuracy.svg", chart(speeds, programs, read("off-axis-calculix.json")))
    _write("validity.svg", validity.draw(map_rows))
    _write("laws.svg", laws.draw(laws.curves()))
    stored = {"speed-accuracy": speeds, "peers": programs, "validity": map_rows, "full-depth": full_depth.measure()}
    for name, data in stored.items():
        _write(f"{name}.json", json.dumps(data, indent=1) + "\n")


def page(library: Library) -> str:
    """The whole page from what is stored; Table S1, the cap and the laws are computed, which takes seconds."""
    speeds, programs, off_axis = (read(f"{name}.json") for name in ("speed-accuracy", "peers", "off-axis-calculix"))
    cells = table_s1(library)
    parts = [
        answer(cells, speeds, programs, off_axis),
        contact_section(cells),
        speed.section(speeds, programs),
        off_axis_speed.section(off_axis),
        full_depth.section(read("full-depth.json")),
        validity.section(read("validity.json")),
        inflation_section(),
        laws.section(laws.curves()),
        LIMITS,
    ]
    return "\n".join(line for part in parts for line in part)


def read(name: str) -> Any:
    """A stored measurement."""
    return json.loads((DOCS / name).read_text(encoding="utf-8"))


def _write(name: str, text: str) -> None:
    (DOCS / name).write_text(text, encoding="utf-8")
    print(f"wrote docs/background/{name}")


def main(*words: str) -> None:
    library = Library((ROOT,))
    if "stored" not in words:
        measure(library)
        validation.main()
    _write("accuracy.md", page(library))


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    main(*sys.argv[1:])
