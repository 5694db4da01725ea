"""A small stack of voxels that several files read."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from pneutouch.workflows.build_voxels import plan_voxels, write_voxels
from tests.export.voxels.small import small_assembly


@pytest.fixture(scope="session")
def written(tmp_path_factory, library):
    plan = plan_voxels(small_assembly(), mode="High Mix", library=library)
    folder, notes = write_voxels(plan, tmp_path_factory.mktemp("stack"), "abc")
    assert notes == []
    return plan, folder


@pytest.fixture
def stack(written, tmp_path):
    return Path(shutil.copytree(written[1], tmp_path / "graded-dome-voxels"))
