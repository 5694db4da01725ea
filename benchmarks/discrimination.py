"""Objects and forces by several driving pressures: the paper's claim that several sensitivities raise confidence.

``python -m benchmarks.discrimination`` writes docs/background/discrimination.json.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from benchmarks.store import store
from pneutouch.evaluation.object_table import object_table
from pneutouch.evaluation.posterior import Posterior, interval, region, weights_of
from pneutouch.results.discrimination import DiscriminationRecord
from pneutouch.results.record import plain
from pneutouch.spec.options import DiscriminationOptions
from pneutouch.units import KPA
from pneutouch.workflows.discriminate import discriminate

PRESSURES, LEAST, EXAMPLE = (0.0, 12.0, 22.0), 6.0, (8.0, 1.3)
"""Driving pressures, kPa; least radius, mm; radius (mm) and force (N) of the object that is drawn."""

DRAWN, SOFTEST, TRAVEL = 1000, 0.05, 0.05
"""Random objects; modulus of the softest block, MPa; noise of a travel, mm."""


def main() -> None:
    """Measure and store."""
    table = object_table("paper-dome", None, PRESSURES, LEAST)
    asked = DiscriminationOptions(driving_pressures_kPa=list(PRESSURES))
    record = discriminate("paper-dome", None, asked)
    posterior = Posterior(table, record.noise_kPa * KPA, record.error_percent / 100.0)
    logs = posterior.logs(table.at(1.0 / EXAMPLE[0], EXAMPLE[1]))
    sets = [(0,), (1,), (2,), (0, 2), (0, 1, 2)]
    regions = {" + ".join(f"{PRESSURES[k]:g}" for k in one): outline(table, weights_of(logs, one)) for one in sets}
    plans = [discriminate("paper-dome", None, asked.model_copy(update={"plan": n})).plan for n in (1, 2, 3)]
    shares = covered(posterior, "curvature")
    found = {"told": plain(record), "regions": regions, "plans": plain(plans), "covered": shares}
    store("discrimination", found | {"blocks": plain(blocks(asked)), "covered_blocks": covered_blocks(record)})


def blocks(asked: DiscriminationOptions) -> list[DiscriminationRecord]:
    """Soft blocks, told without their travel and with it."""
    soft = asked.model_copy(update={"unknown": ["modulus", "force"]})
    return [discriminate("paper-dome", None, soft.model_copy(update={"travel_noise_mm": x})) for x in (None, TRAVEL)]


def covered_blocks(record: DiscriminationRecord) -> dict[str, float]:
    """`covered` of blocks whose travel is read."""
    table = object_table("paper-dome", None, PRESSURES, SOFTEST, told="modulus", travels=True)
    return covered(Posterior(table, record.noise_kPa * KPA, record.error_percent / 100.0, TRAVEL), "compliance")


def outline(table, weights) -> dict[str, list[float]]:
    """Least and greatest force of the 95 % region at each curvature that it has."""
    ordered = np.sort(weights.ravel())[::-1]
    inside = weights >= ordered[int(np.searchsorted(np.cumsum(ordered), 0.95))]
    rows = np.flatnonzero(inside.any(axis=1))
    low, high = (np.array([table.forces[np.flatnonzero(inside[k])[end]] for k in rows]) for end in (0, -1))
    digits = {"curvature": table.objects[rows], "low": low, "high": high}
    return {key: np.round(values, 5).tolist() for key, values in digits.items()} | {"share": region(weights)}


def covered(posterior: Posterior, name: str) -> dict[str, float]:
    """Shares of random objects whose curvature or compliance (``name``), and force, lie in their 95 % intervals."""
    table, random = posterior.table, np.random.default_rng(3)
    bends, logs = table.objects, np.log(table.forces)
    inside, count = np.zeros(2), itertools.count(1)
    while True:
        bend, log = random.uniform(bends[0], bends[-1]), random.uniform(logs[0], logs[-1])
        if log > math.log(table.reach(bend)):
            continue
        weights = posterior.of(posterior.drawn(table.at(bend, math.exp(log)), random), range(len(PRESSURES)))
        for k, (true, values, axis) in enumerate(((bend, bends, 1), (log, logs, 0))):
            low, high = interval(values, weights.sum(axis=axis))
            inside[k] += low <= true <= high
        if next(count) == DRAWN:
            return dict(zip((name, "force"), (inside / DRAWN).tolist(), strict=True))


if __name__ == "__main__":
    main()
