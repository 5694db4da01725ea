"""Bodies of a pad: exact volumes, one channel from each cell to its own port, and what has no space."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import label

from pneutouch.body.section import SolidSection
from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.parts.pad import lay_out_pad, pad_solids
from pneutouch.parts.pad.layout import rounded_hull
from pneutouch.parts.pad.solids import line_volume
from pneutouch.spec.pad import PadGroup, PadTable

SMALL = {
    "membrane.inner_radius_mm": 2.0,
    "membrane.wall_thickness_mm": 0.6,
    "connector.material": "VeroClear",
    "connector.mount": "plain",
    "print.connector_profile": "objet260-connex",
}
CASES = {
    "fingertip of seven, ports fanned out": ("ring:7", 6.0, {**SMALL, "connector.port": "push-in-4"}),
    "jaw with a plate for screws": ("grid:2x4", 24.0, {}),
    "row of flat cells with Luer locks": (
        "row:2",
        14.0,
        {**SMALL, "membrane.inner_radius_mm": 4.0, "membrane.shape": "disc", "connector.port": "luer-female"},
    ),
    "domes of two sizes and walls": (
        "grid:2x2",
        15.0,
        {**SMALL, "membrane.inner_radius_mm": 4.0, "connector.port": "barb-3x2"},
        {"membrane.inner_radius_mm": 5.0, "membrane.wall_thickness_mm": 2.2, "membrane.shape": "ellipsoid"},
    ),
    "palm": ("hex:19", 9.0, {**SMALL, "membrane.inner_radius_mm": 3.0, "connector.port": "barb-3x2"}),
}


def made(layout, pitch, changes, others=None):
    """A pad; of a group with other changes are cells 1 and 4."""
    scenes = [load_scene("paper-dome", {**changes, **each}) for each in ({}, others) if each is not None]
    groups = [PadGroup(cells=[1, 4])] * (others is not None)
    table = PadTable(cell="paper-dome", layout=layout, pitch_mm=pitch, groups=groups)
    return scenes[0], lay_out_pad(scenes[0], table, "here", scenes[1:])


@pytest.fixture(params=CASES, scope="module")
def case(request):
    return made(*CASES[request.param])


def test_bodies_are_closed_whole_and_of_the_exact_volume(case):
    scene, pad = case
    for solid in pad_solids(scene, pad):
        body = solid.mesh(0.01)
        assert body.is_closed() and len(body.manifold().decompose()) == 1
        assert body.volume == pytest.approx(solid.volume, rel=2e-4)


def test_every_channel_is_one_hole_and_the_membrane_has_none(case):
    scene, pad = case
    membrane, manifold = (solid.mesh(0.03) for solid in pad_solids(scene, pad))
    assert membrane.manifold().genus() == 0
    assert manifold.manifold().genus() == len(pad.places) + len(pad_solids(scene, pad)[1].bores)


def test_the_cad_kernel_has_the_exact_volumes():
    import cadquery as cq

    from pneutouch.export.step import exact_solid

    scene, pad = made(*CASES["fingertip of seven, ports fanned out"])
    for solid in pad_solids(scene, pad):
        other = cq.Shape.cast(exact_solid(solid))
        assert other.isValid() and other.Volume() == pytest.approx(solid.volume, rel=1e-6)


def test_membrane_and_manifold_share_no_volume(case):
    scene, pad = case
    one, other = (solid.mesh(0.02).manifold() for solid in pad_solids(scene, pad))
    assert (one ^ other).volume() < 1e-6 * one.volume()


def test_the_gas_of_a_cell_reaches_its_own_port_and_no_other():
    """Flood fill on voxels, between the spigots' tops and the ports' mouths; the volume is that of the prediction."""
    scene, pad = made(*CASES["fingertip of seven, ports fanned out"])
    step, mouth = 0.125, pad.low - pad.cell.port.length
    section = SolidSection(pad_solids(scene, pad)[1])
    x, y = (np.arange(section.low[k], section.high[k] + step, step) for k in (0, 1))
    z = np.arange(mouth + 0.5 * step, pad.cell.floor, step)
    grid = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1)
    regions, _ = label(~section.contains(grid.reshape(-1, 3)).reshape(grid.shape[:3]))

    def at(place, k):
        return regions[np.abs(x - place[0]).argmin(), np.abs(y - place[1]).argmin(), k]

    numbers = [at(place, -1) for place in pad.places]
    assert len(set(numbers)) == len(pad.places)
    assert numbers == [at(port, 0) for port in pad.ports]
    for k, number in enumerate(numbers):
        filled = pad.cell.port.filled_volume()
        assert (regions == number).sum() * step**3 == pytest.approx(line_volume(pad, k) + filled, rel=0.03)


def test_a_group_has_domes_of_its_own_on_the_flange_of_the_thickest():
    scene, pad = made(*CASES["domes of two sizes and walls"])
    assert [dome.inner_radius for dome in pad.domes] == [5.0, 4.0, 4.0, 5.0]
    assert {dome.plate_high for dome in pad.domes} == {-pad.domes[0].flange_thickness}
    membrane, manifold = (solid.mesh(0.02).corners.reshape(-1, 3) for solid in pad_solids(scene, pad))
    for (x, y), dome in zip(pad.places, pad.domes, strict=True):
        over = membrane[np.hypot(membrane[:, 0] - x, membrane[:, 1] - y) < dome.outer_radius]
        assert over[:, 2].max() == pytest.approx(dome.shape.outer_height, abs=1e-6)
        away = np.hypot(manifold[:, 0] - x, manifold[:, 1] - y)
        on_top = (manifold[:, 2] > dome.floor - 1e-6) & (away < dome.outer_radius)
        assert away[on_top].max() == pytest.approx(dome.groove_inner, rel=0.005)


@settings(max_examples=60, deadline=None)
@given(
    places=st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=2, max_size=12, unique=True),
    pitch=st.floats(8.0, 20.0),
)
def test_channels_of_any_pattern_keep_apart(places, pitch):
    """Nowhere are the axes of two channels nearer than the cells."""
    points = [[0.5 * pitch * x, 0.5 * pitch * y] for x, y in places]
    scene = load_scene("paper-dome", {**SMALL, "membrane.inner_radius_mm": 1.2, "connector.port": "push-in-4"})
    table = PadTable(cell="paper-dome", layout="points", points_mm=points)
    try:
        pad = lay_out_pad(scene, table, "here")
    except InputError as error:
        assert error.key == "pad.points_mm"
        return
    nearest = min(math.dist(*pair) for pair in combinations(pad.places, 2))
    for share in np.linspace(1.0, pad.fan, 5):
        at = [(share * u, share * v) for u, v in pad.places]
        assert min(math.dist(*pair) for pair in combinations(at, 2)) >= nearest - 1e-9
    lean = max(math.hypot(*pad.lean(k)) for k in range(len(points)))
    reach = pad.channel * math.hypot(1.0, lean) + lean * (pad.cell.floor - pad.middle)
    assert reach <= pad.cell.groove_inner - scene.connector_printer.smallest.wall("rigid").recommended + 1e-9


def test_a_pad_is_the_same_wherever_its_cells_are_counted_from():
    scene = load_scene("paper-dome", {"connector.port": "push-in-4", "membrane.inner_radius_mm": 6.0})
    made = []
    for u, v in ((0.0, 0.0), (90.0, -40.0)):
        points = [[u + x, v + y] for x, y in ((0.0, 0.0), (16.0, 0.0), (8.0, 15.0))]
        made.append(lay_out_pad(scene, PadTable(cell="paper-dome", layout="points", points_mm=points), "here"))
    here, there = ([solid.mesh(0.05) for solid in pad_solids(scene, one)] for one in made)
    assert np.allclose(np.array(made[1].ports) - np.array(made[0].ports), [90.0, -40.0])
    for one, other in zip(here, there, strict=True):
        assert other.volume == pytest.approx(one.volume, rel=1e-6)
        assert np.allclose(other.bounds - one.bounds, [90.0, -40.0, 0.0], atol=1e-6)


@pytest.mark.parametrize("count", [2, 3, 4, 7, 9])
def test_a_ring_is_no_closer_than_its_pitch(count):
    places = PadTable(cell="c", layout=f"ring:{count}", pitch_mm=5.0).places
    assert len(places) == count
    assert min(math.dist(*pair) for pair in combinations(places, 2)) == pytest.approx(5.0)


def test_seven_on_a_triangular_lattice_are_a_ring():
    ring, hexagon = (sorted(PadTable(cell="c", layout=f"{kind}:7", pitch_mm=5.0).places) for kind in ("ring", "hex"))
    assert np.allclose(np.round(ring, 6), np.round(hexagon, 6))


def test_the_outline_of_places_on_a_line_is_that_of_a_slot():
    length = sum(piece.length for piece in rounded_hull([(0.0, 0.0), (4.0, 0.0), (10.0, 0.0)], 3.0) if piece.tag)
    assert length == pytest.approx(20.0 + 6.0 * math.pi)


@pytest.mark.parametrize(
    ("layout", "pitch", "changes", "key"),
    [
        ("ring:7", 5.0, SMALL, "pad.pitch_mm"),
        ("row:2", 20.0, {"connector.seat": "clamped-flange-M2"}, "connector.seat"),
        ("row:2", 20.0, {"connector.mount": "finger-16"}, "connector.mount"),
    ],
)
def test_what_a_pad_cannot_have_is_refused(layout, pitch, changes, key):
    with pytest.raises(InputError) as caught:
        made(layout, pitch, changes)
    assert caught.value.key == key and caught.value.remedy


def test_a_pitch_as_the_remedy_says_is_taken():
    with pytest.raises(InputError) as caught:
        made("ring:7", 5.0, SMALL)
    least = float(str(caught.value.remedy).split("at least ")[1].split()[0])
    made("ring:7", least, SMALL)


def test_a_manifold_too_thin_for_its_channels_says_how_thick():
    scene = load_scene("paper-dome", {**SMALL, "connector.port": "push-in-4"})
    table = PadTable(cell="c", layout="ring:7", pitch_mm=6.0, thickness_mm=3.0)
    with pytest.raises(InputError) as caught:
        lay_out_pad(scene, table, "here")
    least = float(str(caught.value.remedy).split("at least ")[1].split(",")[0])
    thick = lay_out_pad(scene, table.model_copy(update={"thickness_mm": least}), "here")
    assert thick.cell.plate_high - thick.low == pytest.approx(least)


@pytest.mark.parametrize("layout", ["ring:1", "grid:9x9", "circle:7", "grid:2", "row:0"])
def test_a_layout_that_is_none_is_refused(layout):
    with pytest.raises(ValueError):
        PadTable(cell="c", layout=layout)


def test_points_go_with_their_layout():
    for more in ({"layout": "points"}, {"layout": "ring:7", "points_mm": [[0.0, 0.0], [9.0, 0.0]]}):
        with pytest.raises(ValueError):
            PadTable(cell="c", **more)
