"""Failure: an answer that is wrong and does not say so.

Hostile input ends converged, in a typed event or in a typed error. Whatever comes
back as a state is balanced again here, against the test's own definition of the loads.
"""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.errors import ComputationError, InputError
from pneutouch.mechanics.events import BREAKS_CURVE
from pneutouch.mechanics.laws import mooney_rivlin, neo_hookean, ogden, yeoh
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import UnreachableLoadError
from pneutouch.shape.hemisphere import Hemisphere
from tests.stability.truth import ENDS_BRANCH, Study, free_unbalance, other_branch

MU, R0 = 0.17, 9.25
TANGO = neo_hookean(MU)
ENDS_PATH = {*BREAKS_CURVE, "floor"} - {"separation"}


def study(*, wall=1.5, law=TANGO, pressure=0.022, depth=0.5 * R0, steps=6, mesh=None, **options):
    solid = SolidModel(mesh or dome(Hemisphere(R0, wall)), law)
    free = state_at(solid, pressure)
    assert free_unbalance(solid, free) <= 1.0
    return Study.of(solid, free, PressSettings(depth, steps, **options))


def holds(found: Study) -> str:
    """How it ended, once every state has been balanced again."""
    assert found.unbalance() <= 1.0
    assert found.gas_error() < 1e-9 or found.press.ambient == 0.0
    assert all(np.isfinite(s.positions).all() for s in found.found.path)
    if found.found.complete:
        assert len(found.found.states) == found.press.steps + 1
        return "complete"
    assert found.found.events[-1].kind in ENDS_PATH
    return found.found.events[-1].kind


CONVERGES = {
    "a thousandth below the limit": {"pressure": 0.999 * 0.0395921},
    "pressure of a picobar": {"pressure": 1e-13},
    "a bubble's wall": {"wall": 0.01 * R0, "pressure": 0.5 * 1.5 * MU * 0.01},
    "a wall of 0.9 radii": {"wall": 0.9 * R0, "pressure": 0.0},
    "no air outside or inside": {"pressure": 0.0, "ambient": 0.0},
    "ten thousand bar": {"ambient": 1000.0},
    "a room as dead volume": {"dead_volume": 1e12},
    "a needle for a plate": {"plate_diameter": 0.1},
    "an endless plate": {"plate_diameter": None},
    "a micrometre deep": {"depth": 1e-3},
    "one per cent of a cell": {"depth": 1e-5, "steps": 1},
    "no shear to speak of": {"law": neo_hookean(1e-9), "pressure": 1e-10, "ambient": 6e-10},
    "nu 0.001": {"law": neo_hookean(MU, 0.001)},
    "nu 0.49999": {"law": neo_hookean(MU, 0.49999)},
    "Ogden, alpha 0.5": {"law": ogden(((MU, 0.5),))},
    "Ogden, alpha -9": {"law": ogden(((MU, -9.0),))},
    "Ogden, alpha 12": {"law": ogden(((MU, 12.0),))},
    "Mooney-Rivlin, C2 below zero": {"law": mooney_rivlin(0.1, -0.015)},
    "Mooney-Rivlin, C1 below zero": {"law": mooney_rivlin(-0.05, 0.135), "pressure": 0.010},
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CONVERGES)
def test_hostile_sensors_converge(case):
    assert holds(study(**CONVERGES[case])) == "complete"


def test_the_plate_driven_through_the_base_ends_in_an_event():
    for depth in (R0, 30.0):
        found = study(depth=depth)
        assert holds(found) in ENDS_PATH
        assert found.found.path[-1].inner_apex > 0.0


def test_suction_at_its_limit_under_the_plate_ends_in_an_event():
    found = study(pressure=-0.020)
    assert holds(found) == "snap"
    assert found.found.path[-1].indentation < 0.25 * R0


BAD = {
    "below vacuum": (UnreachableLoadError, "vacuum", {"wall": 3.7, "law": neo_hookean(5.33), "pressure": -0.15}),
    "beyond the limit point": (UnreachableLoadError, "beyond the limit", {"pressure": 0.0397}),
    "an endless pressure": (UnreachableLoadError, "beyond the limit", {"pressure": np.inf}),
    "an endless suction": (UnreachableLoadError, "beyond the limit", {"pressure": -np.inf}),
    "a pressure that is no number": (UnreachableLoadError, "cannot be carried", {"pressure": np.nan}),
    "a softening law": (UnreachableLoadError, "limit 20.2", {"law": yeoh(0.085, -0.05, 0.0)}),
    "dead volume below zero": (ValueError, "dead_volume", {"dead_volume": -1.0}),
    "endless dead volume": (ValueError, "finite", {"dead_volume": np.inf}),
    "endless air": (ValueError, "finite", {"ambient": np.inf}),
    "air below zero": (ValueError, "ambient", {"ambient": -0.1}),
    "air that is no number": (ValueError, "ambient", {"ambient": np.nan}),
    "depth zero": (ValueError, "depth", {"depth": 0.0}),
    "depth that is no number": (ValueError, "depth", {"depth": np.nan}),
    "no steps": (ValueError, "steps", {"steps": 0}),
    "no plate": (ValueError, "plate_diameter", {"plate_diameter": 0.0}),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_a_typed_error_that_names_it(case):
    error, words, options = BAD[case]
    with pytest.raises(error, match=words):
        study(**options)


@pytest.mark.parametrize(
    "law",
    [
        lambda: neo_hookean(-1.0),
        lambda: neo_hookean(np.nan),
        lambda: neo_hookean(1.0, 0.5),
        lambda: neo_hookean(1.0, 0.7),
        lambda: mooney_rivlin(0.1, -0.2),
        lambda: yeoh(-0.1, 1.0, 1.0),
        lambda: ogden(((0.1, 2.0), (-0.3, 4.0))),
    ],
)
def test_laws_that_are_no_solid_are_refused(law):
    with pytest.raises(InputError):
        law()


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    [
        {"steps": 1000},
        {"law": neo_hookean(MU, 0.4999999)},
        {"law": yeoh(0.085, -0.05, 0.0), "pressure": 0.0},
        {"law": ogden(((1.0, 2.0), (-0.83, 3.0)))},
        {"mesh": dome(Hemisphere(R0, 1.5), arc=200, through=3)},
        {"pressure": -0.0272},
        {"pressure": 0.0, "wall": 0.02 * R0, "depth": 0.9 * R0},
    ],
)
def test_slow_hostile_sensors(options):
    assert holds(study(**options)) in {"complete", *ENDS_PATH}


@pytest.mark.slow
def test_a_hundred_sensors_at_the_edges_of_everything(capsys):
    rng = np.random.default_rng(100)
    ends: dict[str, int] = {}
    for _ in range(100):
        radius, mu = 10 ** rng.uniform(-1, 3), 10 ** rng.uniform(-3, 3)
        law = neo_hookean(mu, float(rng.choice([0.3, 0.45, 0.49, 0.499, 0.4999])))
        solid = SolidModel(dome(Hemisphere(radius, radius * float(rng.choice([0.02, 0.05, 0.1, 0.3, 0.7])))), law)
        run = inflate(solid, past_limit=1.0)
        try:
            free = state_at(solid, float(rng.choice([0.0, 0.5, 0.9, 0.99, 0.9999])) * run.limit.pressure, run)
            press = PressSettings(
                radius * float(rng.choice([0.01, 0.5, 0.75, 0.99])),
                int(rng.choice([1, 3, 30])),
                rng.choice([None, 0.5 * radius, 3.0 * radius]),
                mu * float(rng.choice([0.0, 0.1, 100.0])),
                radius**3 * float(rng.choice([0.0, 1.0, 1e3])),
                np.inf,
            )
            found = Study.of(solid, free, press)
            end = holds(found)
            # A jump is proved by a second equilibrium at the same plate height. Out here a sharp but reversible kink can
            # be taken for one: that ends the range early, never late, and must stay rare.
            if end in ENDS_BRANCH:
                end += " to a lower state" if other_branch(found) is not None else " not proved"
        except ComputationError as error:
            end = type(error).__name__
            assert "try" in str(error) or "limit" in str(error)
        ends[end] = ends.get(end, 0) + 1
    with capsys.disabled():
        print(f"\n100 sensors at the edges: {ends}")  # noqa: T201
    assert sum(ends.values()) == 100 and ends["complete"] >= 80
    assert sum(count for end, count in ends.items() if "not proved" in end) <= 2
