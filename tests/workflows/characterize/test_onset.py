"""First contact of a soft dome without pressure, whose first steps are hardly more than the force sensor's noise."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

from pneutouch.bench.indents import find_indents, protocol
from pneutouch.bench.reading import PLATE, read_blocks
from pneutouch.bench.source import identify
from pneutouch.spec.campaign import ColumnMap, Rig
from pneutouch.spec.options import SimulationOptions
from pneutouch.workflows.simulate import simulate

RADIUS = 8.73
SOFT = {"membrane.inner_radius_mm": RADIUS, "membrane.wall_thickness_mm": 0.9}


@pytest.mark.slow
def test_the_lightest_steps_do_not_decide_where_a_run_begins(tmp_path, library):
    options = SimulationOptions(kinds=["steps"], driving_pressures_kPa=[0.0], model="atlas", rest_s=10.0)
    folder = simulate("paper-dome", tmp_path, SOFT, options, library=library)
    campaign = tomllib.loads((folder / "campaign.toml").read_text())
    deepest, off = max(protocol("steps", RADIUS).depths), []
    for run in campaign["runs"]:
        source = identify(folder / run["file"], ColumnMap(), PLATE)
        blocks = read_blocks(source, Rig.model_validate(campaign["rig"]))
        off.append(find_indents(blocks).onset - (float(blocks.position.max()) - deepest))
    assert len(off) == 9
    assert np.abs(off).max() < 0.3 and np.sqrt(np.mean(np.square(off))) < 0.15, off
