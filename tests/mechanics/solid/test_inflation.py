"""Free inflation against exact results and published figures."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from pneutouch.mechanics.atlas.press import longest_outer_edge
from pneutouch.mechanics.atlas.surveyed import stretch_by_zone
from pneutouch.mechanics.laws import mooney_rivlin, neo_hookean, yeoh
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import UnreachableLoadError
from pneutouch.mechanics.solid.stress import StrainProbe, burst
from pneutouch.shape.hemisphere import Hemisphere


def test_every_third_of_both_faces_has_points_away_from_the_clamp():
    """At rest the greatest stretch of each of the six zones is one; a zone without points would have none."""
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17, 0.49))
    probe = StrainProbe(solid)
    assert stretch_by_zone(probe, solid.rest) == pytest.approx(np.ones(6), abs=1e-7)
    # A wall that is wider, more towards its base, is stretched by as much in the zone there.
    x = solid.rest.copy()
    x[:, 0] *= 1.0 + 0.2 * (1.0 - x[:, 1] / x[:, 1].max())
    base, _, top = stretch_by_zone(probe, x)[:3]
    assert base == pytest.approx(1.2, abs=0.03) and top < base - 0.05


@pytest.mark.parametrize("wall_ratio", [0.015, 0.02, 0.1, 0.3])
def test_the_longest_outer_edge_is_that_of_the_default_mesh(wall_ratio):
    mesh = dome(Hemisphere(9.25, 9.25 * wall_ratio))
    ends = mesh.nodes[mesh.outer[:, 1]] - mesh.nodes[mesh.outer[:, 0]]
    longest = np.linalg.norm(ends, axis=1).max() / 9.25
    assert float(longest_outer_edge(np.array(wall_ratio))) == pytest.approx(longest, rel=1e-9)


def sphere_limit(a, b):
    """(p/mu, inner stretch) at the limit point of an incompressible neo-Hookean sphere."""
    f = lambda x: 4 / x + 1 / x**4  # noqa: E731
    p = lambda la: 0.5 * (f((1 + (la**3 - 1) * (a / b) ** 3) ** (1 / 3)) - f(la))  # noqa: E731
    best = minimize_scalar(lambda la: -p(la), bounds=(1.1, 3.0), method="bounded", options={"xatol": 1e-12})
    return -best.fun, best.x


@pytest.mark.slow
@pytest.mark.parametrize(("a", "b"), [(1.0, 2.0), (10.0, 11.0), (9.25, 10.75), (8.5, 10.0)])
def test_thick_sphere_limit_point(a, b):
    # nu 0.4999 and 0.49995 extrapolated to 0.5: the solid is compressible, the exact result is not
    found = []
    for nu in (0.4999, 0.49995):
        solid = SolidModel(dome(Hemisphere(a, b - a), arc=24, through=4, slides=True), neo_hookean(0.17, nu))
        limit = inflate(solid, past_limit=1.0).limit
        found.append((limit.pressure / 0.17, limit.inner_apex / a))
    pressure, stretch = 2 * np.array(found[1]) - np.array(found[0])
    exact, at = sphere_limit(a, b)
    assert pressure == pytest.approx(exact, rel=1e-5)
    assert stretch == pytest.approx(at, rel=1e-4)


def test_convergence_order_on_the_sphere():
    def apex(arc):
        solid = SolidModel(dome(Hemisphere(1.0, 1.0), arc=arc, through=arc // 4, slides=True), neo_hookean(1.0, 0.49))
        return state_at(solid, 0.5).inner_apex

    best = apex(48)
    coarse, fine = abs(apex(4) - best), abs(apex(32) - best)
    assert np.log2(coarse / fine) / 3 > 3.5
    assert fine < 1e-6


def test_thin_wall_tends_to_the_exact_membrane():
    found = []
    for ratio in (0.02, 0.01):
        solid = SolidModel(dome(Hemisphere(1.0, ratio), arc=64, through=1), neo_hookean(1.0, 0.4999))
        limit = inflate(solid, past_limit=1.0).limit
        # to first order in t0 the membrane lies at mid wall: compare at mid radius
        found.append((limit.pressure * 1.0 / ratio, limit.inner_apex))
    pressure, height = 2 * np.array(found[1]) - np.array(found[0])
    assert pressure == pytest.approx(1.575371, rel=1e-3)
    assert height == pytest.approx(1.689993, rel=1e-3)


@pytest.mark.parametrize(("inner", "nu", "kilopascal"), [(9.25, 0.49, 39.61), (8.5, 0.49, 42.85), (8.5, 0.499, 43.66)])
def test_clamped_dome_limit_meets_earlier_calculations(inner, nu, kilopascal):
    # an independent program, 4 x 60 linear quads with mean dilatation
    limit = inflate(SolidModel(dome(Hemisphere(inner, 1.5)), neo_hookean(0.17, nu)), past_limit=1.0).limit
    assert 1e3 * limit.pressure == pytest.approx(kilopascal, rel=1e-3)


def test_no_locking():
    limits = [
        inflate(SolidModel(dome(Hemisphere(8.5, 1.5)), neo_hookean(0.17, nu)), past_limit=1.0).limit.pressure
        for nu in (0.499, 0.4999)
    ]
    assert limits[1] / limits[0] == pytest.approx(1.0, abs=4e-3)


def test_tango_at_22_kilopascal():
    assert state_at(SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17)), 0.022).inner_apex == pytest.approx(
        10.94, abs=0.02
    )


def test_limit_point_is_located():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
    run = inflate(solid)
    assert run.limit.pressure == run.pressure.max()
    scale = run.limit.pressure / run.limit.volume
    assert abs(run.limit.stiffness) < 1e-4 * scale
    assert all(s.stable for s in run.states if s.volume < 0.999 * run.limit.volume)
    assert not any(s.stable for s in run.states if s.volume > 1.001 * run.limit.volume)


def test_energy_is_the_work_of_the_pressure():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
    run = inflate(solid)
    u = np.array([s.unit.local.energy for s in run.states]) * 0.17 * 9.25**3
    v, p, k = run.volume, run.pressure, np.array([s.stiffness for s in run.states])
    work = 0.5 * np.diff(v) * (p[1:] + p[:-1]) - np.diff(v) ** 2 / 12 * np.diff(k)
    assert np.allclose(work, np.diff(u), rtol=1e-3)


@pytest.mark.parametrize(("length", "stress"), [(0.1 / 9.25, 1e-3 / 0.17), (1000 / 9.25, 1e3 / 0.17)])
def test_scale_invariance(length, stress):
    base = inflate(SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))).limit
    other = inflate(SolidModel(dome(Hemisphere(9.25 * length, 1.5 * length)), neo_hookean(0.17 * stress))).limit
    assert other.pressure / stress == pytest.approx(base.pressure, rel=1e-9)
    # where dp/dV vanishes is known to the root of the precision of p
    assert other.inner_apex / length == pytest.approx(base.inner_apex, rel=1e-7)
    at = [
        state_at(SolidModel(dome(Hemisphere(9.25 * s, 1.5 * s)), neo_hookean(0.17 * q)), 0.022 * q)
        for s, q in ((1, 1), (length, stress))
    ]
    assert at[1].inner_apex / length == pytest.approx(at[0].inner_apex, rel=1e-9)


@pytest.mark.parametrize("wall", [1.0, 1.05, 1.5])
def test_the_volume_of_the_limit_point_is_met_to_its_tolerance(wall):
    """Also where the limit lies next to a state of the path: the search crept towards it and gave up."""
    run = inflate(SolidModel(dome(Hemisphere(8.5, wall)), neo_hookean(0.17)), past_limit=1.0)
    before, limit, after = run.states[-3:]
    bend = (before.stiffness - after.stiffness) / (after.volume - before.volume)
    assert abs(limit.stiffness) < 2.0e-7 * bend * limit.volume


def test_driving_pressure_beyond_the_limit_is_refused():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
    with pytest.raises(UnreachableLoadError) as caught:
        state_at(solid, 0.0397)
    assert caught.value.limit == pytest.approx(0.03959, rel=1e-3)
    assert state_at(solid, 0.0395).stable


def test_suction_has_a_limit_too():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
    assert state_at(solid, -0.005).inner_apex < 9.25
    with pytest.raises(UnreachableLoadError):
        state_at(solid, -0.06)


def test_stiffening_laws_have_no_limit():
    run = inflate(SolidModel(dome(Hemisphere(9.25, 1.5)), yeoh(0.085, 0.01, 0.001)), largest=6.0)
    assert run.limit is None and "still rises" in run.why_no_limit
    assert inflate(SolidModel(dome(Hemisphere(9.25, 1.5)), mooney_rivlin(0.08, 0.005))).limit is not None


def test_burst_lies_before_the_limit_for_a_brittle_wall():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
    run = inflate(solid)
    pressure, height = burst(StrainProbe(solid), run, 0.5)
    assert 0.03 < pressure < run.limit.pressure and height < run.limit.outer_apex
    assert burst(StrainProbe(solid), run, 9.0) is None


def test_the_tension_of_a_wall_is_that_of_its_stretch_without_a_change_of_volume():
    """A wall drawn out along its axis is in uniaxial tension all over; one that only swells is in none."""
    solid = SolidModel(dome(Hemisphere(9.25, 1.5), arc=8, through=1), neo_hookean(0.27))
    probe, drawn = StrainProbe(solid), solid.rest * [1.4**-0.5, 1.4]
    assert probe.greatest_tension(drawn) == pytest.approx(1.4, rel=1e-9)
    assert probe.greatest_tension(1.2 * drawn) == pytest.approx(1.4, rel=1e-9)
    assert probe.greatest_tension(1.2 * solid.rest) == pytest.approx(1.0, abs=1e-6)
    assert probe.greatest_stretch(1.2 * drawn) == pytest.approx(1.2 * 1.4, rel=1e-9)
