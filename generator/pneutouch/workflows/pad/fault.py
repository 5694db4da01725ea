"""The fault of a pad that explains readings which no object explains: a lost cell, or two channels that are swapped."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.export.reader.pad_reading import SURE, PadForceReader

_JUDGED, _MENDED = 20, 0.8
"""Number of readings by which a fault is looked for, and the share of them that it has to explain."""


class PadFault(NamedTuple):
    """A fault: cells ``lost`` or ``swapped``, by their numbers from 1, and the share of the readings that are explained
    with it."""

    kind: Literal["none", "lost", "swapped", "unknown"]
    cells: tuple[int, ...]
    explained: float


def find_fault(table: Mapping[str, Any], rises_kPa: Array) -> PadFault:
    """The lost cell or the two swapped channels that explain readings (m, n), kPa, of which the `_JUDGED` loudest
    count, by the table of a pad's reader.

    ``none`` where they are explained as they are, ``unknown`` where no single fault explains them."""
    loud_kPa = rises_kPa[np.argsort(rises_kPa.sum(axis=1))[::-1][:_JUDGED]]
    before = _explained(table, loud_kPa)
    if before >= SURE:
        return PadFault("none", (), before)
    count, found = rises_kPa.shape[1], []
    for one, other in combinations(range(count), 2):
        turned = loud_kPa.copy()
        turned[:, [one, other]] = loud_kPa[:, [other, one]]
        found.append(PadFault("swapped", (one + 1, other + 1), _explained(table, turned)))
    # A reading without one cell is explained more easily: of equals a swap is the fault.
    lost = [PadFault("lost", (k,), _explained(table, loud_kPa, [k])) for k in range(1, count + 1)]
    best = max([*found, *lost], key=lambda fault: fault.explained)
    return best if best.explained >= max(_MENDED, before + 0.2) else PadFault("unknown", (), before)


def pad_reader(table: Mapping[str, Any], left_out: Sequence[int] = ()) -> PadForceReader:
    """A reader of pressure rises, with cells left out by their numbers from 1."""
    reader = PadForceReader(table)
    reader.zero_kPa = [0.0] * len(reader.places)
    for number in left_out:
        reader.leave_out(number)
    return reader


def _explained(table: Mapping[str, Any], rises_kPa: Array, left_out: Sequence[int] = ()) -> float:
    """Share of readings that an object explains."""
    reader = pad_reader(table, left_out)
    return float(np.mean([reader.read(cells_kPa).kind != "outside" for cells_kPa in rises_kPa.tolist()]))
