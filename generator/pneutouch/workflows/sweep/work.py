"""The work itself: a chunk of points in, a list of records out. Runs in this process, in others, or on a cluster.

A model that takes many points at once has its place in ``compute``.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.catalogue.cached_library import CachedLibrary
from pneutouch.errors import BeyondLimitError, InputError, PneutouchError
from pneutouch.evaluation.document import prediction_document
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.units import KPA
from pneutouch.workflows.sweep.plan import PRESSURES
from pneutouch.workflows.sweep.study import SweepPoint, SweepStudy
from pneutouch.workflows.sweep.variables import point_values, state_values

CHUNK_POINTS = {"membrane": 32}
"""Points handed out at once: about half a second of work, so that a stop loses and a slow machine delays little."""

Record = dict[str, Any]
"""A finished point as plain data: ``point`` (its number), ``states`` in order of driving pressure, ``values``."""


@dataclass(frozen=True, slots=True)
class SweepChunk:
    """Points to compute alike: which design and model."""

    points: tuple[SweepPoint, ...]
    design: str
    model: str
    closure: str
    clamp: str


def chunks(study: SweepStudy, indices: list[int]) -> list[SweepChunk]:
    """The points of these numbers, cut into chunks."""
    plan, size = study.plan, CHUNK_POINTS.get(study.plan.model, 1)
    return [
        SweepChunk(
            tuple(study.point(i) for i in indices[start : start + size]),
            study.name,
            plan.model,
            plan.closure,
            plan.clamp,
        )
        for start in range(0, len(indices), size)
    ]


def unpack(files: dict[str, str], folder: Path) -> None:
    """Write a study's files where ``compute`` finds them."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def compute(chunk: SweepChunk, folder: Path) -> list[Record]:
    """Predict every point of a chunk from the files in ``folder``; a point that cannot be is a record too."""
    library = CachedLibrary((folder,))
    return [_record(chunk, point, library) for point in chunk.points]


def _record(chunk: SweepChunk, point: SweepPoint, library: Library) -> Record:
    """One point. Driving pressures beyond the limit are refused one by one, and the rest is predicted."""
    left = point
    states: list[dict[str, Any]] = []
    refused: list[dict[str, Any]] = []
    values: dict[str, Any] = {}
    while left.driving_pressures_kPa:
        try:
            states, values = _predicted(chunk, left, library)
            break
        except InputError as error:
            # evaluate states the limit in words; the numbers are in the error that it was made from.
            beyond = error.__context__
            if not isinstance(beyond, BeyondLimitError):
                states = _stopped("refused", str(error), len(left.driving_pressures_kPa), library)
                break
            kept_kPa = [p for p in left.driving_pressures_kPa[:-1] if p * KPA < min(beyond.limit, beyond.pressure)]
            text = (
                f"driving pressure beyond the limit point, where the dome snaps: at most {beyond.limit / KPA:.2f} kPa"
            )
            refused += _stopped("refused", text, len(left.driving_pressures_kPa) - len(kept_kPa), library)
            values = {"limit_point_kPa": float(f"{beyond.limit / KPA:.12g}")}
            left = replace(left, driving_pressures_kPa=tuple(kept_kPa))
        except PneutouchError as error:
            states = _stopped("failed", str(error), len(left.driving_pressures_kPa), library)
            break
        except (MemoryError, OSError):
            raise
        except Exception as error:
            # One point that meets a fault of ours must not cost the others, which may be hours of work.
            text = f"internal fault ({type(error).__name__}: {error}); please report it with the design"
            states = _stopped("failed", text, len(left.driving_pressures_kPa), library)
            break
    return {"point": point.index, "states": states + refused, "values": values}


def _predicted(chunk: SweepChunk, point: SweepPoint, library: Library) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    changes = {**point.settings, PRESSURES: list(point.driving_pressures_kPa)}
    prediction = prediction_document(
        evaluate(chunk.design, changes, model=chunk.model, closure=chunk.closure, clamp=chunk.clamp, library=library)
    )
    return [state_values(state) for state in prediction["states"]], point_values(prediction)


def _stopped(status: str, message: str, count: int, library: Library) -> list[dict[str, Any]]:
    """States without figures. The folder of the files is a temporary one, so messages name the file alone."""
    folder = f"{library.folders[0]}/"
    return [{"status": status, "message": message.replace(folder, "")} for _ in range(count)]
