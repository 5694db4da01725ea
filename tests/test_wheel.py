"""The wheel carries all that a user without a checkout needs, and works from there."""

from __future__ import annotations

import subprocess
import sys
import zipfile

import pytest

from tests.conftest import ROOT


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site")
    return folder / "site"


def test_designs_profiles_parts_templates_and_fonts_are_inside(unpacked):
    for name in (
        "data/designs/paper-dome.toml",
        "data/printprofiles/objet260-connex.toml",
        "data/printprofiles/materials/FLX9960.toml",
        "parts/ports/barb-4x2.5.toml",
        "report/templates/datasheet.typ",
        "parts/lettering/fonts/Inter-Regular.otf",
        "parts/lettering/fonts/OFL.txt",
    ):
        assert (unpacked / "pneutouch" / name).is_file(), name


def test_the_installed_package_predicts_without_the_checkout(unpacked, tmp_path):
    code = (
        f"import sys; sys.path.insert(0, {str(unpacked)!r}); import pneutouch\n"
        f"assert pneutouch.__file__.startswith({str(unpacked)!r})\n"
        "from pneutouch.evaluation import evaluate\n"
        "e = evaluate('paper-dome'); assert e.scene.where.startswith(sys.path[0]), e.scene.where\n"
        "print(round(1e3 * e.prediction.limit_point.driving_pressure, 2))"
    )
    result = subprocess.run(
        [sys.executable, "-I", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert result.stdout.strip() == "39.59", result.stderr
