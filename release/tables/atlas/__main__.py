"""Make the shipped atlas: ``make atlas``. Uses every core, goes on where it was stopped, shows its progress."""

from __future__ import annotations

import os
import pickle
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

import numpy as np
from rich.progress import Progress

from pneutouch.mechanics.atlas.recipe import RECIPE
from pneutouch.mechanics.atlas.surveyed import WallCoefficients, fit_sheet
from pneutouch.mechanics.atlas.table import SHIPPED
from release.tables.atlas.fit import join
from release.tables.atlas.stale import solid_fingerprint, survey_fingerprint
from release.tables.atlas.survey import survey

WORK = Path("outputs") / "atlas"


def _surveyed(wall_ratio: float, folder: Path) -> Path:
    """Survey one wall ratio, unless that was done before by the same solid and recipe."""
    path = folder / f"{wall_ratio:.6f}.pickle"
    if not path.exists():
        part = path.with_suffix(f".{os.getpid()}")
        part.write_bytes(pickle.dumps(survey(wall_ratio, RECIPE)))
        part.replace(path)
    return path


def _sheet(wall_ratio: float, folder: Path) -> WallCoefficients:
    return fit_sheet(pickle.loads(_surveyed(wall_ratio, folder).read_bytes()), RECIPE)


def main() -> None:
    folder = WORK / f"{survey_fingerprint(RECIPE)}-{solid_fingerprint()}"
    folder.mkdir(parents=True, exist_ok=True)
    walls = [float(wall) for wall in RECIPE.wall_ratios]
    with Progress() as bar, ProcessPoolExecutor(os.cpu_count()) as pool:
        task = bar.add_task("atlas", total=len(walls))
        runs = [pool.submit(_sheet, wall, folder) for wall in walls]
        for run in as_completed(runs):
            run.result()
            bar.advance(task)
        sheets = [run.result() for run in runs]
    tables = join(sheets, RECIPE)
    part = SHIPPED.with_suffix(".part.npz")
    np.savez_compressed(part, **tables, recipe=np.array(RECIPE.text()), solid=np.array(solid_fingerprint()))
    part.replace(SHIPPED)
    sys.stdout.write(f"{SHIPPED}: {SHIPPED.stat().st_size / 1e6:.2f} MB\n")


if __name__ == "__main__":
    main()
