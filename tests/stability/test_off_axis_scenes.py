"""Random presses off the axis: each reaches its depth, or ends by an event or an error that names its kind."""

import pytest

from pneutouch.errors import InputError, PneutouchError
from tests.stability.off_axis_scenes import ended, random_scene

#: Scenes of the share that is tested.
SHARE = 30
#: A bar across a thin dome, sheared with little friction: most of its time goes into solves that fail.
HARDEST = 34


def test_a_scene_reaches_its_depth_and_one_that_touches_the_connector_says_what_works():
    end = ended(4)
    assert end.kind == "depth" and end.travelled == pytest.approx(0.75)
    refused = ended(6).run
    assert isinstance(refused, InputError) and refused.key == "contact.tilt_deg"
    assert "at most" in str(refused.remedy)


def test_scenes_are_of_all_kinds():
    tests = [random_scene(seed).sensor.protocol for seed in range(SHARE)]
    bodies = {"plate" if test.body is None else test.body.label.split(" of ")[0] for test in tests}
    assert bodies == {"plate", "ball", "edge", "cylinder"}
    assert any(test.shear for test in tests) and any(test.tilt for test in tests)
    assert {"none", "some", "grip"} == {
        "grip" if test.friction == float("inf") else "some" if test.friction else "none" for test in tests
    }


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(SHARE), HARDEST])
def test_random_scenes_end(seed):
    end = ended(seed)
    assert isinstance(end.run, PneutouchError) or end.travelled > 0.0
