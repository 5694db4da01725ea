"""A sample of the random presses on a mesh twice as fine: does it end the same, and as deep?

``python -m tests.stability.finer_mesh [DOME.PRESS ...]`` prints a sample of 50 of these presses, or of all, as rows of a
table, and then how many of them are confirmed. `tests.stability.random_scenes` prints which end before their depth.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.errors import PneutouchError
from tests.stability.random_scenes import DOMES, PRESSES, RADIUS, PressEnd, RandomDome, random_dome

SAMPLE = 50
#: Ends by a loss of stability: a jump to another branch, next to the clamp or elsewhere.
JUMPS = {"snap", "clamp_fold"}
#: Depths that agree, over the inner radius: a press of six steps has them 0.125 apart.
SAME_DEPTH = 0.1
#: Forces at the depth that agree, of the greater.
SAME_FORCE = 0.05


@dataclass(frozen=True)
class ComparedEnd:
    """A press on the mesh of the random scenes and on one twice as fine."""

    seed: int
    press: int
    dome: RandomDome
    coarse: PressEnd
    fine: PressEnd

    @property
    def confirmed(self) -> bool:
        """Both reach the depth with the same force; or both end by the same kind, or by a jump, at the same depth."""
        reached = [_reached(end) for end in (self.coarse, self.fine)]
        if None in reached:
            return self.coarse.kind == self.fine.kind
        (depth, force), (other_depth, other_force) = reached  # type: ignore[misc]
        if abs(depth - other_depth) > SAME_DEPTH * RADIUS:
            return False
        kinds = {self.coarse.kind, self.fine.kind}
        if kinds == {"depth"}:
            return bool(abs(force - other_force) <= SAME_FORCE * max(force, other_force))
        return len(kinds) == 1 or kinds <= JUMPS

    @property
    def row(self) -> str:
        """Row of the table."""
        (share, press), words = self.dome.presses[0], []
        for end in (self.coarse, self.fine):
            reached = _reached(end)
            words.append(end.kind if reached is None else f"{end.kind} {reached[0]:.2f} mm, {reached[1]:.4g} N")
        hold = "grip" if np.isinf(press.friction) else f"{press.friction:.2f}"
        body = "plate" if press.body is None else press.body.label
        verdict = "yes" if self.confirmed else "no"
        wall = f"{self.dome.wall:.2f}"
        cells = [f"{self.seed}.{self.press}", body, self.dome.resin, wall, f"{share:.2f}", hold, *words, verdict]
        return f"| {' | '.join(cells)} |"


def _reached(end: PressEnd) -> tuple[float, float] | None:
    """Indentation (mm) and force (N) at the end of a press; None where it has no path."""
    if isinstance(end.run, PneutouchError):
        return None
    events = [event.indentation for event in end.run.events if event.kind == end.kind]
    travel, force = end.run.column("indentation"), end.run.column("force")
    return float(events[-1] if events else travel[-1]), float(force[-1])


def sample(names: list[str] | None = None) -> list[tuple[int, int]]:
    """Domes and their presses, at most 50, drawn without repetition from all or from those named ``DOME.PRESS``."""
    names = names or [f"{seed}.{one}" for seed in range(DOMES) for one in range(PRESSES)]
    drawn = np.random.default_rng(0).permutation(len(names))[:SAMPLE]
    return [(int(seed), int(one)) for seed, one in (names[k].split(".") for k in sorted(drawn))]


def compared(seed: int, press: int) -> ComparedEnd:
    """One press on both meshes."""
    whole = random_dome(seed)
    dome = replace(whole, presses=whole.presses[press : press + 1])
    coarse, fine = (next(dome.runs(finer)) for finer in (1, 2))
    return ComparedEnd(seed, press, dome, coarse, fine)


def main(words: list[str]) -> None:
    """Print the rows as they are made, and the count."""
    confirmed = []
    for seed, press in sample(words):
        ends = compared(seed, press)
        confirmed.append(ends.confirmed)
        sys.stdout.write(f"{ends.row}\n")
        sys.stdout.flush()
    sys.stdout.write(f"{sum(confirmed)} of {len(confirmed)} confirmed\n")


if __name__ == "__main__":
    main(sys.argv[1:])
