"""Wall forces with memory, against exact linear viscoelasticity."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.press import AtlasPress, batch_of
from pneutouch.mechanics.atlas.table import AtlasPoint, shipped
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.mechanics.viscous.prony import Prony
from pneutouch.mechanics.viscous.runs import follow
from pneutouch.shape.hemisphere import Hemisphere
from tests.mechanics.viscous.closed import after_ramp, loop_energy

A = Prony((0.1450, 0.1534, 0.1084), (0.1139, 2.528, 51.19))
B = Prony((0.45, 0.26, 0.10), (0.047, 0.97, 18.0))
SENSOR = Sensor(
    Dome(Hemisphere(9.25, 1.5)),
    WallMaterial(0.206, 0.49),
    GasCircuit(ambient_pressure=0.101325, dead_volume=0.0, gauge_limit=np.inf),
    IndentationProtocol(plate_radius=15.0, depth=4.625, steps=14),
)


class Springs:
    """Pressure a nu + b x, force b nu + c x with x the travel below height 1: an elastic potential, quadratic."""

    a, b, c = 2.0, 0.7, 3.0

    def folded(self, k, nu, height):
        return np.zeros(nu.size, dtype=bool)

    def point(self, k, nu, height, *, with_folded=True):
        x, one = 1.0 - height, np.ones_like(nu)
        yes = np.ones(nu.size, dtype=bool)
        return AtlasPoint(
            self.a * nu + self.b * x, self.b * nu + self.c * x, self.a * one, -self.b * one, -self.c * one, yes, ~yes
        )


def springs(gas: float) -> SimpleNamespace:
    """One quadratic dome with gas at absolute pressure ``gas`` in a room of 2, at rest; 0 is none."""
    one = np.ones(1)
    press = SimpleNamespace(
        slices=Springs(),
        k=np.zeros(1, dtype=np.intp),
        ambient=gas * one,
        dead=0 * one,
        reach=one,
        free=0 * one,
        apex=one,
        content=2.0 * gas * one,
        volume=lambda nu: 2.0 + nu,
    )
    press.solve, press.rows = partial(AtlasPress.solve, press), lambda _: press
    return press


def run(press, prony, clock, travel):
    size = press.free.size
    shape = (size, clock.size)
    return follow(
        press,
        np.tile(prony.excess, (size, 1)),
        np.tile(prony.times, (size, 1)),
        np.broadcast_to(clock, shape),
        np.broadcast_to(travel, shape),
    )


@given(st.sampled_from([A, B]), st.floats(1e-3, 1e3), st.lists(st.floats(1e-3, 300.0), min_size=1, max_size=5))
def test_a_linear_dome_without_gas_holds_as_the_closed_form(prony, ramp, waits):
    """Without gas the wall's pressure is zero at all times, so that nu = -b x/a and F = (c - b^2/a) x with memory."""
    later = np.sort(waits)
    clock = np.concatenate([np.linspace(0.0, ramp, 4), ramp + later])
    travel = 0.02 * np.minimum(clock / ramp, 1.0)
    path = run(springs(0.0), prony, clock, travel)
    stiffness = Springs.c - Springs.b**2 / Springs.a
    assert path.known.all()
    assert path.force[0, 4:] == pytest.approx(stiffness * 0.02 * after_ramp(prony, ramp, later), rel=1e-9)
    assert np.abs(path.pressure).max() < 1e-12


@pytest.mark.parametrize("prony", [A, B])
@pytest.mark.parametrize("ramp", [0.05, 1.0, 20.0])
def test_the_loop_of_a_linear_dome_takes_the_energy_of_the_closed_form(prony, ramp):
    clock = np.linspace(0.0, 2 * ramp, 801)
    travel = 0.02 * np.minimum(clock, 2 * ramp - clock) / ramp
    path = run(springs(0.0), prony, clock, travel)
    work = np.trapezoid(path.force[0], travel)
    stiffness = Springs.c - Springs.b**2 / Springs.a
    assert work == pytest.approx(stiffness * 0.02**2 * loop_energy(prony, ramp), rel=2e-3)


def test_gas_takes_its_part_of_the_load_and_gives_it_back():
    """A gas twice as stiff as the wall: its work is a function of its volume alone, the wall's is not."""
    clock = np.linspace(0.0, 4.0, 1601)
    travel = 0.02 * np.minimum(clock, 4.0 - clock) / 2.0
    path = run(springs(4.0), A, clock, travel)
    plate, by_gas = np.trapezoid(path.force[0], travel), np.trapezoid(path.pressure[0], path.nu[0])
    assert path.pressure[0] == pytest.approx(8.0 / (2.0 + path.nu[0]) - 4.0, abs=1e-8)
    assert by_gas == pytest.approx(8.0 * np.log((2 + path.nu[0, -1]) / 2.0) - 4.0 * path.nu[0, -1], abs=1e-9)
    # All that the plate has put in is in the wall, but for what the gas still holds, which is of second order here.
    assert plate + by_gas > 0
    assert abs(by_gas) < 0.1 * plate


def dome(**changes) -> AtlasPress:
    batch = batch_of(SENSOR.replace(**changes), [0.0])
    return AtlasPress(batch, shipped().slices(batch.wall_ratio, ()), np.zeros(1, dtype=np.intp))


@pytest.mark.parametrize("prony", [A, B])
def test_a_vented_dome_pressed_at_once_relaxes_exactly_as_the_modulus(prony):
    later = np.geomspace(1e-3, 600.0, 25)
    press = dome(ambient_pressure=0.0)
    path = run(press, prony, np.concatenate([[0.0, 1e-12], later]), np.array([0.0] + [0.3] * 26))
    assert path.known.all()
    assert path.force[0, 2:] == pytest.approx(
        path.force[0, -1] / prony.modulus(later)[-1] * prony.modulus(later), rel=1e-7
    )
    elastic = press.march(np.array([[0.0, 0.15, 0.3]]))
    assert path.elastic_force[0, -1] == pytest.approx(elastic.point.force[0, -1], rel=1e-6)


def test_a_great_dead_volume_is_no_gas_at_all():
    clock, travel = np.array([0.0, 1e-12, 0.01, 1.0, 100.0]), np.array([0.0, 0.3, 0.3, 0.3, 0.3])
    vented, wide = (
        run(press, A, clock, travel).force[0] for press in (dome(ambient_pressure=0.0), dome(dead_volume=1e9))
    )
    assert wide == pytest.approx(vented, rel=1e-4)


def test_what_does_not_relax_is_the_elastic_press():
    press, travel = dome(), np.linspace(0.0, 0.5, 15)
    path = follow(press, np.zeros((1, 1)), np.ones((1, 1)), np.arange(15.0)[None], travel[None])
    track = press.march(travel[None])
    assert path.force == pytest.approx(track.point.force, abs=1e-6)
    assert path.pressure == pytest.approx(track.point.pressure, abs=1e-6)
