"""Large patterns: closed, exact, and of how many triangles. Their times: ``tests.ratios``."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from pneutouch.body.shapes import circle_count
from pneutouch.parts.specimen import Box, complement
from pneutouch.parts.specimen.struts import STRUTS, Lattice, fill
from tests.parts.specimen.shapes import STEP, bars_by_hand, body, context, drawn

# Struts in a cell, counted once where cells share them.
PER_CELL = {"simple-cubic": 3, "bcc": 8, "fcc": 24, "octet": 36, "kelvin": 24}


def batch_of_hulls(kind, lattice, counts):
    """Every strut as the hull of its two balls, as the octant's are, not trimmed."""
    from manifold3d import Manifold

    ball, ends = lattice.ball(), set()
    for cell in itertools.product(*map(range, counts)):
        for one, other in STRUTS[kind]:
            for signs in itertools.product((0, 1), repeat=3):
                pair = [
                    tuple(2 * cell[k] + (2 - 2 * e[k] if signs[k] else 2 * e[k]) for k in range(3))
                    for e in (one, other)
                ]
                ends.add(tuple(sorted(pair)))
    return [Manifold.hull_points(np.concatenate([ball + np.array(a), ball + np.array(b)])) for a, b in sorted(ends)]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "counts"), [("bcc", (20, 8, 8))])
def test_ten_thousand_struts_are_closed(kind, counts):
    lattice = Lattice.of(kind, 4.0, 0.35, STEP)
    box = Box((0.0, 0.0, 0.0), tuple(4.0 * n for n in counts))
    inclusion = fill(lattice, box)
    assert len(batch_of_hulls(kind, lattice, counts)) > 10_000
    assert inclusion.is_closed()
    assert complement(box, inclusion).is_closed()


@pytest.mark.parametrize("kind", STRUTS)
def test_triangles_are_at_most_twice_what_the_printer_resolves(kind):
    radius, cell, counts = 0.4, 5.0, (4, 4, 4)
    mesh = fill(Lattice.of(kind, cell, radius, STEP), Box((0.0, 0.0, 0.0), tuple(cell * n for n in counts)))
    sides = circle_count(radius, STEP)
    # A plain strut: two triangles a side, and a ball of that tolerance at each of its ends, half of it its own.
    plain = PER_CELL[kind] * math.prod(counts) * (2 * sides + sides * (sides // 2 - 1))
    assert len(mesh.triangles) <= 2 * plain


@pytest.mark.slow
@pytest.mark.parametrize("depth", [0.0, 3.0], ids=["flush", "buried"])
def test_ten_thousand_bars_are_cut_out_exactly(depth):
    box = Box((0.0, 0.0, 7.0 - depth), (30_000.0, 20.0, 8.0 - depth))
    block = Box((0.0, 0.0, 0.0), (30_000.0, 20.0, 8.0))
    bars = bars_by_hand(10_000, 3.0, 1.5, box)
    matrix = complement(block, bars)
    assert body(matrix, "matrix").is_closed()
    assert matrix.volume + bars.volume == pytest.approx(block.volume, rel=1e-9)


def test_bars_of_the_family_are_counted():
    pattern = drawn(context(1000, 20, 8), "bars", pitch_mm=2.0, width_mm=1.0, height_mm=1.0)
    assert pattern.truth["count"] == 500
