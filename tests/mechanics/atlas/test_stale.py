"""The shipped file: it belongs to today's solid and recipe, is small, and would be known for stale."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from release.tables.atlas import stale

from pneutouch.mechanics.atlas.recipe import RECIPE, STORED, AtlasRecipe, axes
from pneutouch.mechanics.atlas.table import SHIPPED, shipped
from pneutouch.mechanics.solid import mesh


def test_the_shipped_file_was_made_from_todays_solid_and_recipe():
    with np.load(SHIPPED) as file:
        assert str(file["solid"]) == stale.solid_fingerprint()
        assert str(file["recipe"]) == RECIPE.text()
    assert shipped().recipe == RECIPE


def test_the_shipped_file_is_below_two_megabytes_and_holds_numbers_only():
    assert SHIPPED.stat().st_size < 2_000_000
    way = axes(RECIPE)
    with np.load(SHIPPED, allow_pickle=False) as file:
        shape = (way.wall.size, way.volume.size, way.depth.size)
        for name in ("potential", *STORED):
            assert file[name].shape == shape and np.isfinite(file[name]).all()


@pytest.fixture
def one_wall(monkeypatch):
    """The fingerprint of one wall, which is quick."""
    monkeypatch.setattr(stale, "_WALLS", (0.16,))
    return stale.solid_fingerprint()


@pytest.mark.slow
def test_the_fingerprint_repeats(one_wall):
    assert stale.solid_fingerprint() == one_wall


@pytest.mark.slow
def test_another_poisson_ratio_shows(one_wall, monkeypatch):
    monkeypatch.setattr(stale, "RECIPE", replace(RECIPE, poisson_ratio=0.4899))
    assert stale.solid_fingerprint() != one_wall


@pytest.mark.slow
def test_another_mesh_shows(one_wall, monkeypatch):
    monkeypatch.setattr(mesh, "_ARC_CELLS", (26, 48))
    assert stale.solid_fingerprint() != one_wall


@pytest.mark.slow
def test_what_does_not_change_the_solid_does_not_show(one_wall, monkeypatch):
    monkeypatch.setattr(stale, "RECIPE", replace(RECIPE, folds=12, walls=9))
    assert stale.solid_fingerprint() == one_wall


def test_recipes_survive_their_text_and_are_told_apart():
    assert AtlasRecipe.from_text(RECIPE.text()) == RECIPE
    fingerprint = stale.survey_fingerprint(RECIPE)
    assert stale.survey_fingerprint(replace(RECIPE, walls=28)) != fingerprint
    # How the answers are held asks the solid nothing new.
    assert stale.survey_fingerprint(replace(RECIPE, volume_cells=30)) == fingerprint
