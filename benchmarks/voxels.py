"""Voxel stacks of the graded dome: whole stacks, the dithers and the rasters (about two minutes).

``python -m benchmarks.voxels`` writes docs/background/voxels.json and the picture of a stack, voxels.png.
"""

from __future__ import annotations

import json
import resource
import tempfile
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from benchmarks.voxel_dither import compare
from benchmarks.voxel_raster import measure
from pneutouch.catalogue import Library, load_scene
from pneutouch.export.voxels.read import read_stack
from pneutouch.parts import assemble
from pneutouch.workflows.build.voxels import plan_voxels, write_voxels
from pneutouch.workflows.show.voxels import draw

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"


def stack(assembly: Any, library: Library, mode: str) -> dict[str, Any]:
    """One whole stack: what it took and what came out."""
    start = time.process_time()
    plan = plan_voxels(assembly, mode=mode, library=library)
    with tempfile.TemporaryDirectory() as scratch:
        folder, _ = write_voxels(plan, Path(scratch), "")
        seconds = time.process_time() - start
        start = time.process_time()
        held = read_stack(folder)
        reading = time.process_time() - start
        if mode == "High Mix":
            draw(held, DOCS / "voxels.png")
        return {
            "mode": mode,
            "layer_um": held.manifest["layer_um"],
            "pixels": held.manifest["pixels"],
            "layers": held.manifest["layers"],
            "seconds": seconds,
            "reading_seconds": reading,
            "peak_MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
            "MB": sum(path.stat().st_size for path in folder.iterdir()) / 1e6,
            "bodies": held.manifest["bodies"],
        }


def main() -> None:
    library = Library((ROOT,))
    assembly = assemble(load_scene("graded-dome", None, library))
    found = {
        "stacks": [stack(assembly, library, mode) for mode in ("High Mix", "High Quality")],
        "dithers": [asdict(row) for row in compare()],
        "rasters": [asdict(row) for row in measure(assembly.solids[0])],
    }
    (DOCS / "voxels.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
