"""The atlas's cost: processor time of full responses, beside the solid and a plain table of the same box."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from pneutouch.mechanics.atlas.table import shipped

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def figures(root) -> dict[str, float]:
    """Measured in a process of its own, on one thread."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.mechanics.atlas.stopwatch"], cwd=root, capture_output=True, text=True, check=True,
        env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    found: dict[str, float] = json.loads(done.stdout)
    return found


def test_three_hundred_thousand_responses_a_minute_and_one_within_five_milliseconds(figures, capsys):
    with capsys.disabled():
        print(  # noqa: T201
            f"\natlas, processor time on one core: {60 / figures['atlas_s']:,.0f} responses of 14 steps a minute "
            f"({1e6 * figures['atlas_s']:.0f} us each), one alone {1e3 * figures['single_s']:.2f} ms warm; the solid takes "
            f"{figures['solid_s'] / figures['atlas_s']:,.0f} times as long a response ({figures['solid_s']:.3f} s), "
            f"{figures['solid_s'] / figures['single_s']:,.0f} times as long as one alone"
        )
    assert 60 / figures["atlas_s"] >= 300_000
    assert figures["single_s"] <= 5e-3


def test_a_plain_table_of_answers_is_no_cheaper_way(figures, capsys):
    """A grid over the five numbers that a press depends on, linear between its nodes."""
    needed = figures["nodes"] * (figures["table_worst"] / 0.005) ** (5 / 2)
    with capsys.disabled():
        print(  # noqa: T201
            f"atlas against a linear table of sensitivities over (wall, pressure, gas, dead volume, depth) with "
            f"{figures['nodes']:,.0f} nodes: error of the table against the atlas, median {figures['table_median']:.2%}, greatest "
            f"{figures['table_worst']:.1%}; at second order it would need {needed:,.0f} nodes for 0.5 % everywhere; {1e6 * figures['table_s']:.2f} us a value, one figure instead of curves"
        )
    assert needed > 100 * shipped().recipe.walls * shipped().recipe.volumes * shipped().recipe.depths
