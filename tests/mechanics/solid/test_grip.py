"""A plate that grips against what needs no law of friction: a bonded block, and points held one by one where they
touched."""

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.arrays import Array
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.continuation import PathFollower, PlateState, plate_state
from pneutouch.mechanics.solid.elements import RADIAL, Gas, Regulator, TermState
from pneutouch.mechanics.solid.friction_path import FrictionFollower
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, boundary, dome, grid_cells, with_middles
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, minimise
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.shape.hemisphere import Hemisphere

COLUMNS, ROWS = 12, 4


def half_disc(height: float, bonded: bool = False) -> SolidModel:
    """Upper half of a disc of radius 1 and modulus 1, on its plane of symmetry z = 1; its top is the outer wall, of
    which all nodes keep their radius where it is bonded."""
    r = with_middles(np.linspace(1.0, 0.0, COLUMNS + 1))
    z = with_middles(np.linspace(1.0, 1.0 + height, ROWS + 1))
    rows = z.size
    nodes = np.stack(np.meshgrid(r, z, indexing="ij"), axis=-1).reshape(-1, 2)
    bottom, top = (np.arange(r.size) * rows + row for row in (0, rows - 1))
    axis, none = np.arange(nodes.shape[0] - rows, nodes.shape[0]), np.zeros(0, np.intp)
    mesh = SolidMesh(
        nodes,
        grid_cells(COLUMNS, ROWS, 9),
        inner=boundary(COLUMNS, rows, 0),
        outer=boundary(COLUMNS, rows, rows - 1),
        clamped=none,
        axis=np.union1d(axis, top) if bonded else axis,
        sliding=bottom,
        length=1.0,
        wall=height,
    )
    return SolidModel(mesh, neo_hookean(1.0, 0.4999))


def squeeze(solid: SolidModel, strain: float, friction: float) -> float:
    """Force on a wide plate that shortens a disc by a share of its height, in three steps."""
    height = solid.wall
    plate, start = Plate(1.0 + height, np.inf, 0.1), solid.rest
    if friction:
        follower: PathFollower = FrictionFollower(solid, Regulator(0.0), plate, start, friction)
    else:
        follower = PathFollower(solid, Regulator(0.0), plate, start)
    for k in (1, 2, 3):
        while follower.left(1.0 + height * (1.0 - strain * k / 3)) > 1e-12:
            follower.step(1.0 + height * (1.0 - strain * k / 3))
    return follower.here.force


@pytest.mark.slow
@pytest.mark.parametrize("strain", [0.01, 0.2])
@pytest.mark.parametrize("height", [0.25, 0.5])
def test_a_disc_that_is_gripped_is_a_disc_that_is_bonded(height, strain, monkeypatch):
    """What is left is the stretch of the springs that hold it: stiffer ones leave a tenth of it."""
    bonded = squeeze(half_disc(height, bonded=True), strain, 0.0)
    assert squeeze(half_disc(height), strain, np.inf) == pytest.approx(bonded, rel=1.5e-3)
    assert squeeze(half_disc(height), strain, 0.0) < 0.9 * bonded
    monkeypatch.setattr("pneutouch.mechanics.solid.friction_path.TANGENTIAL", 1.0)
    assert squeeze(half_disc(height), strain, np.inf) == pytest.approx(bonded, rel=1.5e-4)


def test_a_thin_gripped_disc_is_as_stiff_as_gent_and_lindley_say():
    """E (1 + 2 S^2) with the shape factor S of a disc bonded on both faces, incompressible (Proc. Inst. Mech. Eng. 173,
    111 (1959), DOI 10.1243/PIME_PROC_1959_173_022_02)."""
    half = 0.15
    shape = 1.0 / (4.0 * half)
    force = squeeze(half_disc(half), 1e-3, np.inf)
    assert force / (np.pi * 1e-3) == pytest.approx(3.0 * (1.0 + 2.0 * shape**2), rel=0.07)


def test_a_disc_that_slides_on_both_faces_is_in_uniaxial_compression():
    force, stretch = squeeze(half_disc(0.5), 0.2, 0.0), 0.8
    assert force == pytest.approx(np.pi * (1.0 / stretch**2 - stretch), rel=2e-3)


class Held:
    """Springs that hold points (n_edges, n_points) of the outer wall at given radii, NaN where there is none; an
    `EnergyTerm`."""

    def __init__(self, solid: SolidModel, radius: Array) -> None:
        self._solid, self._radius = solid, radius
        self._stiffness = 0.1 * solid.contact.stiffness
        self.noise = solid.contact.noise

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        contact, here = self._solid.contact, np.isfinite(self._radius)
        off = np.where(here, contact.positions(x)[0] - self._radius, 0.0)
        pull = self._stiffness * contact.weight * off
        force = np.zeros((pull.shape[0], 2 * contact.shape.shape[1]))
        force[:, RADIAL] = pull @ contact.shape
        blocks = contact.blocks([(RADIAL, RADIAL, np.where(here, self._stiffness, 0.0))])
        return TermState(0.5 * float(np.vdot(pull, off)), self._solid.faces.push(force), blocks)


class HoldingFollower(PathFollower):
    """A plate without friction; every point keeps the radius at which an accepted state first had it in contact."""

    held: Array | None = None

    def solve(self, height: float) -> PlateState | NewtonFailure:
        """State at `height`; not kept."""
        here, contact = self.here, self._solid.contact
        r, _ = contact.positions(here.state.x)
        known = np.full_like(r, np.nan) if self.held is None else self.held
        self.held = np.where(here.state.touch.traction > 0.0, np.where(np.isnan(known), r, known), np.nan)
        scene = replace(here.scene, plate=self._plate.at(height), terms=(Held(self._solid, self.held),))
        solved = minimise(scene, self._extrapolate(height))
        return solved if isinstance(solved, NewtonFailure) else plate_state(scene, solved.state, height, 0)


def press(follower: PathFollower, steps: int) -> tuple[Array, Array]:
    """Force (mu R0^2) and pressure (mu) at a tenth, two, three and four tenths of R0, so many steps to each."""
    top, out = follower.here.height, []
    for k in range(1, 4 * steps + 1):
        follower.step(top - 0.1 * k / steps)
        assert follower.here.height == pytest.approx(top - 0.1 * k / steps)
        if k % steps == 0:
            out.append((follower.here.force, follower.here.state.filling.pressure))
    force, pressure = np.array(out).T
    return force, pressure


@pytest.mark.slow
@pytest.mark.parametrize(("mu", "pressure"), [(0.91, 0.0), (0.17, 0.01)])
def test_grip_holds_every_point_where_it_first_touched(mu, pressure):
    solid = SolidModel(dome(Hemisphere(9.25, 1.5), arc=16, through=1), neo_hookean(mu))
    free = state_at(solid, pressure).unit
    gas = Gas.filled(pressure / mu, free.volume, 0.101325 / mu, 0.0)
    plate = Plate(float(free.x[solid.mesh.outer_apex, 1]), np.inf, 0.1)
    force, rise = press(FrictionFollower(solid, gas, plate, free.x, np.inf), 16)
    held_force, held_rise = press(HoldingFollower(solid, gas, plate, free.x), 64)
    assert force == pytest.approx(held_force, rel=5e-3)
    assert rise == pytest.approx(held_rise, rel=5e-3)
    free_force, _ = press(PathFollower(solid, gas, plate, free.x), 4)
    assert abs(free_force / held_force - 1.0).max() > 0.02
