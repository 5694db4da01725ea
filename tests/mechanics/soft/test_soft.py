"""Soft objects: their surface against exact solutions, and a dome under them against limits that are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.soft.body import Nodule, RingCompliance, SoftBody
from pneutouch.mechanics.soft.press import STRAINED, SoftPress, soft_press
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.indent import indent as rigid_press
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.disc import CorrugatedDisc
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import KPA

DOME = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
STATES = {p: state_at(DOME, p, inflate(DOME, to_pressure=p) if p else None) for p in (0.0, 22.0 * KPA)}
SOFT = PressSettings(3.0, steps=6, soft=SoftBody(0.1))


def indent(solid, free, press):
    """Press by the object that the settings have."""
    if press.soft is None:
        return rigid_press(solid, free, press)
    return soft_press(solid, free, press, press.soft, StrainProbe(solid))


def hertz(reach: float, peak: float, count: int = 150):
    """Radii and forces of rings of Hertz's pressure, mm and N."""
    x, w = np.polynomial.legendre.leggauss(count)
    radii = 0.5 * reach * (x + 1.0)
    return radii, 0.5 * reach * w, np.pi * reach * radii * w * peak * np.sqrt(1.0 - (radii / reach) ** 2)


@given(reach=st.floats(0.2, 8.0), modulus=st.floats(0.01, 5.0), poisson=st.floats(0.0, 0.5))
@settings(max_examples=20, deadline=None)
def test_hertz_s_pressure_makes_hertz_s_surface(reach, modulus, poisson):
    radii, widths, forces = hertz(reach, 0.05)
    rings = RingCompliance(SoftBody(modulus, poisson), radii, widths, reach)
    plane = modulus / (1.0 - poisson**2)
    exact = np.pi * 0.05 / (4.0 * plane * reach) * (2.0 * reach**2 - radii**2)
    assert rings.matrix @ forces == pytest.approx(exact, rel=2e-3)
    assert rings.surface(forces, np.array([0.0])) == pytest.approx(np.pi * 0.05 * reach / (2.0 * plane), rel=2e-3)
    inside = radii < 0.9 * reach
    slope = -np.pi * 0.05 / (2 * plane * reach) * radii[inside]
    assert (rings.slopes @ forces)[inside] == pytest.approx(slope, abs=0.015 * np.abs(slope).max())
    assert rings.matrix == pytest.approx(rings.matrix.T)


def test_a_nodule_of_the_same_modulus_is_none_and_a_deep_small_one_takes_what_eshelby_says():
    radii, widths, forces = hertz(1.0, 0.05)
    even = RingCompliance(SoftBody(0.1, 0.5), radii, widths, 40.0)
    none = RingCompliance(SoftBody(0.1, 0.5, nodule=Nodule(20.0, 2.0, 0.1)), radii, widths, 40.0)
    assert none.matrix == pytest.approx(even.matrix)
    # Far below a point force F an incompressible half-space is strained by F/(2 pi mu d^2) along the axis, and by half of
    # it across; a rigid ball's stresslet works 20/3 pi mu b^3 e:e (Batchelor 1970, doi:10.1017/S0022112070000745).
    depth, shear, force = 20.0, 0.1 / 3.0, forces.sum()
    along = 2.0 * force / (4.0 * np.pi * shear * depth**2)
    stiff = RingCompliance(SoftBody(0.1, 0.5, nodule=Nodule(depth, 2.0, 1e6)), radii, widths, 40.0)
    lost = forces @ (even.matrix - stiff.matrix) @ forces
    assert lost == pytest.approx(20.0 / 3.0 * np.pi * shear * 2.0**3 * 1.5 * along**2, rel=0.02)
    # Forces, slopes and second derivatives are those of one work.
    near = Nodule(3.0, 1.5, 5.0)

    def work(at):
        return 0.5 * forces @ RingCompliance(SoftBody(0.1, 0.4, nodule=near), at, widths, 3.0).matrix @ forces

    rings, step = RingCompliance(SoftBody(0.1, 0.4, nodule=near), radii, widths, 3.0), 1e-5
    moved = [radii + sign * step * (np.arange(len(radii)) == 60) for sign in (1.0, -1.0)]
    slope = (work(moved[0]) - work(moved[1])) / (2.0 * step)
    assert slope == pytest.approx(forces[60] * (rings.slopes @ forces)[60], rel=1e-4)
    second = (work(moved[0]) + work(moved[1]) - 2.0 * work(radii)) / step**2
    assert second == pytest.approx(rings.curving(forces)[60, 60], rel=0.02)


def test_far_away_a_force_is_a_point_force():
    radii, widths, forces = hertz(1.0, 0.05)
    far = np.array([6.0])
    plane = 0.5 / (1.0 - 0.49**2)
    assert RingCompliance(SoftBody(0.5), radii, widths, 1.0).surface(forces, far) == pytest.approx(
        forces.sum() / (np.pi * plane * far), rel=0.02
    )


def test_a_deep_layer_is_a_half_space_and_a_thin_one_is_stiffer():
    radii, widths, forces = hertz(2.0, 0.05)
    deep, layer, thin = (
        forces @ RingCompliance(SoftBody(0.2, thickness=h), radii, widths, 2.0).matrix @ forces
        for h in (None, 400.0, 1.0)
    )
    assert layer == pytest.approx(deep, rel=6e-3) and thin < 0.5 * deep


@pytest.mark.parametrize("pressure", STATES)
def test_a_stiff_object_is_a_rigid_one(pressure):
    free = STATES[pressure]
    for body, soft in ((None, SoftBody(1e4)), (ball(12.0), SoftBody(1e4))):
        rigid = indent(DOME, free, replace(SOFT, soft=None, body=body))
        found = indent(DOME, free, replace(SOFT, soft=soft, body=body))
        for name in ("force", "rise", "volume"):
            first, other = found.column(name)[1:], rigid.column(name)[1:]
            # At first few points touch, and those of both are not the same.
            assert first[0] == pytest.approx(other[0], rel=0.02) and first[1:] == pytest.approx(other[1:], rel=6e-3), (
                name
            )
        assert found.column("contact_radius")[1:] == pytest.approx(rigid.column("contact_radius")[1:], abs=0.45)


def test_a_hard_dome_presses_a_soft_half_space_as_hertz_says():
    hard = SolidModel(dome(Hemisphere(5.0, 5.0), arc=96), neo_hookean(500.0))
    free = state_at(hard, 0.0)
    path = SoftPress(hard, free, replace(SOFT, depth=0.5), SoftBody(0.1, 0.3))
    for travel in (0.1, 0.2, 0.4):
        point = path.point(path.to(travel))
        plane = 0.1 / (1.0 - 0.3**2)
        # The mean deflection under Hertz's pressure is 0.8 of that on the axis.
        assert point.force == pytest.approx(4.0 / 3.0 * plane * np.sqrt(10.0) * travel**1.5, rel=0.01)
        assert point.lift == pytest.approx(travel * 0.8, rel=0.02)


@pytest.mark.parametrize("pressure", STATES)
@pytest.mark.parametrize(
    ("body", "rigid"), [(SoftBody(0.05), None), (SoftBody(0.1, thickness=3.0), None), (SoftBody(0.5), ball(8.0))]
)
def test_slopes_are_those_of_the_path_and_no_point_passes_through(pressure, body, rigid):
    path = SoftPress(DOME, STATES[pressure], replace(SOFT, body=rigid), body)
    # Points that come on the way jump the slope, but not the path: means over some of them are compared.
    states = [path.to(travel) for travel in np.linspace(1.4, 1.6, 11)]
    here, travel = states[-1], np.array([one.travel for one in states])
    force = np.array([one.forces.sum() for one in states])
    assert np.mean([one.stiffness for one in states]) == pytest.approx(np.polyfit(travel, force, 1)[0], rel=0.02)
    pressures = np.array([one.state.filling.pressure for one in states])
    rate = np.polyfit(travel, pressures, 1)[0]
    assert np.mean([one.pressure_rate for one in states]) == pytest.approx(rate, rel=0.02)
    r, z = path.scene.points.positions(here.state.x)
    newtons = here.forces.ravel() * DOME.mu * DOME.length**2
    rings = path.scene.rings(r, np.arange(r.size), float(r.max()))
    gap = path.scene.under(here.travel, r)[0].ravel() + rings.matrix @ newtons / DOME.length - z.ravel()
    assert (here.forces >= 0.0).all() and gap.min() > -2e-3
    assert np.abs(gap[newtons > 0.0]).max() < 2e-3


@given(
    modulus=st.floats(0.01, 20.0),
    poisson=st.floats(0.3, 0.5),
    thickness=st.none() | st.floats(1.0, 20.0),
    pressure=st.sampled_from(sorted(STATES)),
)
@settings(max_examples=12, deadline=None)
def test_a_softer_object_takes_less_force_and_its_dome_works_less(modulus, poisson, thickness, pressure):
    free = STATES[pressure]
    soft, stiff = (SoftPress(DOME, free, SOFT, SoftBody(factor * modulus, poisson, thickness)) for factor in (1.0, 1.5))
    for travel in (0.5, 1.5, 2.5):
        less, more = soft.point(soft.to(travel)), stiff.point(stiff.to(travel))
        assert 0.0 < less.force < more.force * (1.0 + 2e-3) and 0.0 < less.rise < more.rise * (1.0 + 2e-3)
        assert less.lift > more.lift * (1.0 - 2e-2)


def test_the_usual_mesh_is_fine_enough():
    finer = SolidModel(dome(Hemisphere(9.25, 1.5), arc=72), neo_hookean(0.17))
    for modulus in (0.02, 0.2):
        paths = [SoftPress(solid, state_at(solid, 0.0), SOFT, SoftBody(modulus)) for solid in (DOME, finer)]
        for travel in (0.5, 1.0, 2.0):
            usual, fine = (path.point(path.to(travel)) for path in paths)
            assert usual.force == pytest.approx(fine.force, rel=0.01)
            assert usual.rise == pytest.approx(fine.rise, rel=0.01)


def test_the_range_ends_where_the_object_is_strained():
    path = indent(DOME, STATES[0.0], PressSettings(6.0, steps=24, soft=SoftBody(0.005)))
    (event,) = [one for one in path.events if one.kind == "strained"]
    assert 2.0 < event.indentation < 6.0 and not path.complete
    # The surface that is drawn follows the wall, which it has let in by 3 mm.
    state, surface = path.states[-1], path.undersides[-1]
    top = state.positions[DOME.mesh.outer_apex, 1]
    assert surface.underside(np.zeros(1))[0][0] == pytest.approx(top, abs=0.06)


def test_a_layer_is_strained_by_its_thickness():
    path = SoftPress(DOME, STATES[0.0], SOFT, SoftBody(0.05, thickness=1.0))
    found = path.to(2.5)
    point = path.point(found)
    assert float(found.radii[found.forces > 0.0].max()) * DOME.length > 2.0
    assert point.strain == pytest.approx(point.lift / STRAINED)
    # The event is where the strain is the greatest that is allowed.
    press = indent(DOME, STATES[0.0], PressSettings(6.0, steps=24, soft=SoftBody(0.005)))
    (event,) = [one for one in press.events if one.kind == "strained"]
    again = SoftPress(DOME, STATES[0.0], SOFT, SoftBody(0.005))
    assert again.point(again.to(event.indentation)).strain == pytest.approx(1.0, abs=0.03)


def test_an_object_that_gives_way_in_the_first_step_is_refused_and_few_steps_are_not():
    with pytest.raises(InputError) as error:
        indent(DOME, STATES[0.0], PressSettings(6.0, steps=1, soft=SoftBody(0.001)))
    assert error.value.key == "contact.object_modulus_MPa"
    few = indent(DOME, STATES[0.0], PressSettings(3.0, steps=2, soft=SoftBody(0.5)))
    assert few.complete and len(few.states) == 3


def test_a_stiff_ball_ends_at_its_flank_and_a_corrugated_disc_is_met_at_every_crest():
    fine = SolidModel(dome(Hemisphere(9.25, 1.5), arc=48), neo_hookean(0.17))
    rigid, soft = (
        indent(fine, state_at(fine, 0.0), PressSettings(6.0, body=ball(2.0), soft=soft))
        for soft in (None, SoftBody(1e3))
    )
    (one,), (other,) = ([e.indentation for e in path.events if e.kind == "object_edge"] for path in (rigid, soft))
    assert other == pytest.approx(one, abs=0.4)
    # The crests of a corrugated disc are as high as its pole: a block meets them all, however far out they are.
    disc = SolidModel(dome(CorrugatedDisc(10.0, 0.5, cavity_depth=3.0, rise=1.0)), neo_hookean(0.17))
    path = SoftPress(disc, state_at(disc, 0.0), PressSettings(0.3), SoftBody(0.1))
    found = path.to(0.05)
    touching = found.radii[found.forces > 0.0] * disc.length
    assert touching.min() < 2.0 and touching.max() > 6.0
