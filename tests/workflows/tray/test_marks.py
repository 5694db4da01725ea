"""Part marks: legible to the printer, on faces that bear them, and a mesh that stays closed."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.catalogue import load_scene
from pneutouch.parts import assemble
from pneutouch.parts.lettering.glyphs import is_clear, lettering, narrowest
from pneutouch.parts.lettering.mark import Marker, read, tally
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.tray.order import letter

SEATS = ("glued-flange", "clamped-flange-M2", "one-piece")
MOUNTS = ("bolt-circle-4xM3", "rear-3xM2", "plain", "robot-50-4-M6")
PROFILES = [
    "print.profile=j735",
    "print.connector_profile=j735",
    "connector.material=VeroClear",
    "membrane.material=Agilus30",
]


@pytest.fixture(scope="module")
def drawn(library):
    def run(*changes):
        return assemble(load_scene("agilus-dome", parse_changes([*PROFILES, *changes]), library))

    return run


def bodies(assembly, marks="engraved", label="B2", number=(2, 2)):
    """Solid, plain mesh, marked mesh and mark of each body, each marked as if printed alone."""
    printer = assembly.scene.printer
    marker = Marker(printer, marks, ["A1", "B2", "C8"])
    for solid in assembly.solids:
        plain = solid.mesh(0.027)
        yield solid, plain, *marker.marked(assembly, solid, plain, label, number)


@given(index=st.integers(1, 60), copy=st.integers(1, 30), turn=st.floats(0, 6.28), order=st.randoms())
def test_a_tally_reads_back_from_any_side(index, copy, turn, order):
    found = tally(index, copy, 40.0, 42.0, 0.6)
    sectors = [(first + turn, last + turn) for first, last in found.sectors]
    order.shuffle(sectors)
    assert read(sectors) == (index, copy)


@given(index=st.integers(1, 30), copy=st.integers(1, 30), radius=st.floats(4, 30))
def test_grooves_keep_their_width_and_their_distance_or_there_are_none(index, copy, radius):
    found = tally(index, copy, radius, radius + 1.0, 0.6)
    if found is None:
        return
    ends = [*(end for sector in found.sectors for end in sector), found.sectors[0][0] + 2 * np.pi]
    widths = np.diff(ends) * radius
    assert widths[0::2].min() >= 0.6 - 1e-9
    assert widths[1::2].min() >= 0.7
    assert widths[-1] >= 2.0


@pytest.mark.parametrize("height", [3.5, 4.0, 5.0])
@pytest.mark.parametrize("least", [0.5, 0.6])
def test_strokes_are_as_wide_as_the_printer_needs(height, least):
    for k in range(1, 25):
        text = f"{letter(k)}{k % 10}"
        if is_clear(text, height, least):
            shape = lettering(text, height, least)
            assert narrowest(shape) >= least - 2e-3, text
            _, low, _, high = shape.bounds()
            assert high - low >= height - 1e-6


def test_the_measure_of_width_knows_a_plate_and_a_neck():
    from manifold3d import CrossSection

    assert narrowest(CrossSection.square((5, 0.7), True)) == pytest.approx(0.7, abs=2e-3)
    dumbbell = CrossSection.square((6, 0.4), True) + CrossSection.circle(1.0, 64).translate((-3, 0))
    dumbbell += CrossSection.circle(1.0, 64).translate((3, 0))
    assert narrowest(dumbbell) == pytest.approx(0.4, abs=2e-3)
    apart = CrossSection.circle(1.0, 64).translate((-3, 0)) + CrossSection.square((0.3, 4), True)
    assert narrowest(apart) == pytest.approx(0.3, abs=2e-3)


CASES = [
    # Every mount on every seat; the other way to mark is left to the slow run.
    pytest.param(seat, mount, ("engraved", "raised")[(k + other) % 2], marks=pytest.mark.slow if other else ())
    for k, (seat, mount) in enumerate(itertools.product(SEATS, MOUNTS[::-1]))
    for other in range(2)
]


@pytest.mark.slow
@pytest.mark.parametrize(("seat", "mount", "marks"), CASES)
def test_marked_meshes_stay_closed_and_differ_by_the_mark_alone(drawn, seat, mount, marks):
    assembly = drawn(
        f"connector.seat={seat}",
        f"connector.mount={mount}",
        "membrane.inner_radius_mm=9",
        "membrane.wall_thickness_mm=1.5",
    )
    least = assembly.scene.printer.smallest.emboss_mm.recommended
    for solid, plain, marked, mark in bodies(assembly, marks):
        assert marked.is_closed()
        for shift in (0.0, 211.357):
            assert marked.moved(np.array([shift, shift, 0.0])).welded().is_closed()
        if mark.kind == "none":
            assert mark.note
            assert solid.role == "ring"
            continue
        assert mark.stroke >= least - 2e-3
        assert mark.depth >= least
        taken, put = plain.manifold() - marked.manifold(), marked.manifold() - plain.manifold()
        change = put.volume() if mark.raised else -taken.volume()
        assert marked.volume - plain.volume == pytest.approx(change, abs=1e-3)
        assert (taken if mark.raised else put).volume() == pytest.approx(0.0, abs=1e-4)
        assert abs(change) > 0.5
        touched = put if mark.raised else taken
        *_, low = touched.bounding_box()[:3]
        high = touched.bounding_box()[5]
        if mark.face != "flange edge":
            assert high - low == pytest.approx(mark.depth, abs=1e-6)
            area = touched.slice(0.5 * (low + high))
            assert abs(change) == pytest.approx(area.area() * mark.depth, rel=1e-3)
            assert narrowest(area) >= least - 3e-3


@pytest.mark.parametrize(
    ("marks", "seat"),
    [
        ("engraved", SEATS[0]),
        ("raised", SEATS[1]),
        *(pytest.param(*pair, marks=pytest.mark.slow) for pair in (("engraved", SEATS[1]), ("raised", SEATS[0]))),
    ],
)
def test_marks_are_a_fifth_larger_than_the_least_detail(drawn, seat, marks):
    """Depth of letters, and the width of a tally's narrowest groove; a print of the recommended detail is at its limit."""
    assembly = drawn(f"connector.seat={seat}", "membrane.wall_thickness_mm=2")
    sure = 1.2 * assembly.scene.printer.smallest.emboss_mm.recommended
    found = {mark.kind: mark for *_, mark in bodies(assembly, marks) if mark.kind != "none"}
    assert set(found) == {"text", "tally"}
    assert found["text"].depth == pytest.approx(sure)
    if found["tally"].raised or seat == "clamped-flange-M2":
        assert found["tally"].depth == pytest.approx(sure)
    # A chord is a little shorter than the arc that was asked for.
    assert found["tally"].stroke == pytest.approx(sure, rel=2e-3)


@pytest.mark.parametrize("seat", SEATS[:2])
@pytest.mark.parametrize("marks", ["engraved", "raised"])
def test_the_tally_keeps_off_the_dome_and_the_seals(drawn, seat, marks):
    assembly = drawn(f"connector.seat={seat}")
    layout = assembly.layout
    solid, plain, marked, mark = next(bodies(assembly, marks))
    assert solid.name == "membrane"
    known = {tuple(vertex) for vertex in np.round(plain.vertices, 6)}
    mesh = np.array([vertex for vertex in np.round(marked.vertices, 6) if tuple(vertex) not in known])
    assert len(mesh) >= 8 * 5
    radius = np.hypot(*mesh[:, :2].T)
    if seat == "clamped-flange-M2":
        assert mark.face == "flange edge" and not mark.raised
        third = layout.flange_thickness / 3
        assert mesh[:, 2].max() <= -third + 1e-6 and mesh[:, 2].min() >= -2 * third - 1e-6
        assert radius.min() >= layout.flange_radius - mark.depth - 0.02
    else:
        assert radius.min() >= layout.outer_radius + 0.4
        assert radius.max() <= layout.flange_radius - 0.5
        assert mark.depth <= (1.0 if mark.raised else layout.flange_thickness / 3 + 1e-9)


@settings(max_examples=15)
@given(
    radius=st.floats(4, 30),
    wall=st.floats(0.6, 3.0),
    index=st.integers(1, 24),
    copy=st.integers(1, 12),
    seat=st.sampled_from(SEATS[:2]),
    marks=st.sampled_from(["engraved", "raised"]),
)
def test_any_membrane_is_marked_and_closed_or_says_why_not(drawn, radius, wall, index, copy, seat, marks):
    assembly = drawn(
        f"membrane.inner_radius_mm={radius}",
        f"membrane.wall_thickness_mm={wall}",
        f"connector.seat={seat}",
        "indentation.plate_diameter_mm=90",
        "connector.mount=plain",
    )
    _, plain, marked, mark = next(bodies(assembly, marks, number=(index, copy)))
    assert marked.welded().is_closed()
    assert (mark.kind == "tally") == (marked is not plain)
    assert mark.kind == "tally" or mark.note


def test_letters_are_told_from_figures():
    names = [letter(k) for k in range(1, 24 * 25 + 1)]
    assert len(set(names)) == len(names)
    assert not {"I", "O"} & set("".join(names))
    assert names[:3] + names[23:26] == ["A", "B", "C", "Z", "AA", "AB"]
