"""Make the shipped table of contact anywhere: ``make contact-table``. Goes on where it was stopped."""

from __future__ import annotations

import os
import pickle
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from hashlib import sha256
from pathlib import Path

import numpy as np
from rich.progress import Progress

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.table import RECIPE, SHIPPED, digest
from release.tables.contact.build import jobs, joined, solve
from release.tables.contact.fingerprint import model_answers
from release.tables.contact.press import DomeState

WORK = Path("outputs") / "contact-table"


def _solved(kind: str, state: DomeState, folder: Path) -> tuple[Array, Array]:
    """A job's answer, unless it was solved before by the same model and recipe."""
    path = folder / f"{kind}-{'-'.join(f'{value:.6f}' for value in state)}.pickle"
    if not path.exists():
        part = path.with_suffix(f".{os.getpid()}")
        part.write_bytes(pickle.dumps(solve(RECIPE, kind, state)))
        part.replace(path)
    answer: tuple[Array, Array] = pickle.loads(path.read_bytes())
    return answer


def main() -> None:
    answers = model_answers(RECIPE)
    key = RECIPE.text() + " ".join(f"{x:.3g}" for x in answers)
    folder = WORK / sha256(key.encode()).hexdigest()[:16]
    folder.mkdir(parents=True, exist_ok=True)
    todo = list(jobs(RECIPE))
    workers = len(os.sched_getaffinity(0))
    with Progress() as bar, ProcessPoolExecutor(workers) as pool:
        task = bar.add_task("contact table", total=len(todo))
        runs = {pool.submit(_solved, kind, state, folder): (kind, state) for kind, state in todo}
        for run in as_completed(runs):
            run.result()
            bar.advance(task)
        tables = joined(RECIPE, {job: run.result() for run, job in runs.items()})
    part = SHIPPED.with_suffix(".part.npz")
    np.savez_compressed(part, **tables, model=answers, recipe=np.array(RECIPE.text()), digest=np.array(digest(tables)))
    part.replace(SHIPPED)
    sys.stdout.write(f"{SHIPPED}: {SHIPPED.stat().st_size / 1e3:.0f} kB, digest {digest(tables)}\n")


if __name__ == "__main__":
    main()
