"""A wall whose modulus varies: against exact answers, itself refined, and what an energy cannot do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixed_material
from pneutouch.errors import InputError
from pneutouch.mechanics import predict
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.choice import models_for
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.elements import Gas
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.spec.grade import Grade
from pneutouch.units import KPA
from tests.mechanics.solid.derivatives import assert_derivatives

TOP = 0.356
"""Last fraction of the mixing curve: 31 times the soft resin's modulus."""
PLACES = np.linspace(0.0, 1.0, 65)


def sensor(*fractions: float) -> Sensor:
    """The paper's sensor of TangoPlus with these fractions of VeroClear at even knots."""
    fraction = fractions[0] if len(fractions) == 1 else list(fractions)
    grade = Grade.model_validate({"from": "TangoPlus", "to": "VeroClear", "fraction": fraction})
    return material_sensor(mixed_material(grade, Library.default(), file="test"))


def moduli(one: Sensor) -> np.ndarray:
    """Moduli at `PLACES`, MPa."""
    assert one.wall.grade is not None
    return one.wall.shear_modulus * np.array(one.wall.grade[1])


def solid_of(modulus: np.ndarray) -> SolidModel:
    """The paper's dome with moduli at `PLACES`."""
    return SolidModel(
        dome(Hemisphere(9.25, 1.5)),
        neo_hookean(1.0),
        grade=lambda r, z: np.interp(Hemisphere(9.25, 1.5).arc_share(r, z), PLACES, modulus),
    )


def smooth(r, z):
    return 1.0 + 4.0 * Hemisphere(9.25, 1.5).arc_share(r, z) ** 2


# ------------------------------------------------------------------------------------------- the solid itself


def test_an_even_grade_is_the_plain_solid():
    plain = sensor(0.1)
    even = plain.replace(grade=((0.0, 0.4, 1.0), (1.0, 1.0, 1.0)))
    one, other = (solid_result(s, np.array([0.0, 0.012]), past_limit=1.0) for s in (plain, even))
    assert other.limits.limit_point == pytest.approx(one.limits.limit_point, rel=1e-12)
    for a, b in zip(one.states, other.states, strict=True):
        np.testing.assert_allclose(b.force, a.force, rtol=1e-12, atol=1e-12)
        assert b.figures.sensitivity == pytest.approx(a.figures.sensitivity, rel=1e-12)


def test_only_the_product_of_modulus_and_grade_counts():
    stiff = sensor(0.0, 0.25)
    other = stiff.replace(
        shear_modulus=0.4 * stiff.wall.shear_modulus,
        grade=(stiff.wall.grade[0], tuple(2.5 * g for g in stiff.wall.grade[1])),
    )
    one, two = (solid_result(s, np.array([0.012]), past_limit=1.0) for s in (stiff, other))
    assert two.limits.limit_point == pytest.approx(one.limits.limit_point, rel=1e-9)
    # Where solved states lie follows rounding; what is read between them differs by what a cubic leaves.
    assert two.limits.break_strain == pytest.approx(one.limits.break_strain, rel=1e-4)
    assert two.states[0].figures.sensitivity == pytest.approx(one.states[0].figures.sensitivity, rel=1e-4)
    np.testing.assert_allclose(two.states[0].max_von_mises, one.states[0].max_von_mises, rtol=1e-4)


def test_residual_and_tangent_are_derivatives_of_the_graded_energy():
    solid = SolidModel(
        dome(Hemisphere(9.25, 1.5), arc=8),
        neo_hookean(0.17),
        grade=lambda r, z: np.exp(3.4 * Hemisphere(9.25, 1.5).arc_share(r, z)),
    )
    rng = np.random.default_rng(7)
    x = solid.rest + solid.expand(2e-3 * rng.normal(size=solid.size))
    scene = SolidScene(solid, Gas.filled(0.1, 2.1, 0.6, 0.2), Plate(1.1, 0.3, 0.1))
    assert_derivatives(scene, x, rng, step=1e-7, rel=1e-5)


def test_a_sphere_graded_through_its_wall_has_the_exact_limit_point():
    """Incompressible neo-Hookean, mu(R) = 3 - R/R0 between 1 and 2 R0: p = int 2 mu (l^2 - l^-4) dr / r, l = r / R."""

    def pressure(inner):
        def part(place):
            deformed = (place**3 + inner**3 - 1.0) ** (1 / 3)
            stretch = deformed / place
            return 2 * (3.0 - place) * (stretch**2 - stretch**-4) * place**2 / deformed**3

        return quad(part, 1.0, 2.0, epsabs=1e-13)[0]

    exact = max(pressure(inner) for inner in np.linspace(1.5, 2.6, 441))
    found = []
    for nu in (0.4999, 0.49995):
        mesh = dome(Hemisphere(1.0, 1.0), arc=24, through=6, slides=True)
        solid = SolidModel(mesh, neo_hookean(1.0, nu), grade=lambda r, z: 3.0 - np.hypot(r, z))
        found.append(inflate(solid, past_limit=1.0).limit.pressure)
    assert 2 * found[1] - found[0] == pytest.approx(exact, rel=2e-5)


def test_a_rim_made_rigid_is_a_cap_clamped_higher():
    """Cells below 30 degrees latitude c times as stiff: what is left of their give falls as 1/c."""
    mesh = dome(Hemisphere(9.25, 1.5), arc=24)
    held = np.unique(mesh.cells[Hemisphere(9.25, 1.5).arc_share(*mesh.nodes[mesh.cells].mean(axis=1).T) > 2 / 3])
    cap = inflate(SolidModel(replace(mesh, clamped=held), neo_hookean(0.2)), past_limit=1.0).limit
    off = []
    for contrast in (30.0, 300.0, 3000.0):
        step = SolidModel(
            mesh,
            neo_hookean(0.2),
            grade=lambda r, z, c=contrast: np.where(Hemisphere(9.25, 1.5).arc_share(r, z) > 2 / 3, c, 1.0),
        )
        off.append(inflate(step, past_limit=1.0).limit.pressure / cap.pressure - 1.0)
    assert np.abs(off[2]) < 1e-3
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.2)
    assert off[1] / off[2] == pytest.approx(10.0, rel=0.2)


def test_a_smooth_grade_converges_as_fast_as_an_even_wall():
    def height(arc):
        solid = SolidModel(
            dome(Hemisphere(1.0, 0.5), arc=arc, through=max(arc // 6, 1), slides=True), neo_hookean(1.0), grade=smooth
        )
        return state_at(solid, 0.6).inner_apex

    best = height(48)
    coarse, fine = abs(height(6) - best), abs(height(24) - best)
    assert np.log2(coarse / fine) / 2 > 3.3
    assert fine < 1e-5


@pytest.mark.slow
@pytest.mark.parametrize("fractions", [(0.0, 0.25), (0.25, 0.0), (0.05, 0.27), (0.0, 0.15, 0.05)])
def test_the_default_mesh_is_within_its_stated_error(fractions):
    one, pressures = sensor(*fractions), np.array([0.0, 0.022])
    fine = SolidModel(
        dome(Hemisphere(9.25, 1.5), arc=96, through=4),
        one.wall.hyperelastic,
        grade=lambda r, z: np.interp(Hemisphere(9.25, 1.5).arc_share(r, z), *one.wall.grade),
    )
    run, found = inflate(fine, past_limit=1.0), solid_result(one, pressures, past_limit=1.0)
    assert found.limits.limit_point == pytest.approx(run.limit.pressure, rel=2e-3)
    for pressure, state in zip(pressures, found.states, strict=True):
        end = min(state.range_end, 5.0)
        steps = PressSettings(end, 14)
        coarse = SolidModel(dome(Hemisphere(9.25, 1.5)), one.wall.hyperelastic, grade=fine.grade)
        here = indent(coarse, state_at(coarse, pressure), steps).figures()
        there = indent(fine, state_at(fine, pressure, run), steps).figures()
        assert here.sensitivity == pytest.approx(there.sensitivity, rel=0.01)


# ------------------------------------------------------------------------------- what rises with the modulus


def figures_of(modulus: np.ndarray, pressure: float, travel: float = 2.0) -> dict[str, float]:
    """Limit pressure, first dp/dV, volume at a pressure, force at a travel with the gas shut in."""
    solid = solid_of(modulus)
    run = inflate(solid, past_limit=1.0)
    free = state_at(solid, pressure, run)
    pressed = indent(solid, free, PressSettings(travel, 4)).states[-1]
    return {
        "limit": run.limit.pressure,
        "first slope": run.states[0].stiffness,
        "give": -free.volume,
        "force": pressed.force if pressed.indentation == pytest.approx(travel) else np.nan,
    }


def stiffened(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Moduli of a random grade, and the same with a bump on top somewhere."""
    modulus = moduli(sensor(*rng.uniform(0.0, 0.3, int(rng.integers(2, 5)))))
    bump = rng.uniform(0.1, 1.0) * np.exp(-(((PLACES - rng.uniform()) / rng.uniform(0.1, 0.5)) ** 2))
    return modulus, modulus * (1.0 + bump)


def assert_none_falls(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        soft, stiff = stiffened(rng)
        for pressure in (0.0, 0.022):
            one, other = figures_of(soft, pressure), figures_of(stiff, pressure)
            for name, value in one.items():
                assert not other[name] < value - 1e-7 * abs(value), name


@pytest.mark.slow
def test_a_wall_stiffer_anywhere_gives_less_and_bears_more():
    assert_none_falls(seed=1, count=3)


@pytest.mark.slow
def test_a_wall_stiffer_anywhere_gives_less_and_bears_more_over_many():
    assert_none_falls(seed=2, count=40)


def test_the_first_slope_is_concave_in_the_modulus():
    """The least energy of a sum is no less than the sum of the least energies; both are quadratic at rest."""
    rng = np.random.default_rng(3)
    for _ in range(6):
        one, other = (moduli(sensor(*rng.uniform(0.0, 0.35, 2))) for _ in range(2))
        slopes = [inflate(solid_of(m), to_pressure=1e-4).states[0].stiffness for m in (one, other, 0.5 * (one + other))]
        assert slopes[2] >= 0.5 * (slopes[0] + slopes[1]) * (1 - 1e-9)


def test_a_grade_of_two_knots_bears_a_pressure_between_its_ends():
    for pole, rim in ((0.0, 0.173), (0.173, 0.0), (0.05, 0.27)):
        low, here, high = (
            figures_of(np.full(PLACES.size, one.wall.shear_modulus) if one.wall.grade is None else moduli(one), 0.012)
            for one in (sensor(min(pole, rim)), sensor(pole, rim), sensor(max(pole, rim)))
        )
        for name in here:
            assert low[name] < here[name] < high[name], name


@pytest.mark.slow
def test_the_sensitivity_of_a_grade_need_not_lie_between_its_ends():
    """It is a slope of pressure over force: a stiff pole spreads the contact, a soft rim gives the volume."""
    found = {
        fractions: solid_result(sensor(*fractions), np.array([0.0]), past_limit=1.0).states[0].figures.sensitivity
        for fractions in ((0.0,), (0.173,), (0.0, 0.173), (0.173, 0.0))
    }
    assert found[(0.173,)] < found[(0.0, 0.173)] < found[(0.0,)]
    assert found[(0.173, 0.0)] > 1.02 * found[(0.0,)]


# ------------------------------------------------------------------------------------------------ robustness


def assert_solved(seed: int, count: int) -> None:
    """Random grades to the greatest contrast, thin and thick: an answer, its figures before any loss of equilibrium."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        fractions = rng.uniform(0.0, TOP, int(rng.integers(2, 7)))
        if k % 3 == 0:
            fractions = np.where(rng.random(fractions.size) < 0.5, 0.0, TOP)
        one = sensor(*fractions).replace(wall_thickness=9.25 * rng.uniform(0.06, 0.3), depth=4.0, steps=8)
        result = solid_result(one, np.array([0.0, 4 * KPA]), past_limit=1.0)
        assert result.limits.limit_point > 4 * KPA
        for state in result.states:
            assert np.all(np.diff(state.force[state.indentation <= state.range_end]) > 0)
            lost = [e.indentation for e in state.events if e.kind == "no equilibrium found"]
            assert state.range_end <= min(lost, default=np.inf)


@pytest.mark.slow
def test_random_grades_are_solved():
    assert_solved(seed=11, count=5)


@pytest.mark.slow
def test_many_random_grades_are_solved():
    assert_solved(seed=12, count=200)


# ------------------------------------------------------------------------------------------------ the choice of the model


@pytest.mark.parametrize("model", ["membrane", "atlas"])
def test_models_that_know_no_grade_refuse_it_by_name(model):
    with pytest.raises(
        InputError, match=rf'model = "{model}": the wall is graded along its arc; take `model` auto or solid'
    ):
        predict("test", sensor(0.0, 0.2), [0.0], model=model)


def test_auto_climbs_to_the_solid_and_says_why():
    way = models_for(sensor(0.0, 0.2), 0.05)
    assert way.models == ("solid",)
    assert "atlas: the wall is graded along its arc" in way.passed
