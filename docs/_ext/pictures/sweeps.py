"""Draw docs/howto/sweep-map.svg, as the command of the page draws it."""

from __future__ import annotations

from pathlib import Path

from pneutouch.catalogue import Library
from pneutouch.report.swept import contour_map
from pneutouch.stopping import temporary_folder
from pneutouch.workflows.sweep import plan_of_flags, sweep
from pneutouch.workflows.sweep.dataset import stored_dataset, sweep_maps
from pneutouch.workflows.sweep.execute import ComputeResources

ROOT = Path(__file__).resolve().parents[3]

OVER = ["membrane.wall_thickness_mm=0.6:3:16", "membrane.inner_radius_mm=4:12:16"]
"""The fields of the page's command."""


def sweep_map() -> str:
    """The force range over wall and radius at two driving pressures, and the states that are not predicted."""
    plan = plan_of_flags("paper-dome", OVER, {"pneumatics.driving_pressures_kPa": [0.0, 22.0]}, model="atlas")
    with temporary_folder() as folder:
        sweep(plan, folder / "map.nc", ComputeResources(workers=1), library=Library((ROOT,)))
        text, _ = contour_map(sweep_maps(stored_dataset(folder / "map.nc"))["force-range"])
    # The drawing has a ground of its own under the one of the file.
    return text[text.index("<svg") :].replace('\n <rect width="100%" height="100%" fill="#ffffff"/>', "")


if __name__ == "__main__":
    (ROOT / "docs" / "howto" / "sweep-map.svg").write_text(sweep_map(), encoding="utf-8")
