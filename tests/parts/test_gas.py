"""The gas behind the cavity: exact figures against meshes, against quadrature, and against Open CASCADE's solids."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from pneutouch.catalogue import Library, load_scene
from pneutouch.parts import assemble
from pneutouch.parts.air_path import crossing
from pneutouch.spec.read import parse_changes
from tests.catalogue.store import CAST
from tests.conftest import ROOT
from tests.parts.space import measured_volume

LIBRARY = Library((ROOT,))
MOUNTS = ("bolt-circle-4xM3", "robot-50-4-M6")
CASES = [
    # Every port on every seat; the second of the two mounts is left to the slow run.
    pytest.param(port, seat, MOUNTS[(k + other) % 2], marks=pytest.mark.slow if other else ())
    for k, (port, seat) in enumerate(itertools.product(sorted(LIBRARY.paths("ports")), sorted(LIBRARY.paths("seats"))))
    for other in range(2)
]
FITS = {("cast-ring", "robot-50-4-M6"): ["membrane.inner_radius_mm=8"]}
"""Sizes for seats that are too wide for a mount with the dome as it is."""


def assembly(port, seat, mount, *more):
    chosen = [
        f"connector.port={port}",
        f"connector.seat={seat}",
        f"connector.mount={mount}",
        *CAST.get(seat, ()),
        *FITS.get((seat, mount), ()),
        *more,
    ]
    return assemble(load_scene("stiff-dome", parse_changes(chosen), LIBRARY))


@given(st.floats(0.3, 20), st.floats(0.05, 0.95))
def test_crossing_of_a_bore_and_a_cylinder_against_quadrature(radius, share):
    bore = share * radius

    def slice_of(y):
        return 2 * math.sqrt(bore**2 - y**2) * math.sqrt(radius**2 - y**2)

    assert crossing(radius, bore) == pytest.approx(quad(slice_of, -bore, bore, epsabs=0, epsrel=1e-10)[0], rel=1e-8)


def test_crossing_of_equal_cylinders_is_the_bicylinder():
    assert crossing(1.0, 1.0) == pytest.approx(8 / 3, rel=2e-4)
    with pytest.raises(ValueError, match="wider"):
        crossing(1.0, 1.1)


@pytest.mark.slow
@pytest.mark.parametrize(("port", "seat", "mount"), CASES)
def test_internal_volume_is_what_the_meshes_leave_free(port, seat, mount):
    made = assembly(port, seat, mount)
    assert made.internal_volume == pytest.approx(measured_volume(made), rel=1e-3)


def test_a_gap_between_the_bodies_leaks():
    """The measure itself: a connector without its seat lets the air out."""
    made = assembly("barb-4x2.5", "clamped-flange-M2", "bolt-circle-4xM3")
    lifted = tuple(solid for solid in made.solids if solid.name != "membrane")
    assert measured_volume(made, lifted) < 0.9 * made.internal_volume


def test_dead_volume_counts_connector_and_tube_and_the_tube_named(library):
    made = assembly("barb-4x2.5", "glued-flange", "plain", "pneumatics.tube_length_mm=1000")
    other = assembly("push-in-6", "glued-flange", "plain", "pneumatics.tube_length_mm=1000")
    assert made.tube_volume == pytest.approx(math.pi / 4 * 2.5**2 * 1000, rel=1e-12)
    assert other.tube_volume == pytest.approx(math.pi / 4 * 4.0**2 * 1000, rel=1e-12)
    stiff = load_scene("stiff-dome", None, library)
    assert stiff.design.pneumatics.dead_volume_mL == 0
    free = load_scene("long-tube", None, library)
    made = assemble(free)
    assert made.dead_volume == pytest.approx(made.internal_volume + made.tube_volume)


@pytest.mark.parametrize("port", ["luer-female", "thread-M5", "barb-6x4", "o-ring-9"])
@pytest.mark.parametrize(
    ("seat", "mount"),
    [
        ("one-piece", "rear-3xM2"),
        ("clamped-flange-M2", "finger-16"),
        ("glued-flange", "robot-50-4-M6"),
        ("cast-ring", "plain"),
        ("clamped-flange-M2-gasket", "rear-4xM3-insert"),
        ("clamped-flange-M2-insert", "finger-16"),
    ],
)
def test_exact_volumes_are_those_of_the_cad_kernel(port, seat, mount):
    import cadquery as cq

    from pneutouch.export.step import exact_solid

    made = assembly(port, seat, mount)
    # Open CASCADE approximates the curves where round bores meet round walls.
    tolerance = 1e-9 if made.layout.port_axis is None else 3e-5
    for solid in made.solids:
        other = cq.Shape.cast(exact_solid(solid))
        assert other.isValid()
        assert other.Volume() == pytest.approx(solid.volume, rel=tolerance)


def test_the_volume_of_a_crossed_connector_is_where_finer_meshes_go():
    solid = assembly("barb-6x4", "glued-flange", "robot-50-4-M6").solid("connector")
    errors = [abs(solid.mesh(tolerance).volume / solid.volume - 1) for tolerance in (0.02, 0.005, 0.00125)]
    assert errors[0] > 2 * errors[1] > 4 * errors[2]
    assert errors[2] < 5e-7
