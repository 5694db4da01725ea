"""First contact: of a soft dome whose first steps are hardly more than the noise, and of records zeroed inside the dome."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.indents import find_indents, protocol
from pneutouch.bench.reading import PLATE, read_blocks
from pneutouch.bench.source import identify
from pneutouch.spec.campaign import ColumnMap, Rig
from pneutouch.spec.options import SimulationOptions
from pneutouch.workflows.simulate import simulate
from tests.bench.recordings import CLEAR, DEEP, READ, Recording, true_figures
from tests.workflows.characterize.test_recordings import asked, figures, read

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


def zeroed_at(start, legs):
    """A recording that begins with the plate ``start`` mm inside the dome, where all channels are zeroed."""

    def zeroed(samples):
        rest = samples[:, (samples[0] > 0.01) & (samples[0] < 1.0)]
        return samples[:, 1:] - np.array([[0.0], *rest[1:].mean(axis=1)[:, None].tolist()])

    return Recording([(1e-4, start), (2.0, start), *legs], spoil=zeroed)


@pytest.mark.parametrize("start", [2.0, 3.0])
@pytest.mark.parametrize("pressed", ["triangles", "stairs"])
def test_a_record_zeroed_inside_the_dome_is_refused_with_the_place(start, pressed, tmp_path):
    legs = 2 * [(5.0, DEEP), (5.0, start), (2.0, start)]
    if pressed == "stairs":
        legs = [leg for depth in np.linspace(start + 0.5, DEEP, 7) for leg in ((0.3, depth), (4.0, depth))]
    (failure,) = read(tmp_path, zeroed_at(start, legs)).failures
    assert re.findall(r"([\d.]+) mm inside", failure.message) == [f"{start:.2g}"]


@pytest.mark.parametrize("start", [0.3, 0.4])
def test_a_record_zeroed_just_inside_the_dome_is_asked_about_and_has_no_interval(start, tmp_path):
    measured = read(tmp_path, zeroed_at(start, 2 * [(5.0, DEEP), (5.0, start), (2.0, start)]))
    assert asked(measured, "before the force rises", "clear of the dome")
    figure = figures(measured)["stiffness_N_per_mm"]
    assert figure.low is None and figure.high is None


@pytest.mark.parametrize("factors", [(1.4, 1.4), (2.0, 1.4), (2.5, 1.2), (1.2, 1.4)])
def test_a_stiffer_sensor_is_not_taken_for_a_record_zeroed_inside_the_dome(factors, tmp_path):
    of_force, of_rise = factors
    stiffer = Recording(spoil=lambda s: s * np.array([[1.0], [1.0], [of_force], [of_rise]]))
    assert figures(read(tmp_path, stiffer))["stiffness_N_per_mm"].value > 2


def test_the_clear_place_does_not_matter(tmp_path):
    """The plate waits just above the dome on its way in: that stay is no indentation."""
    waits = [(2.0, CLEAR), (0.5, -0.3), (3.0, -0.3), (7.0, DEEP), (7.5, CLEAR), (2.0, CLEAR)]
    measured = read(tmp_path, replace(READ["triangular"], legs=waits))
    (run,) = measured.runs
    assert run.kind == "loop"
    value = true_figures(READ["triangular"].at())["sensitivity_kPa_per_N"]
    assert figures(measured)["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)
