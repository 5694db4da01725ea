"""Contact with pads: the table of a cell against presses, sums over cells against mechanics, readings against truth."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from benchmarks import pad_coupling
from benchmarks.store import stored

from pneutouch.evaluation import evaluate
from pneutouch.export.reader.pad_reading import PadForceReader
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.solid.indenter import ball, cylinder
from pneutouch.mechanics.touch import cell as cells
from pneutouch.mechanics.touch.cell import TABLE_ERROR, cell_table, greatest_lean, outer_sphere
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.mechanics.touch.objects import KINDS, answer_of, random_objects
from pneutouch.mechanics.touch.reader_table import STRAIGHT, reader_table
from pneutouch.mechanics.touch.resolution import resolution
from pneutouch.shape import shape_of
from pneutouch.spec.pad import PadTable
from pneutouch.units import KPA
from pneutouch.workflows.pad.fault import find_fault, pad_reader
from tests.pads import coarse_table

PRESSURE = 12.0 * KPA
NOISE = 0.002 * KPA
CELL = {
    "membrane.inner_radius_mm": 2.8,
    "membrane.wall_thickness_mm": 0.8,
    "connector.seat": "glued-flange-narrow",
    "connector.port": "barb-3x2",
    "connector.mount": "plain",
    "pneumatics.dead_volume_mL": 0.5,
}


@pytest.fixture(scope="module")
def sensor():
    return evaluate("paper-dome", CELL).sensor


@pytest.fixture(scope="module")
def coarse(sensor, tmp_path_factory):
    return coarse_table(sensor, PRESSURE, tmp_path_factory)


@pytest.fixture(scope="module")
def pad(coarse):
    places = np.array(PadTable(cell="c", layout="ring:7", pitch_mm=9.0).places)
    return PadModel.alike(places, coarse, np.ones(7))


@pytest.fixture(scope="module")
def mixed(pad, coarse):
    """Of three cells another, larger and with a stiffer wall."""
    return PadModel(pad.places, (coarse, coarse.scaled(1.15, 1.4)), np.array([0, 1, 0, 0, 1, 1, 0]), pad.gain)


@pytest.mark.parametrize("kind", KINDS)
def test_every_cell_answers_by_its_own_table_at_the_height_of_the_object(pad, mixed, kind):
    objects = random_objects(mixed, kind, 200, np.random.default_rng(8))
    both, lower = answer_of(mixed, kind, objects), objects.copy()
    lower[:, -1] -= mixed.top - pad.top
    own = answer_of(pad, kind, lower)
    assert np.allclose(both.rise[:, mixed.table_of == 0], own.rise[:, mixed.table_of == 0])
    larger = PadModel.alike(pad.places, mixed.tables[1], pad.gain)
    radius = mixed.table.radius / objects[:, 2] if kind != "plate" else None
    under = {"ball": larger.under_balls, "plate": larger.under_plates, "cylinder": larger.under_cylinders}[kind]
    other = under(objects[:, :2], *([] if radius is None else [radius]), objects[:, -1])
    assert np.allclose(both.rise[:, mixed.table_of == 1], other.rise[:, mixed.table_of == 1])
    assert both.force == pytest.approx(both.forces.sum(axis=1))
    assert (both.rise[:, mixed.table_of == 0].max() > 0.0) and (both.rise[:, mixed.table_of == 1].max() > 0.0)


def test_objects_reach_a_cell_that_is_much_lower(pad, coarse):
    low = PadModel(pad.places, (coarse, coarse.scaled(0.4)), np.array([0, 1, 0, 0, 0, 0, 0]), pad.gain)
    objects = random_objects(low, "plate", 400, np.random.default_rng(2))
    assert (answer_of(low, "plate", objects).forces[:, 1] > 0.0).mean() > 0.02
    assert low.deepest > low.top - low.tables[1].apex + 1.5 * low.tables[1].depth


def test_the_curvature_at_its_bound_is_told_where_a_group_has_larger_domes(pad, coarse):
    large = PadModel(pad.places, (coarse, coarse.scaled(2.2)), np.array([0, 0, 0, 1, 0, 0, 0]), pad.gain)
    reader = PadForceReader(reader_table(large, NOISE / KPA))
    at = [0.3, 0.2, reader.table["bends"][1], large.top - coarse.apex + 0.8]
    normal, *_ = reader._normal(0, at, reader.answer(0, at), [0.1] * 7, 0.01)
    assert normal[2][2] > 0.0


@pytest.mark.parametrize(("kind", "error"), [("ball", 0.08), ("plate", 0.01), ("cylinder", 0.06)])
def test_force_and_place_are_within_their_intervals_where_cells_differ(mixed, kind, error):
    answer, rise = readings(mixed, kind, 60, 3)
    told = read(reader_table(mixed, NOISE / KPA), rise)[1]
    assert (np.abs(told[0] - answer.force) <= 2.0 * told[1] + 1e-3).mean() > 0.85
    assert np.nanmedian(np.abs(told[0] / answer.force - 1.0)) < error


@pytest.mark.parametrize("size", [1.0, 3.0, 15.0])
def test_a_ball_in_the_middle_is_the_solids(coarse, sensor, size):
    radius = size * coarse.radius
    (state,) = solid_states(sensor.replace(waves=0, body=ball(radius), steps=10), np.array([PRESSURE]))
    travel = np.linspace(0.3, 0.9, 5) * min(coarse.depth, state.range_end)
    one = np.full(5, radius)
    answer = coarse.under_round("balls", one, np.zeros(5), coarse.apex - travel)
    assert np.allclose(answer.force, np.interp(travel, state.indentation, state.force), rtol=0.04)
    assert np.allclose(answer.rise, np.interp(travel, state.indentation, state.pressure_rise), rtol=0.04)
    assert not answer.sideways.any()


def test_a_level_plate_is_as_many_times_one_cell(pad, coarse):
    depth = np.array([0.4, 1.0, 1.5])
    answer = pad.under_plates(np.zeros((3, 2)), depth)
    one = coarse.under_plate(np.zeros(3), coarse.apex - depth)
    assert np.allclose(answer.force, 7 * one.force) and np.allclose(answer.centre, 0.0, atol=1e-9)
    assert np.allclose(answer.rise, one.rise[:, None])


def test_a_leaning_plate_presses_on_its_lower_side(pad):
    answer = pad.under_plates(np.array([[0.06, 0.0], [0.0, -0.06]]), np.array([1.0, 1.0]))
    assert answer.centre[0, 0] < -1.0 and abs(answer.centre[0, 1]) < 1e-6
    assert answer.centre[1, 1] > 1.0 and abs(answer.centre[1, 0]) < 1e-6


def test_the_force_under_a_ball_without_friction_goes_through_its_middle(pad, coarse):
    """Of one touched cell the line of the force runs from the centre of the force to the ball's middle."""
    place, radius, depth = np.array([[1.2, 0.0]]), np.array([6.0]), np.array([1.4])
    answer = pad.under_balls(place, radius, depth)
    assert (answer.forces[0] > 0).sum() == 1
    one = coarse.under_round("balls", radius, place[:, 0], coarse.apex - depth)
    slope = float(one.sideways[0] / one.force[0])
    assert slope > 0.0
    assert answer.centre[0, 0] + slope * (radius[0] - depth[0]) == pytest.approx(1.2, abs=0.15)


@pytest.mark.parametrize("size", [3.0, 30.0])
def test_the_sphere_of_an_outer_face_is_its_own_or_one_that_touches_alike(size):
    assert outer_sphere(shape_of("hemisphere", 3.0, 0.8, {}), size, 1.2) == pytest.approx(3.8, rel=1e-4)
    cap = shape_of("cap", 3.0, 0.8, {"rise": 1.8})
    assert outer_sphere(cap, size, 0.6) == pytest.approx(0.5 * (3.0**2 + 1.8**2) / 1.8 + 0.8, rel=1e-4)
    high, low = (outer_sphere(shape_of("ellipsoid", 3.0, 0.8, {"rise": rise}), size, 0.6) for rise in (4.0, 2.0))
    assert high < 3.8 < low


def test_a_cylinder_along_a_row_presses_its_cells_alike_and_across_it_as_a_plate_where_it_is_wide(pad, coarse):
    """Cell 1 is in the middle of the ring; cells 2 and 5 lie with it on the x axis."""
    turn = np.array([[0.5 * np.pi, 0.0], [0.5 * np.pi + np.pi, 0.0], [np.pi / 6.0, 0.0]])
    answer = pad.under_cylinders(turn, np.full(3, 6.0), np.full(3, 1.2))
    on_line = np.abs(pad.places[:, 1]) < 1e-6
    assert np.allclose(answer.rise[0, on_line], answer.rise[0, 0]) and not answer.rise[0, ~on_line].any()
    assert np.allclose(answer.rise[1], answer.rise[0]) and answer.force[0] == pytest.approx(3.0 * answer.forces[0, 0])
    # Turned by 120 degrees it lies on another row of the hexagon.
    assert (
        answer.rise[2] == pytest.approx(answer.rise[2, 0] * (answer.rise[2] > 0.0)) and (answer.rise[2] > 0).sum() == 3
    )
    one, depth = np.ones(1), np.array([1.0])
    sizes = [coarse.under_round("balls", 3.0 * coarse.radius * one, 0.0 * one, coarse.apex - depth).force[0]]
    sizes += [
        coarse.under_round("cylinders", s * coarse.radius * one, 0.0 * one, coarse.apex - depth).force[0]
        for s in (3, 20)
    ]
    sizes.append(coarse.under_plate(0.0 * one, coarse.apex - depth).force[0])
    assert sizes == sorted(sizes) and sizes[2] == pytest.approx(sizes[3], rel=0.1)


def test_the_force_under_a_cylinder_beside_a_cell_is_across_its_axis(coarse):
    pad = PadModel.alike(np.zeros((1, 2)), coarse, np.ones(1))
    axis, size = np.array([[0.0, 1.5], [np.pi, 1.5]]), np.array([6.0, 6.0])
    right, left = pad.under_cylinders(axis, size, np.array([1.3, 1.3])).centre
    assert 0.0 < right[0] < 1.5 and left[0] == pytest.approx(-right[0]) and abs(right[1]) < 1e-6


def test_what_is_mirrored_reads_mirrored(pad):
    places = np.array([[3.1, 2.2], [3.1, -2.2]])
    above, below = pad.under_balls(places, np.array([8.0, 8.0]), np.array([1.6, 1.6])).rise
    mirror = [int(np.hypot(*(pad.places - (x, -y)).T).argmin()) for x, y in pad.places]
    assert np.allclose(above, below[mirror], atol=1e-12)


def test_gas_behind_a_cell_scales_its_reading(pad, coarse):
    other = PadModel.alike(pad.places, coarse, np.linspace(0.8, 1.2, 7))
    plate = np.zeros((1, 2)), np.array([1.0])
    assert np.allclose(other.under_plates(*plate).rise, np.linspace(0.8, 1.2, 7) * pad.under_plates(*plate).rise)


def readings(pad, kind, count, seed):
    """Random contacts that read at least 20 times the noise: their answers, and the readings with noise."""
    random = np.random.default_rng(seed)
    answer = answer_of(pad, kind, random_objects(pad, kind, 3 * count, random))
    loud = np.flatnonzero(answer.rise.max(axis=1) > 20.0 * NOISE)[:count]
    answer = answer._replace(**{name: getattr(answer, name)[loud] for name in answer._fields})
    return answer, answer.rise + NOISE * random.standard_normal(answer.rise.shape)


@pytest.fixture(scope="module")
def table(pad):
    return reader_table(pad, NOISE / KPA, 1e-4)


def read(table, rise, left_out=()):
    """Contacts of many rises, MPa: kinds, and forces, uncertainties, places and their covariances as one array."""
    reader = pad_reader(table, left_out)
    kinds, *told = zip(*[reader.read(row) for row in (rise / KPA).tolist()], strict=True)
    return np.array(kinds), np.array(told)


def covered(told, answer):
    """Share of forces and of centres within their 95 % intervals."""
    force, of_force, x, y, xx, xy, yy, *_ = told
    known = np.isfinite(force)
    within = np.abs(force - answer.force)[known] <= 1.96 * of_force[known]
    away = (np.stack([x, y], axis=-1) - answer.centre)[known]
    spread = np.stack([xx, xy, xy, yy], axis=-1)[known].reshape(-1, 2, 2) + 1e-12 * np.eye(2)
    square = np.einsum("mi,mij,mj->m", away, np.linalg.inv(spread), away)
    return within.mean(), (square <= 5.99).mean()


@pytest.mark.parametrize(("kind", "error"), [("ball", 0.06), ("plate", 0.01), ("cylinder", 0.03)])
def test_force_and_place_are_within_their_intervals(pad, table, kind, error):
    answer, rise = readings(pad, kind, 64, 3)
    kinds, told = read(table, rise)
    assert np.isin(kinds, [kind, "either"]).mean() > (0.8 if kind == "cylinder" else 0.95)
    assert min(covered(told, answer)) >= (0.8 if kind == "cylinder" else 0.85)
    assert np.nanmedian(np.abs(told[0] / answer.force - 1.0)) < error


@pytest.mark.parametrize(("kind", "columns"), [("plate", (9, 10)), ("cylinder", (13,))])
def test_how_a_plate_or_cylinder_lies_is_within_what_is_told(pad, table, kind, columns):
    """Slopes along x and y, and the angle of an axis to x, of those that are named."""
    objects = random_objects(pad, kind, 60, np.random.default_rng(4))
    lies = objects[:, :2].T if kind == "plate" else (objects[:, :1].T + 0.5 * np.pi) % np.pi
    kinds, told = read(table, answer_of(pad, kind, objects).rise)
    sure, half = kinds == kind, 0.5 * np.pi
    assert sure.sum() >= 15
    for known, column in zip(lies, columns, strict=True):
        off = (told[column] - known + half) % np.pi - half
        spread = told[column + len(columns)]
        assert (np.abs(off)[sure] <= 4.0 * spread[sure] + 1e-3).mean() > 0.85
        assert np.median(np.abs(off)[sure]) < 0.1
        assert np.isnan(told[column][~sure]).all()


@pytest.mark.slow
def test_intervals_hold_as_often_as_they_say(pad, table):
    """Of 1,200 random contacts; the region of a place is no ellipse, and fits of few starts miss part of it."""
    shares = []
    for kind in KINDS:
        answer, rise = readings(pad, kind, 400, 11)
        shares.append(covered(read(table, rise)[1], answer))
    force, centre = np.mean(shares, axis=0)
    assert 0.93 <= force <= 0.99 and 0.92 <= centre <= 0.985


def test_a_lost_cell_is_left_out(pad, table):
    answer, rise = readings(pad, "plate", 16, 5)
    touched = answer.rise[:, 2] > 20.0 * NOISE
    rise[:, 2] = 0.0
    assert touched.sum() > 5
    # Another object explains some of them by chance.
    assert (read(table, rise[touched])[0] == "outside").mean() > 0.7
    told = read(table, rise, [3])[1]
    assert np.median(np.abs(told[0] / answer.force - 1.0)) < 0.01


@pytest.mark.slow
def test_a_lost_cell_and_swapped_channels_are_found_from_the_readings(pad, table):
    rise = readings(pad, "plate", 40, 7)[1] / KPA
    assert find_fault(table, rise)[:2] == ("none", ())
    leaking = rise.copy()
    leaking[:, 4] = 0.0
    assert find_fault(table, leaking)[:2] == ("lost", (5,))
    swapped = rise[:, [0, 1, 5, 3, 4, 2, 6]]
    assert find_fault(table, swapped)[:2] == ("swapped", (3, 6))


def test_a_press_beyond_the_range_of_a_cell_is_outside(pad, coarse, table):
    deep = pad.under_plates(np.zeros((1, 2)), np.array([1.35 * coarse.depth]))
    assert not deep.inside[0]
    assert read(table, 1.3 * deep.rise)[0].tolist() == ["outside"]


def test_what_no_object_explains_is_outside_and_noise_is_nothing(pad, table):
    checkered = 0.4 * KPA * np.array([[0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]])
    quiet = NOISE * np.random.default_rng(2).standard_normal((3, 7))
    kinds, told = read(table, np.concatenate([checkered, quiet]))
    assert kinds.tolist() == ["outside", "none", "none", "none"]
    assert np.isnan(told[0, 0]) and not told[0, 1:].any()


def test_information_grows_with_quiet_gauges_and_is_least_where_one_cell_is_touched(pad):
    balls = np.array([[4.5, 2.6, 0.35, 1.3], [0.0, 0.0, 0.35, 0.9]])
    quiet, noisy = (resolution(pad, "ball", balls, noise, 1e-3) for noise in (NOISE, 30.0 * NOISE))
    assert (quiet.force < noisy.force).all() and (quiet.place <= noisy.place).all()
    assert (pad.under_balls(balls[:, :2], pad.table.radius / balls[:, 2], balls[:, 3]).forces > 0).sum(axis=1)[1] == 1
    assert quiet.place[1] > 2.5 * quiet.place[0]


@pytest.mark.parametrize(("kind", "least", "most"), [("ball", 0.4, 2.0), ("plate", 0.1, 1.5), ("cylinder", 0.2, 2.0)])
def test_what_a_reading_leaves_is_what_information_says(pad, table, kind, least, most):
    """Errors over the standard deviations that the information gives, in the median; plates err by less than is counted,
    and readings of balls and cylinders leave open which of both it is."""
    answer, rise = readings(pad, kind, 80, 9)
    objects = random_objects(pad, kind, 240, np.random.default_rng(9))
    known = resolution(pad, kind, objects, NOISE, STRAIGHT)
    told = read(table, rise)[1]
    away = np.hypot(*(told[2:4].T - answer.centre).T)
    for errors, spread in ((np.abs(told[0] - answer.force), known.force), (away, known.place)):
        assert least < np.nanmedian(errors) / np.median(spread) < most


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "pressure", "clamp"),
    [
        ({}, 12.0, "base"),
        (CELL, 0.0, "base"),
        (CELL, 12.0, "flange"),
        (CELL | {"membrane.shape": "cap", "membrane.rise_mm": 1.8}, 12.0, "base"),
        (CELL | {"membrane.shape": "ellipsoid", "membrane.rise_mm": 4.0}, 12.0, "base"),
        (CELL | {"membrane.shape": "thimble", "membrane.side_mm": 1.5}, 12.0, "base"),
    ],
)
def test_presses_that_the_table_was_not_made_of_are_within_its_error(changes, pressure, clamp):
    sensor = evaluate("paper-dome", changes, clamp=clamp).sensor
    table = cell_table(sensor, pressure * KPA)
    plain = sensor.replace(waves=0, steps=10, **({"base": None} if clamp == "flange" else {}))
    probe = cells.solid_probe(plain, 16)
    free, random = cells.state_at(probe.solid, pressure * KPA), np.random.default_rng(8)
    for _ in range(5):
        radius = table.radius / float(random.uniform(0.06, 0.95))
        share = float(np.sqrt(random.uniform(0.05, 0.9)))
        lean = share * float(greatest_lean(table.depth, table.outer, np.array(radius)))
        offset = lean * (table.outer + radius)
        down = (table.outer + radius) * (1.0 - np.sqrt(1.0 - lean**2))
        for kind, body in (("balls", ball), ("cylinders", cylinder)):
            press = plain.replace(body=body(radius), offset=offset)
            curve = cells._pressed(press, probe, free, table.depth, max(table.depth - down, 0.35 * table.depth))
            travel = np.linspace(0.0, table.depth, len(curve.values))
            inside = travel <= min(table.depth - down, curve.end)
            at = np.full(inside.sum(), radius), np.full(inside.sum(), offset)
            found = table.under_round(kind, *at, curve.first - travel[inside])
            for ours, column in ((found.force, 0), (found.rise, 3)):
                known = curve.values[inside, column]
                least = 0.1 * table.plates.values[0, 0, -1, column]
                assert np.abs(ours - known).max() <= TABLE_ERROR * max(known.max(), least)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: the comparison is not made")
def test_three_cells_on_one_flange_answer_as_in_calculix():
    """On a coarse mesh, under a ball between them; and our answer is the stored one."""
    scene, table = pad_coupling.SCENES["ball"], pad_coupling.table_of("flange")
    answer = scene.ours(table, 0.0)
    theirs, _ = pad_coupling.pressed(scene, answer, "groove", pad_coupling.COARSE, table.apex)
    ours, known = pad_coupling.our_figures(answer), stored("pad_coupling")["scenes"]["ball"]["ours"]["flange"]
    assert len(theirs) == len(known) == 2
    found = pad_coupling.change(ours, theirs)
    assert abs(found["force"]) < 0.03 and abs(found["centre_mm"]) < 0.3 and abs(found["rise"]) < 0.03
    for one, other in zip(ours, known, strict=True):
        assert one["force_N"] == pytest.approx(other["force_N"], rel=1e-3)
        assert one["rises_kPa"] == pytest.approx(other["rises_kPa"], rel=1e-3)
