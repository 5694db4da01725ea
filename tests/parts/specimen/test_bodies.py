"""Matrix and inclusion: closed, complementary to 1e-6 of the block, the same triangles on both sides, no overlap."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.parts.specimen import Box, complement
from pneutouch.parts.specimen.family import joined
from pneutouch.parts.specimen.struts import STRUTS
from pneutouch.parts.specimen.surfaces import SURFACES
from pneutouch.printability.rules.bodies import shared_area
from tests.parts.overlap import overlap_volume
from tests.parts.specimen.shapes import STEP, body, context, drawn

FRACTIONS = {
    "schwarz-p network": (0.25, 0.4, 0.6),
    "schwarz-p sheet": (0.3, 0.4, 0.55),
    "octet": (0.15, 0.25, 0.4),
    "simple-cubic": (0.05, 0.2, 0.5),
}

# Surfaces in coarse chords every day, and in those of the printer in the slow run: seven times the triangles.
STEPS = pytest.mark.parametrize(
    "step", [pytest.param(0.1, id="coarse"), pytest.param(STEP, id="printed", marks=pytest.mark.slow)]
)
# The ends of the range of fractions are left to the slow run.
SHARES = pytest.mark.parametrize(
    "share", [pytest.param(0, marks=pytest.mark.slow), 1, pytest.param(2, marks=pytest.mark.slow)]
)


def area_of(mesh, box):
    """Area in mm2 of the triangles that lie on no side of the box."""
    corners = mesh.vertices[mesh.triangles]
    ends = np.array([box.low, box.high])
    on = (corners[:, :, None, :] == ends[None, None]).all(axis=1).any(axis=(1, 2))
    a, b, c = np.moveaxis(corners[~on], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def check(at, pattern):
    inclusion, matrix = body(pattern.mesh), body(complement(at.block, pattern.mesh), "matrix")
    for one in (inclusion, matrix):
        assert one.is_closed()
        assert one.welded().is_closed()
        assert one.volume > 0
    assert inclusion.volume + matrix.volume == pytest.approx(at.block.volume, rel=1e-6)
    face = area_of(pattern.mesh, at.block)
    assert shared_area(inclusion, matrix) == pytest.approx(face, rel=1e-9)
    assert area_of(complement(at.block, pattern.mesh), at.block) == pytest.approx(face, rel=1e-9)
    # The kernel rounds on coincident facets: 3e-5 mm3 on 900 mm2 of them.
    assert overlap_volume(inclusion, matrix) < 1e-6 * at.block.volume


@pytest.mark.slow
@STEPS
@SHARES
@pytest.mark.parametrize("kind", STRUTS)
@pytest.mark.parametrize("cell", [5.0, 5.3], ids=["whole cells", "cut cells"])
def test_struts_at_three_fractions(kind, share, cell, step):
    at, fraction = context(15, 10, 8, step=step), FRACTIONS.get(kind, (0.1, 0.2, 0.4))[share]
    pattern = drawn(at, kind, cell_mm=cell, volume_fraction=fraction, depth_mm=1.0, height_mm=5.0)
    assert pattern.mesh.volume / pattern.box.volume == pytest.approx(fraction, rel=0.01)
    check(at, pattern)


@pytest.mark.slow
@STEPS
@SHARES
@pytest.mark.parametrize("form", ["sheet", "network"])
@pytest.mark.parametrize("kind", SURFACES)
def test_surfaces_at_three_fractions(kind, form, share, step):
    at, fraction = context(12, 10, 8, step=step), FRACTIONS.get(f"{kind} {form}", (0.4, 0.5, 0.7))[share]
    pattern = drawn(at, kind, cell_mm=6.0, form=form, volume_fraction=fraction, depth_mm=0.0, height_mm=6.0)
    assert pattern.mesh.volume / pattern.box.volume == pytest.approx(fraction, rel=0.01)
    check(at, pattern)


@pytest.mark.slow
@STEPS
@pytest.mark.parametrize("kind", [*STRUTS, "gyroid"])
def test_a_lattice_through_the_whole_block_is_flush_with_every_side(kind, step):
    at = context(10, 10, 10, step=step)
    pattern = drawn(at, kind, cell_mm=5.0, volume_fraction=0.4)
    assert pattern.box == at.block
    check(at, pattern)


@STEPS
@pytest.mark.parametrize("kind", ["gyroid", "schwarz-p", "diamond"])
def test_a_sheet_of_a_thickness_has_it_times_its_middle_surface(kind, step):
    pattern = drawn(context(12, 12, 12, step=step), kind, cell_mm=6.0, thickness_mm=0.8)
    # Area of the minimal surface in a unit cell: 3.09144 (gyroid) and 2.34510 (P); of D, 3.83778 in its own cubic cell,
    # which is half of the wave's (Schroeder-Turk et al. 2006). The waves are approximations of the surfaces.
    area = {"gyroid": 3.0914, "schwarz-p": 2.3451, "diamond": 3.8378}[kind]
    assert pattern.mesh.volume / pattern.box.volume == pytest.approx(0.8 * area / 6.0, rel=0.03)


@given(
    count=st.integers(1, 12),
    width=st.floats(0.7, 4.0),
    space=st.floats(0.7, 4.0),
    height=st.floats(0.7, 3.0),
    depth=st.one_of(st.just(0.0), st.floats(0.5, 4.0)),
    span=st.one_of(st.none(), st.floats(2.0, 9.0)),
)
def test_bars_of_any_size_are_exact(count, width, space, height, depth, span):
    width, space, height, depth = (round(value, 3) for value in (width, space, height, depth))
    at = context(round(count * (width + space), 3), 10.0, 8.0)
    keys = {} if span is None else {"span_mm": round(span, 3)}
    pattern = drawn(
        at, "bars", pitch_mm=round(width + space, 3), width_mm=width, height_mm=height, depth_mm=depth, **keys
    )
    across = keys.get("span_mm", 10.0)
    assert pattern.truth["count"] == count
    assert pattern.mesh.volume == pytest.approx(count * width * across * height, rel=1e-6)
    assert pattern.volume == pytest.approx(pattern.mesh.volume, rel=1e-12)
    assert sum(solid.volume for solid in pattern.solids) == pytest.approx(pattern.volume, rel=1e-12)
    check(at, pattern)


def test_bars_flush_with_every_side_are_built():
    at = context(11.0, 10.0, 8.0)
    pattern = drawn(at, "bars", pitch_mm=8.0, width_mm=3.0, height_mm=8.0)
    assert pattern.box == at.block
    check(at, pattern)


def test_waves_meet_their_integral():
    at = context(30, 10, 8)
    sine = drawn(at, "sinusoid", pitch_mm=3.0, amplitude_mm=0.5, height_mm=1.0, depth_mm=1.0)
    # Crest to floor is 2 mm; a whole number of waves has its mean half way between trough and crest.
    assert sine.mesh.volume == pytest.approx(30 * 10 * 1.5, rel=2e-3)
    check(at, sine)
    mixed = drawn(at, "random-phase", pitches_mm=[3.0, 4.5, 7.0], amplitude_mm=0.3, height_mm=1.0, depth_mm=1.0, seed=3)
    again = drawn(at, "random-phase", pitches_mm=[3.0, 4.5, 7.0], amplitude_mm=0.3, height_mm=1.0, depth_mm=1.0, seed=3)
    assert np.array_equal(mixed.mesh.vertices, again.mesh.vertices)
    check(at, mixed)


@STEPS
def test_several_patterns_together(step):
    at = context(30, 20, 12, step=step)
    parts = [
        drawn(at, "bars", pitch_mm=3.0, height_mm=1.0),
        drawn(at, "octet", cell_mm=5.0, volume_fraction=0.25, depth_mm=2.0, height_mm=5.0),
        drawn(at, "gyroid", cell_mm=6.0, volume_fraction=0.5, depth_mm=8.0),
    ]
    whole = joined([part.mesh for part in parts])
    matrix = complement(at.block, whole)
    assert matrix.is_closed()
    assert matrix.volume + sum(part.mesh.volume for part in parts) == pytest.approx(at.block.volume, rel=1e-9)


def test_many_holes_are_cut_into_parts_that_still_conform():
    box = Box((0.0, 0.0, 0.0), (900.0, 10.0, 8.0))
    pattern = drawn(context(900, 10, 8), "bars", pitch_mm=3.0, width_mm=1.5, height_mm=1.0, depth_mm=3.0)
    matrix = complement(box, pattern.mesh)
    assert matrix.is_closed()
    assert matrix.volume + pattern.mesh.volume == pytest.approx(box.volume, rel=1e-12)
