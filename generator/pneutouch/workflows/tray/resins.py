"""Resin changes: which materials can share a job of a printer, in how few jobs, and in which order."""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise, permutations

from pneutouch.errors import InputError
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

_EXACT = 7
"""Up to this many different sets of resins the fewest jobs and the best order are found by trying all."""


def jobs(materials: Sequence[tuple[Material, ...]], printer: Printer, where: str = "tray") -> list[list[int]]:
    """Indices of ``materials`` (those of one part each) by job: fewest jobs, then fewest resins to load.

    A job's base resins must be in the printer at once, in one mode (`Printer.mode_for`). Raises InputError if a part
    cannot be printed at all.
    """
    kinds: dict[frozenset[str], list[int]] = {}
    for index, alone in enumerate(materials):
        kinds.setdefault(frozenset(resin for material in alone for resin in material.base_resins), []).append(index)
        if printer.mode_for(*alone) is None:
            raise InputError(f"the {printer.title} cannot print {_and(alone)} in one job", file=where)
    examples = [
        list({tuple(m.base_resins): m for i in indices for m in materials[i]}.values()) for indices in kinds.values()
    ]
    sets, indices = list(kinds), list(kinds.values())

    def fits(group: list[int]) -> bool:
        return printer.mode_for(*(m for k in group for m in examples[k])) is not None

    def load(group: list[int]) -> frozenset[str]:
        return frozenset[str]().union(*(sets[k] for k in group))

    orders = [_ordered(groups, list(map(load, groups))) for groups in _fewest(len(kinds), fits)]
    best = min(orders, key=lambda groups: changes(list(map(load, groups))))
    return [sorted(i for k in group for i in indices[k]) for group in best]


def changes(loads: Sequence[frozenset[str]]) -> int:
    """Number of resins that are changed from job to job, the first job's not counted."""
    return sum(len(after - before) for before, after in pairwise(loads))


def _fewest(count: int, fits: Callable[[list[int]], bool]) -> list[list[list[int]]]:
    """All partitions of ``range(count)`` into fewest groups that fit; one by first fit where there are too many."""
    if count > _EXACT:
        groups: list[list[int]] = []
        for k in range(count):
            home = next((group for group in groups if fits([*group, k])), None)
            if home is None:
                groups.append([k])
            else:
                home.append(k)
        return [groups]
    partitions = [groups for groups in _partitions(count) if all(map(fits, groups))]
    least = min(map(len, partitions))
    return [groups for groups in partitions if len(groups) == least]


def _partitions(count: int) -> Iterator[list[list[int]]]:
    if count == 0:
        yield []
        return
    for groups in _partitions(count - 1):
        for k in range(len(groups)):
            yield [*groups[:k], [*groups[k], count - 1], *groups[k + 1 :]]
        yield [*groups, [count - 1]]


def _ordered(groups: list[list[int]], loads: Sequence[frozenset[str]]) -> list[list[int]]:
    """Groups in the order with the fewest changes; the nearest next one where there are too many to try."""
    if len(loads) <= _EXACT:
        orders = permutations(range(len(loads)))
        best = min(orders, key=lambda order: (changes([loads[k] for k in order]), order))
        return [groups[k] for k in best]
    order, left = [0], list(range(1, len(loads)))
    while left:
        after = min(left, key=lambda k: (len(loads[k] - loads[order[-1]]), k))
        order.append(after)
        left.remove(after)
    return [groups[k] for k in order]


def _and(materials: Sequence[Material]) -> str:
    return " and ".join(dict.fromkeys(material.label for material in materials))
