"""Running of a sweep: resolve it, continue where it stopped, compute, write the dataset, clear up."""

import contextlib
import math
from collections import Counter
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import chain
from pathlib import Path

from pneutouch.catalogue import Library
from pneutouch.errors import ComputationError, InputError, joined
from pneutouch.stopping import uninterrupted
from pneutouch.workflows.sweep.dataset import parts_of, stored_dataset, stored_fingerprint, write_dataset
from pneutouch.workflows.sweep.grid import MAX_POINTS, SweepPlan
from pneutouch.workflows.sweep.journal import FinishedPoints, Journal, WorkFolder
from pneutouch.workflows.sweep.work import CHUNK_POINTS, Record, SweepStudy, chunks, study, unpack
from pneutouch.workflows.sweep.workers import cores, in_pool, in_process, on_cluster

Progress = Callable[[int, int], None]
"""Called with the number of points done and the number of all points."""


@dataclass(frozen=True, slots=True)
class SweepResult:
    """A finished sweep: path of its dataset, number of points, number of those ``computed`` by this call, number of
    states that are ok, refused or failed, and hash of the inputs."""

    path: Path
    points: int
    computed: int
    states: dict[str, int]
    input_hash: str


@dataclass(frozen=True, slots=True)
class ComputeResources:
    """Computers of a sweep: ``workers`` processes here (None: one per core), or the cluster of ``scheduler``."""

    workers: int | None = None
    scheduler: str | None = None


def sweep(
    plan: SweepPlan,
    out: Path,
    machines: ComputeResources = ComputeResources(),
    *,
    fresh: bool = False,
    yes: bool = False,
    progress: Progress = lambda done, total: None,
    library: Library | None = None,
) -> SweepResult:
    """Compute every point of a plan and write the dataset to ``out``; return a summary.

    Progress is kept in a folder, ``out`` with ``.parts`` added. A stopped sweep, however it was stopped, continues from
    there and ends with the same bytes. ``fresh`` discards progress and replaces a dataset that is there; without
    ``yes`` more than `MAX_POINTS` points are refused.

    Raises InputError before any work starts, ComputationError if it stops half way, with its progress kept. A
    KeyboardInterrupt is passed on with a note on the progress that is kept.
    """
    if machines.workers is not None and machines.workers < 1:
        raise InputError("must be at least 1", key="workers", value=machines.workers)
    if plan.count > MAX_POINTS and not yes:
        raise InputError(f"{plan.count} points", file=plan.where, remedy="`yes` computes them all the same")
    resolved = study(plan, library or Library.default())
    with WorkFolder(out) as folder:
        journal = Journal(folder.journal, resolved.fingerprint)
        points = FinishedPoints(resolved)
        if not fresh:
            journal.read(points.take)
        before = points.done
        if _is_there(resolved, out, fresh=fresh, resumed=before > 0):
            folder.finish(None)
            parts = (part["status"].values.ravel().tolist() for part in parts_of(stored_dataset(out)[["status"]]))
            return _outcome(resolved, out, 0, Counter(chain.from_iterable(parts)))
        if fresh:
            folder.restart()
        with _keeping(folder, points):
            _compute(machines, folder, journal, points, progress)
            folder.finish(partial(write_dataset, points, journal))
        return _outcome(resolved, out, plan.count - before, points.counts)


def _is_there(study: SweepStudy, out: Path, *, fresh: bool, resumed: bool) -> bool:
    """True if ``out`` is already this sweep's dataset and is to be kept. Raises InputError if it is another sweep's."""
    if not out.exists():
        return False
    stored = stored_fingerprint(out)
    if stored == study.fingerprint:
        return not fresh
    if not fresh and not resumed:
        raise InputError(
            f"{out} is the dataset of another sweep (input hash {stored[:12]}, this one {study.fingerprint[:12]})",
            key="out",
            remedy="`fresh` replaces it, or give another `out`",
        )
    return False


def _compute(
    machines: ComputeResources, folder: WorkFolder, journal: Journal, points: FinishedPoints, progress: Progress
) -> None:
    """Compute every missing point; each chunk is kept in the journal as soon as it is done."""
    total = points.study.plan.count
    progress(points.done, total)
    with contextlib.closing(_batches(machines, folder, points)) as batches:
        for batch in batches:
            with uninterrupted():
                points.take(batch, journal.append(batch))
            progress(points.done, total)


@contextlib.contextmanager
def _keeping(folder: WorkFolder, points: FinishedPoints) -> Iterator[None]:
    """Context that adds, to anything that stops the work, how far it came and that it can be continued."""

    def kept() -> str:
        return f"{points.done} of {points.study.plan.count} points are done and kept in {folder.path}"

    remedy = "the same command, without `fresh`, goes on from there"
    try:
        yield
    except KeyboardInterrupt as error:
        if points.done:
            error.add_note(f"{kept()}; {remedy}")
        raise
    except ComputationError as error:
        raise joined((error, ComputationError(kept(), remedy=remedy))) from None
    except OSError as error:
        first = ComputationError(f"{error.filename or folder.path}: cannot be written: {error.strerror or error}")
        raise joined((first, ComputationError(kept(), remedy=remedy))) from None


def _batches(
    machines: ComputeResources, folder: WorkFolder, points: FinishedPoints
) -> Generator[list[Record], None, None]:
    """Records of the missing points, chunk by chunk, as they are done."""
    study, missing = points.study, points.missing
    pieces = chunks(study, missing)
    workers = min(machines.workers or cores(), math.ceil(len(missing) / CHUNK_POINTS.get(study.plan.model, 1)))
    if machines.scheduler is not None:
        yield from on_cluster(study, pieces, machines.scheduler)
        return
    unpack(study.files, folder.files)
    yield from in_pool(pieces, folder.files, workers) if workers > 1 else in_process(pieces, folder.files)


def _outcome(study: SweepStudy, out: Path, computed: int, counted: Counter[str]) -> SweepResult:
    counts = {name: counted[name] for name in ("ok", "refused", "failed")}
    return SweepResult(out, study.plan.count, computed, counts, study.fingerprint)
