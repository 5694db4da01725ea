"""Selection over shapes: the best design of each meets the target, as the solid says of its own design file."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import DesignSource, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.workflows.select.checks import source_of
from pneutouch.workflows.select.shapes import VARIANTS, _Search, select_shapes


def target(shapes, prefer=None, **given):
    wanted = {"sensitivity_kPa_per_N": 2.4, "driving_pressure_kPa": 12.0, **given}
    return validate(
        Target,
        {
            "target": wanted,
            "given": {"materials": ["TangoPlus"]},
            "setting": {"shapes": shapes},
            "weights": {"prefer": prefer},
        },
        "here",
    )


def predicted(design, selection, library):
    source = source_of(selection.base, design.assignments)
    return evaluate(DesignSource(source.name, source.content, "here"), library=library)


def check(design, selection, library):
    """The design file gives the figures that the selection states, within the solid's own error."""
    found, record = predicted(design, selection, library), design.record
    state = found.prediction.states[-1]
    assert state.figures.sensitivity == pytest.approx(record.sensitivity_kPa_per_N, rel=1e-3)
    assert state.figures.force_high == pytest.approx(record.force_range_end_N, rel=2e-3)
    assert record.sensitivity_kPa_per_N == pytest.approx(2.4, rel=0.05)
    assert record.driving_pressure_kPa == 12.0 <= record.rated_pressure_kPa
    assert not any(finding.severity == "error" for finding in found.findings_alone)


def test_the_best_disc_meets_the_target_and_lies_below_the_height(library):
    found = select_shapes(target(["disc"], "ball", max_height_mm=3.0, max_diameter_mm=22.0), "here", library)
    (best,) = found.designs
    check(best, found, library)
    assert best.record.height_mm <= 3.0 and best.record.inner_radius_mm <= 11.0
    # A boss spreads the load of a small ball; bare, the disc reads it as much more.
    assert "boss_radius_mm" in best.record.sizes
    assert best.ball == pytest.approx(1.0, abs=0.15)


@pytest.mark.slow
def test_each_shape_has_the_best_of_what_was_preferred(library):
    for prefer, key in (("travel", "travel_mm"), ("force", "force_range_end_N"), ("low", "height_mm")):
        found = select_shapes(target(["any"], prefer, max_diameter_mm=24.0), "here", library)
        values = [getattr(one, key) for one in found.record.designs]
        assert len(values) >= 4 and {one.shape for one in found.record.designs} | found.missed.keys() == VARIANTS.keys()
        assert values == sorted(values, reverse=prefer != "low")
        for design in found.designs[:2]:
            check(design, found, library)


def test_a_shape_that_cannot_meet_the_target_says_what_its_nearest_misses(library):
    found = select_shapes(target(["hemisphere"], max_height_mm=3.0, force_range_N=50.0), "here", library)
    assert not found.designs and found.missed.keys() == {"hemisphere"}
    assert found.record.met is False


@pytest.mark.parametrize(
    ("shape", "wanted"),
    [
        ("cap", {"sensitivity_kPa_per_N": 8.0, "max_diameter_mm": 12.0}),
        ("hemisphere", {"sensitivity_kPa_per_N": 4.0, "force_range_N": 6.0, "max_diameter_mm": 16.0}),
    ],
)
def test_a_target_with_any_one_of_the_changes_offered_is_met(shape, wanted, library):
    """Each change gives up what it names alone, so that nobody gives up more than he must."""
    offers = select_shapes(target([shape], **wanted), "here", library).missed[shape][1]
    assert offers
    for offer in offers:
        changed = wanted | {key.removeprefix("target."): value for key, value in offer.items()}
        assert select_shapes(target([shape], **changed), "here", library).record.met


def test_the_wall_of_a_flat_shape_lies_within_its_diameter():
    content = {
        "target": {"sensitivity_kPa_per_N": 2.0, "max_diameter_mm": 20.0},
        "given": {"inner_radius_mm": 10.0, "wall_thickness_mm": 1.0},
    }
    assert validate(Target, content | {"setting": {"shapes": ["disc"]}}, "here").given.inner_radius_mm == 10.0
    with pytest.raises(InputError):
        validate(Target, content, "here")


@pytest.mark.parametrize("shape", ["discus", "profile"])
def test_a_name_that_is_no_shape_to_search_is_refused(shape):
    with pytest.raises(InputError) as caught:
        target([shape])
    assert str(caught.value.key).startswith("setting.shapes") and caught.value.value == shape


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [("given", "graded", True), ("setting", "processes", ["any"]), ("weights", "contact_anywhere", True)],
)
def test_what_a_search_over_shapes_does_not_take_contradicts_it(table, key, value):
    content = {"target": {"sensitivity_kPa_per_N": 2.0}, "setting": {"shapes": ["any"]}}
    content.setdefault(table, {})[key] = value
    with pytest.raises(InputError):
        validate(Target, content, "here")


def test_a_height_is_for_shapes():
    content = {"target": {"sensitivity_kPa_per_N": 2.0, "max_height_mm": 6.0}}
    with pytest.raises(InputError) as caught:
        validate(Target, content, "here")
    assert "target.max_height_mm" in (caught.value.key, *caught.value.fields)


@pytest.mark.parametrize("shape", VARIANTS)
def test_every_shape_has_radii_to_try_below_a_limit(shape, library):
    scene = load_scene("paper-dome", {}, library)
    search_for = _Search(target([shape], max_diameter_mm=24.0, max_height_mm=12.0), scene, library)
    for sizes in VARIANTS[shape]:
        radii = search_for._radii(shape, sizes)
        assert len(radii) == 2 and all(1.0 < radius <= 12.0 for radius in radii)


def test_a_ball_is_compared_with_the_plate_at_the_same_force(library):
    found = select_shapes(target(["thimble"], max_diameter_mm=25.0, driving_pressure_kPa=0.0), "here", library)
    ((ratio,), (design,)) = [one.ball_reading_ratio for one in found.record.designs], found.designs
    fine = {"pneumatics.driving_pressures_kPa": [0.0], "indentation.steps": 60}
    source = source_of(found.base, design.assignments)
    ball, plate = (
        evaluate(
            DesignSource(source.name, source.content, "here"), {**fine, **more}, library=library
        ).prediction.states[0]
        for more in ({"contact.object": "ball", "contact.ball_radius_mm": 5.0}, {})
    )
    force = 0.98 * min(ball.figures.force_high, plate.figures.force_high)
    read = [np.interp(force, state.force, state.pressure_rise) for state in (ball, plate)]
    assert ratio == pytest.approx(read[0] / read[1], rel=0.05) and ratio > 0.7
