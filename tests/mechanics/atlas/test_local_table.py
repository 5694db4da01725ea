"""Local tables: their error on designs of the neighbourhood, and what is done with files that do not fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics import predict
from pneutouch.mechanics.atlas.local import build, offsets, recipe_of, weights
from pneutouch.mechanics.models import local
from pneutouch.mechanics.models.accuracy import TABULATION
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.shape import shape_of
from pneutouch.units import KPA

RADIUS, GREATEST = 9.25, 0.012
SHALLOW = {"cap": (1.5, 2.4, {"rise": 5.0}), "thimble": (1.5, 5.5, {})}
BOSS = {"disc": (1.2, 1.8, {"boss_radius": 3.0, "boss_height": 2.5})}


def sensor_in(key: str) -> Sensor:
    """A sensor of 9.25 mm in a soft resin, pressed by a plate as large as is wanted."""
    wall, depth, sizes = {**SHALLOW, **BOSS}[key]
    dome = Dome(shape_of(key, RADIUS, wall, sizes))
    protocol = IndentationProtocol(plate_radius=50.0, depth=depth, steps=14)
    return Sensor(dome, WallMaterial(0.3, 0.49), GasCircuit(0.101325, 500.0, 0.5), protocol)


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """An empty cache."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


@pytest.fixture(scope="module")
def coarse() -> local.LocalTable:
    """A table of a cap with few states, not stored."""
    sensor = sensor_in("cap")
    recipe = recipe_of(sensor, GREATEST, local.fingerprint())
    recipe = replace(recipe, starts=4, depths=7, volume_cells=6, depth_cells=5)
    return local.LocalTable(local.table_path(recipe), build(sensor, recipe), np.array([0.01]))


@pytest.fixture
def stored(coarse) -> local.LocalTable:
    """The coarse table in the cache."""
    table = coarse._replace(path=local.table_path(coarse.atlas.local))
    local.store(table)
    return table


def test_the_quadratic_goes_through_every_surveyed_point():
    for count in (1, 2, 4):
        assert weights(offsets(count)) == pytest.approx(np.eye(len(offsets(count))))
    place = np.array([[0.3, -0.7, 0.2]])
    values = (offsets(3) ** 2) @ [1.0, 2.0, 3.0] + offsets(3) @ [1.0, -1.0, 2.0] + np.prod(offsets(3)[:, :2], axis=1)
    expected = place[0] ** 2 @ [1.0, 2.0, 3.0] + place[0] @ [1.0, -1.0, 2.0] + place[0, 0] * place[0, 1]
    assert weights(place) @ values == pytest.approx([expected])


def test_auto_answers_from_a_stored_table_and_by_the_solid_without_one(stored):
    sensor = sensor_in("cap")
    other = sensor.replace(wall_thickness=1.53, shear_modulus=0.27)
    by_table, by_solid = (predict("", other, [0.0, GREATEST], model=model) for model in ("auto", "solid"))
    assert by_table.model == "local" and by_table.error_estimate.sensitivity_tabulation_relative == TABULATION
    for one, two in zip(by_table.states, by_solid.states, strict=True):
        assert one.figures.sensitivity == pytest.approx(two.figures.sensitivity, rel=0.02)
        assert one.apex_outer == pytest.approx(two.apex_outer, rel=5e-3)
        assert one.cavity_volume == pytest.approx(two.cavity_volume, rel=5e-3)
    assert by_table.limits.limit_point == pytest.approx(by_solid.limits.limit_point, rel=2e-3)
    for far in (other.replace(wall_thickness=1.8), other.replace(rise=4.0), other.replace(depth=1.0)):
        assert local.MODEL.covers(far) is not None
        assert predict("", far, [0.0], model="auto").model == "solid"
    assert predict("", other, [3 * GREATEST], model="auto").model == "solid"
    stored.path.unlink()
    assert predict("", other, [0.0], model="auto").model == "solid"


def test_a_damaged_file_is_not_used_and_is_named(stored):
    stored.path.write_bytes(stored.path.read_bytes()[:-1000])
    table, damaged = local.find(sensor_in("cap"))
    assert table is None and damaged == [stored.path]
    assert str(stored.path) in str(local.MODEL.covers(sensor_in("cap")))
    local.store(stored)
    assert local.MODEL.covers(sensor_in("cap")) is None


def test_a_file_of_another_recipe_or_solid_is_not_used(stored):
    path, sensor = stored.path, sensor_in("cap")
    renamed = path.with_name("cap-0123456789abcdef.npz")
    path.rename(renamed)
    assert local.find(sensor) == (None, [])
    renamed.write_bytes(b"some other program's")
    assert local.find(sensor) == (None, [renamed])
    old = replace(stored.atlas.local, fingerprint="0123")
    atlas = type(stored.atlas)(stored.atlas.tables, old, stored.atlas.sizes)
    local.store(stored._replace(path=local.table_path(old), atlas=atlas))
    assert local.table_path(old).exists() and local.find(sensor)[0] is None


def test_no_table_is_made_for_what_tables_do_not_cover():
    with pytest.raises(InputError):
        local.make(sensor_in("cap").replace(friction=0.3), GREATEST)


@pytest.mark.slow
@pytest.mark.parametrize("key", [*SHALLOW, *BOSS])
def test_the_stated_error_holds_on_random_neighbours(key):
    sensor = sensor_in(key)
    table = local.make(sensor, GREATEST)
    assert table.error <= TABULATION and local.find(sensor)[0] is not None
    rng, names = np.random.default_rng(7), table.atlas.local.names
    errors = []
    for _ in range(30):
        sizes = (
            np.array(table.atlas.local.centre)
            * RADIUS
            * np.exp(rng.uniform(-1.0, 1.0, len(names)) * table.atlas.local.step)
        )
        own = dict(zip(names, sizes.tolist(), strict=True))
        other = sensor.replace(**own, shear_modulus=0.3 * np.exp(rng.uniform(-0.3, 0.3)))
        pressure = np.array([rng.choice([0.0, 0.006, GREATEST])])
        found = local.MODEL.answer_one(other, pressure)
        if found.limitation is not None:
            # There `auto` asks the solid.
            continue
        (state,) = solid_states(other, pressure)
        errors.append(found.result.states[0].figures.sensitivity / state.figures.sensitivity - 1.0)
    assert len(errors) >= 25 and np.abs(errors).max() < 0.01


@pytest.mark.slow
def test_intervals_from_a_table_are_those_of_the_solid():
    changes = {"membrane.shape": "cap", "indentation.depth_mm": 2.4, "pneumatics.driving_pressures_kPa": [0, 12]}
    solved = evaluate("paper-dome", changes, model="solid")
    local.make(solved.sensor, 12 * KPA)
    tabled = evaluate("paper-dome", changes, model="auto")
    assert tabled.prediction.model == "local"
    for one, two in zip(tabled.uncertainty, solved.uncertainty, strict=True):
        for name in (SENSITIVITY_KEY, "limit_pressure_kPa", "force_at_range_end_N"):
            assert one.known[name].low == pytest.approx(two.known[name].low, rel=0.01)
            assert one.known[name].high == pytest.approx(two.known[name].high, rel=0.01)
