"""Compare the figures of the groups named, or of all: ``python -m tests.figures [GROUP ...]``; exit 1 where one differs."""

from __future__ import annotations

import sys

from tests.figures.compare import changes, leaves, plain
from tests.figures.store import GROUPS, collect, stored


def main(groups: list[str]) -> int:
    before, failed = stored(), False
    for group in groups:
        lines = list(changes(before[group], plain(collect(group))))
        numbers = sum(isinstance(leaf, int | float) for leaf in leaves(before[group]))
        sys.stdout.write("\n  ".join((f"{group}: {numbers} numbers, {len(lines)} differences", *lines)) + "\n")
        sys.stdout.flush()
        failed = failed or bool(lines)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or list(GROUPS)))
