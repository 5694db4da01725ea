"""The rigid base under the dome: its potential, its symmetry with the plate, and the convergence that it brings."""

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.elements import Liquid, Regulator
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonResult, SolidScene, evaluate, minimise
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.second_variation import HarmonicSolid
from pneutouch.shape.hemisphere import Hemisphere
from tests.mechanics.solid.derivatives import assert_derivatives

DEPTH = 0.75 * 9.25
GRID = np.linspace(0.0, DEPTH, 15)


FLAT = RigidBase()


def paper(arc=None, through=None, base=FLAT):
    return SolidModel(dome(Hemisphere(9.25, 1.5), arc, through), neo_hookean(0.17), base=base)


def press(solid, pressure=0.0, depth=DEPTH, **options):
    return indent(solid, state_at(solid, pressure), PressSettings(depth, **options))


def _sunk(base, arc=12):
    """A solid whose mesh begins below the plane z = 0, so that both faces of it are in the base."""
    mesh = dome(Hemisphere(9.25, 1.5), arc, 1)
    return SolidModel(replace(mesh, nodes=mesh.nodes - [0.0, 2.5]), neo_hookean(0.17), base=base)


BASES = [RigidBase(), RigidBase(opening=9.1, flange=10.65), RigidBase(ring=10.2, ring_height=0.4)]


@pytest.mark.parametrize("base", BASES)
def test_gradient_and_tangent_are_derivatives_of_the_energy(base):
    solid = _sunk(base)
    rng = np.random.default_rng(3)
    scene = SolidScene(solid, Liquid(2.0, 3.0), None)
    x = solid.rest + solid.expand(2e-3 * rng.normal(size=solid.size))
    (support,) = assert_derivatives(scene, x, rng, step=1e-8, rel=1e-6).terms
    assert support.blocks.any() and support.inner_blocks.any() and support.energy > 0.0


def test_the_second_variation_around_the_axis_counts_the_base():
    """With no waves it is the axisymmetric tangent; a point moved around the axis by c moves outwards by c^2 / 2 r."""
    solid = _sunk(RigidBase(opening=9.1, flange=10.65))
    state = evaluate(SolidScene(solid, Liquid(2.0, 3.0), None), solid.rest)
    harmonic = HarmonicSolid(solid)
    _, inner, outer = harmonic.blocks(state)
    plain, (support,) = harmonic.blocks(replace(state, x=solid.rest + np.array([0.0, 1.0]))), state.terms
    for family, without, blocks in ((inner, plain[1], support.inner_blocks), (outer, plain[2], support.blocks)):
        edges, n = blocks.shape[0], blocks.shape[1] // 2
        more = (family.constant - without.constant).reshape(edges, n, 3, n, 3)
        plane = more[:, :, :2, :, :2].reshape(edges, 2 * n, 2 * n)
        assert np.abs(plane - blocks).max() < 1e-12 * np.abs(blocks).max()
        assert np.abs(more[:, :, 2, :, 2]).max() > 0.0
    size, total = 1e-4, 0.0
    moved = solid.rest.copy()
    moved[:, 0] = np.hypot(moved[:, 0], size)
    for family, without in ((inner, plain[1]), (outer, plain[2])):
        total += float((family.constant - without.constant)[:, 2::3, 2::3].sum())
    rise = 2.0 * (solid.base.at(moved).energy - solid.base.at(solid.rest).energy) / size**2
    assert total == pytest.approx(rise, rel=1e-3)


def test_the_opening_and_the_flange_leave_the_wall_free():
    deep = _sunk(RigidBase())
    assert deep.base.at(deep.rest).energy > 0.0
    free = _sunk(RigidBase(opening=20.0, flange=22.0)).base.at(deep.rest)
    assert free.energy == 0.0 and free.blocks is None and free.inner_blocks is None and not free.gradient.any()


def test_a_wall_pressed_on_its_base_equals_the_same_wall_pressed_by_a_plate():
    """Turned over, the plate is the base: the dome above it has the mirrored shape, energy and force."""
    mesh, height = dome(Hemisphere(1.0, 0.162), 16, 2), 1.16
    upright = SolidModel(mesh, neo_hookean(1.0))
    above, below = upright.rest, np.array([0.0, height]) + upright.rest * [1.0, -1.0]
    while height > 0.8:
        height -= 0.04
        turned = replace(mesh, nodes=np.stack([mesh.nodes[:, 0], height - mesh.nodes[:, 1]], axis=1))
        over = SolidModel(turned, neo_hookean(1.0), base=RigidBase())
        pressed = minimise(SolidScene(upright, Regulator(0.0), Plate(height, np.inf, 1.0)), above)
        rested = minimise(SolidScene(over, Regulator(0.0), None), below - [0.0, 0.04])
        assert isinstance(pressed, NewtonResult) and isinstance(rested, NewtonResult)
        above, below = pressed.state.x, rested.state.x
    assert np.abs([0.0, height] + above * [1.0, -1.0] - below).max() < 1e-9
    assert rested.state.energy == pytest.approx(pressed.state.energy, rel=1e-10)
    force = float(np.vdot(upright.contact.weight, pressed.state.touch.traction))
    assert over.base.load(below).force == pytest.approx(force, rel=1e-7) and force > 0.05


def test_the_wall_lies_down_and_is_not_let_through():
    run = press(paper())
    assert run.complete and [e.kind for e in run.events if e.kind in ("base", "overhang", "clamp_fold")] == ["base"]
    assert run.column("penetration").max() < 1e-3 * 1.5
    assert run.column("overhang").max() < 1e-3 * 1.5
    start = next(e.indentation for e in run.events if e.kind == "base")
    depth, load = run.column("indentation"), run.column("base_force")
    assert (load[depth < start - DEPTH / 14] == 0.0).all() and load[-1] > 0.05 * run.states[-1].force
    # the base carries what the plate puts on beyond what the clamp can: the force on the plate grows with it
    assert run.states[-1].force > 1.02 * press(paper(base=None)).states[-1].force


def test_a_ring_holds_the_wall_that_bulges_out():
    """A thin wall in a ring that opens at 45 degrees from 11 mm to a height of 2.5 mm."""
    found = {}
    for base in (RigidBase(), RigidBase(ring=11.0, ring_height=2.5)):
        solid = SolidModel(dome(Hemisphere(9.25, 0.6)), neo_hookean(0.17), base=base)
        run = press(solid, 0.0)
        r, z = solid.contact.outline(run.states[-1].positions)
        found[base.ring] = (np.where(z < 2.0, r - 11.0 - z, -np.inf).max(), run)
    free, held = found[0.0], found[11.0]
    # Between the points where the contact is counted, the wall bends through the cone by a hundredth of itself at most.
    assert free[0] > 0.9 and held[0] < 1e-2 * 0.6
    assert held[1].complete and held[1].column("penetration").max() < 1e-3 * 0.6
    early = held[1].column("indentation") < 2.0
    assert np.array_equal(held[1].column("force")[early], free[1].column("force")[early])
    assert held[1].states[-1].base_force > 1.2 * free[1].states[-1].base_force


def test_before_the_wall_lies_down_the_base_changes_nothing():
    with_base, without = press(paper(), 0.022, 5.0), press(paper(base=None), 0.022, 5.0)
    assert with_base.column("base_force").max() == 0.0
    assert np.array_equal(with_base.column("force"), without.column("force"))


@pytest.mark.parametrize("opening", [0.0, 0.3])
def test_the_inner_wall_rests_on_the_base_inside(opening):
    """A dome that is emptied caves in until its middle lies on the base; over an opening it sinks in there."""

    def emptied(base):
        solid = SolidModel(dome(Hemisphere(1.0, 0.1), 16, 1), neo_hookean(1.0), base=base)
        x = solid.rest
        for share in np.arange(0.98, 0.37, -0.04):
            found = minimise(SolidScene(solid, Liquid(share * solid.cavity.volume(solid.rest), 30.0), None), x, 100)
            assert isinstance(found, NewtonResult)
            x = found.state.x
        return x[solid.mesh.inner], -found.state.filling.pressure

    (through, suction), (held, more) = emptied(None), emptied(RigidBase(opening=opening))
    assert through[..., 1].min() < -0.08 and more > 1.5 * suction
    beyond = held[held[..., 0] >= opening]
    assert beyond[:, 1].min() > -1e-3 * 0.1
    assert (held[..., 1].min() < -0.02) == (opening > 0.0)


def test_a_base_of_no_size_is_refused():
    for wrong in ({"opening": -1.0}, {"flange": np.nan}, {"ring_height": np.inf}):
        with pytest.raises(ValueError, match="must be finite"):
            RigidBase(**wrong)


def _crosses_itself(line):
    """Whether a polyline (n, 2) has two segments that cross, neighbours left out."""
    start, step = line[:-1], np.diff(line, axis=0)
    apart = start[None, :] - start[:, None]
    across = step[:, None, 0] * step[None, :, 1] - step[:, None, 1] * step[None, :, 0]
    safe = np.where(across == 0.0, np.inf, across)
    one = (apart[..., 0] * step[None, :, 1] - apart[..., 1] * step[None, :, 0]) / safe
    other = (apart[..., 0] * step[:, None, 1] - apart[..., 1] * step[:, None, 0]) / safe
    i, k = np.indices(across.shape)
    inside = (one > 0.0) & (one < 1.0) & (other > 0.0) & (other < 1.0) & (across != 0.0)
    return bool((inside & (np.abs(i - k) > 2)).any())


def test_a_line_that_crosses_itself_is_found():
    turn = np.linspace(0.0, 1.9 * np.pi, 40)
    assert not _crosses_itself(np.stack([np.cos(turn), np.sin(turn)], axis=1))
    assert _crosses_itself(np.stack([np.sin(turn), np.sin(2.0 * turn)], axis=1))


@pytest.mark.slow
@pytest.mark.parametrize("pressure", [0.0, 0.022])
def test_sensitivity_converges_over_the_whole_depth(pressure):
    """S from contact to 0.75 R0: the default mesh within 0.3 % of one of 64 x 4 cells, which meets no fold and on
    which the wall nowhere meets itself."""
    found = []
    for arc, through in ((None, None), (48, 3), (64, 4)):
        solid = paper(arc, through)
        run = press(solid, pressure)
        assert run.complete and not {e.kind for e in run.events} & {"clamp_fold", "snap", "lost", "overhang"}
        found.append(run.figures().sensitivity)
        for state in run.path:
            r, z = solid.contact.outline(state.positions)
            assert not _crosses_itself(np.stack([r, z], axis=1))
    assert found[0] == pytest.approx(found[2], rel=0.003) and found[1] == pytest.approx(found[2], rel=0.001)
