"""Random presses off the axis: each reaches its depth, or ends by an event or an error that names its kind."""

import pytest

from pneutouch.errors import InputError, PneutouchError
from tests.stability.off_axis_scenes import ended, random_scene

#: Scenes of the share that is tested.
SHARE = 30
#: Bars across thin domes, sheared: near a limit point with little friction, and with points that come and go. With the
#: tractions of the guess in the tangent most of their solves failed.
HARDEST = (34, 41)


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
def test_a_ball_that_shears_a_thin_wall_needs_few_newton_steps():
    """248; 620 with the tractions of the guess in the tangent, those of solves that failed among them."""
    end = ended(36)
    assert end.kind == "shear" and end.newton_steps < 350


@pytest.mark.slow
@pytest.mark.parametrize("seed", HARDEST)
def test_a_bar_across_a_thin_dome_is_sheared_to_its_end(seed):
    end = ended(seed)
    assert end.kind == "shear" and end.newton_steps < 1200


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(SHARE), *HARDEST])
def test_random_scenes_end(seed):
    end = ended(seed)
    assert isinstance(end.run, PneutouchError) or end.travelled > 0.0
