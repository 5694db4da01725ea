"""The accuracy page says what the code gives today; its times are left to whoever runs it."""

from __future__ import annotations

import re

import pytest
from benchmarks.chart import DOCS, contact_section, inflation_section
from benchmarks.meshing import manifold_revolve, plain_grid
from benchmarks.theory import table_s1


def test_theory_sections_are_what_the_code_gives(library):
    text = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    assert "\n".join(inflation_section()) in text
    assert "\n".join(contact_section(table_s1(library))) in text


def test_mesh_table_keeps_every_tolerance_at_fewer_triangles_than_the_plain_grid():
    text = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([\d.]+) \| ([^|]+) \| [\d.]+ \| (\d+) \| ([\d.]+) \|", text, re.MULTILINE)
    ours = {t: (int(n), float(d)) for t, method, n, d in rows if method == "pneutouch"}
    plain = {t: int(n) for t, method, n, _ in rows if method == "plain grid, numpy"}
    assert set(ours) == {"0.1", "0.05", "0.016", "0.005"}
    for tolerance, (count, deviation) in ours.items():
        assert deviation <= 1.0
        assert count <= 0.6 * plain[tolerance]


@pytest.mark.parametrize("peer", [plain_grid, manifold_revolve])
def test_the_peers_are_given_a_fair_outline(peer, evaluated):
    """Both peers mesh the same solid and keep the tolerance too: they lose on count and volume alone."""
    solid = evaluated("paper-dome").assembly.solids[0]
    vertices, triangles = peer(solid.meridian, 0.05)
    middle = vertices[triangles].mean(axis=1)
    assert solid.distance(middle).max() <= 0.05
    assert solid.distance(vertices).max() < 1e-5
