"""A bar across the middle of the dome: harmonics of even order alone, at the angles of a quarter of the circle."""

from functools import cache, cached_property

import numpy as np
import pytest

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic import model
from pneutouch.mechanics.harmonic.fields import Harmonics
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress
from pneutouch.mechanics.harmonic.surface import LyingObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.harmonic import EVEN_ORDERS, ORDERS, off_axis_press
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.indenter import ball, edge
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

RADIUS, EVEN = 9.25, Harmonics(4, 2)


class _MirroredAngles(Harmonics):
    """All harmonics at the angles of `EVEN` and their mirror images, so that both sum over the same points."""

    @cached_property
    def angles(self) -> Array:
        return np.concatenate([EVEN.angles, np.pi - EVEN.angles[::-1]])

    @cached_property
    def contact_angles(self) -> Array:
        return np.concatenate([EVEN.contact_angles, np.pi - EVEN.contact_angles[::-1]])


@cache
def _dome() -> tuple[SolidModel, FreeState]:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27), base=RigidBase())
    return solid, state_at(solid, 0.005)


def _pressed(radius: float, order: int, symmetric: bool, friction: float = 0.0) -> OffAxisPath:
    solid, free = _dome()
    body, probe = edge(radius), StrainProbe(solid)
    surface = LyingObject(first_touch(solid, free, body, 30.0).body)
    settings = PressSettings(depth=2.0, steps=3, body=body, friction=friction)
    return OffAxisPress(solid, free, settings, surface, probe, symmetric=symmetric).run(order)


@pytest.mark.parametrize("friction", [0.0, pytest.param(0.3, marks=pytest.mark.slow)])
def test_even_harmonics_alone_are_the_full_sums(monkeypatch: pytest.MonkeyPatch, friction: float) -> None:
    even = _pressed(3.0, 4, True, friction)
    monkeypatch.setattr(model, "Harmonics", lambda order, stride: _MirroredAngles(order, stride))
    full = _pressed(3.0, 5, False, friction)
    odd = [column for m in (1, 3, 5) for column in range(3 * m - 1, 3 * m + 2)]
    assert np.abs(full.states[-1].positions[:, odd]).max() < 1e-8 * RADIUS
    accuracy = 1e-9 if friction == 0.0 else 1e-6
    for name in ("force", "rise", "volume", "stiffness", "contact_radius", "contact_pressure", "object_distance"):
        scale = float(np.abs(full.column(name)).max())
        np.testing.assert_allclose(even.column(name), full.column(name), rtol=0, atol=accuracy * scale, err_msg=name)
    kept = [0, 1, *(column for m in (2, 4) for column in range(3 * m - 1, 3 * m + 2))]
    ours, theirs = even.states[-1].positions, full.states[-1].positions[:, kept]
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=10 * accuracy * RADIUS)
    assert not even.column("sideways").any()
    assert not even.column("moment").any()


def test_the_derivative_around_the_axis_is_that_of_the_position() -> None:
    harmonics, angles, h = Harmonics(6, 2), np.linspace(0.1, 1.5, 7), 1e-6
    slope = (harmonics.cartesian(angles + h) - harmonics.cartesian(angles - h)) / (2 * h)
    turned = harmonics.turned(angles)
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    np.testing.assert_allclose(slope[:, 0], cos * turned[:, 0] - sin * turned[:, 2], atol=1e-8)
    np.testing.assert_allclose(slope[:, 1], sin * turned[:, 0] + cos * turned[:, 2], atol=1e-8)


def test_a_bar_across_the_middle_takes_them_and_no_other_scene() -> None:
    from pneutouch.catalogue import Library
    from pneutouch.spec.material import Material

    solid, free = _dome()
    sensor = material_sensor(Library.default().all("materials", Material)["TangoPlus"]).replace(depth=1.0)
    across = {"body": edge(3.0)}
    for test, stride in ((across, 2), ({**across, "offset": 0.5}, 1), ({"body": ball(8.0), "offset": 0.5}, 1)):
        press = off_axis_press(sensor.replace(**test), StrainProbe(solid), free)
        assert press.run(4).states[-1].positions.shape[1] == Harmonics(4, stride).columns
    assert EVEN_ORDERS[: len(ORDERS)] == ORDERS and all(order % 2 == 0 for order in EVEN_ORDERS)
