"""Wheel and source archive hold all that a user without a checkout needs, nothing private, and work from there."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import tomllib
import zipfile

import pytest

from tests.conftest import ROOT
from tests.packaging import copied, packed, tracked

SHIPPED = ("designs", "printprofiles", "docs/examples")


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    return copied(tmp_path_factory.mktemp("checkout"), "generator", "README.md", "LICENSE", "pyproject.toml", *SHIPPED)


@pytest.fixture(scope="module")
def unpacked(checkout, tmp_path_factory):
    wheel = packed(checkout, "wheel", tmp_path_factory.mktemp("wheel"))
    site = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    return site


def listed():
    return tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["pneutouch"]["shipped"]


def test_the_list_of_shipped_files_is_what_git_knows():
    assert listed() == sorted(tracked(*SHIPPED))


def test_the_wheel_holds_the_shipped_files_and_nothing_private(unpacked):
    data = unpacked / "pneutouch/data"
    assert sorted(p.relative_to(data).as_posix() for p in data.rglob("*") if p.is_file()) == listed()
    code = {p.relative_to(unpacked).as_posix() for p in (unpacked / "pneutouch").rglob("*") if data not in p.parents}
    known = {name.removeprefix("generator/") for name in tracked("generator/pneutouch")}
    assert {name for name in code if (unpacked / name).is_file()} == known
    assert not list(unpacked.rglob("*private*"))


def run(unpacked, folder, code):
    """Run code that sees the unpacked wheel and not the checkout."""
    head = f"import sys; sys.path.insert(0, {str(unpacked)!r}); import pneutouch\nassert pneutouch.__file__.startswith({str(unpacked)!r})\n"
    words = [sys.executable, "-I", "-c", head + code]
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)


def test_the_installed_package_predicts_without_the_checkout(unpacked, tmp_path):
    code = (
        "from pneutouch.evaluation import evaluate\n"
        "e = evaluate('paper-dome'); assert e.scene.where.startswith(sys.path[0]), e.scene.where\n"
        "print(round(1e3 * e.prediction.limit_point.driving_pressure, 2))"
    )
    result = run(unpacked, tmp_path, code)
    assert result.stdout.strip() == "39.59", result.stderr


def test_every_example_that_the_docs_name_is_reached_from_the_installed_package(unpacked, tmp_path):
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    named = {name for page in pages for name in re.findall(r"new .*?--from ([\w-]+)", page.read_text(encoding="utf-8"))}
    # A design that a page has made before is the reader's own.
    named = {name for name in named if not name.startswith("my-")}
    assert {"fingertip", "seven-resins", "wall-and-resin", "campaign"} <= named
    code = (
        "from pneutouch.output.new import new_from\n"
        f"for made in (new_from(name, f'my-{{name}}') for name in {sorted(named)!r}): print(made.path, *made.command)"
    )
    result = run(unpacked, tmp_path, code)
    assert result.returncode == 0, result.stderr
    for line in result.stdout.splitlines():
        path, *command = line.split()
        assert (tmp_path / path).is_file(), line
        # What copies a profile has no file in its next command.
        assert command[:1] in ([], ["check"]) or (tmp_path / command[1]).exists(), line


def test_no_page_names_an_example_by_its_place_in_the_checkout():
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))):
        assert "docs/examples" not in page.read_text(encoding="utf-8"), page


PATH = [
    "select",
    "select",
    "check",
    "build",
    "plan",
    "simulate",
    "characterize",
    "calibrate",
    "compare",
    "export-reader",
]
"""From a target to a reader of a sensor that is measured and calibrated; the second `select` saves the design."""


@pytest.mark.slow
def test_a_target_leads_to_the_reader_of_a_calibrated_sensor_by_typing_what_each_command_prints(unpacked, tmp_path):
    words, typed = shlex.split("pneutouch select --sensitivity 3 --at 10 --fits finger:20"), []
    while words:
        assert words[0] == "pneutouch", words
        result = run(unpacked, tmp_path, f"from pneutouch.cli import run; sys.argv = {words!r}; run()")
        assert result.returncode == 0, (words, result.stderr)
        typed.append(words[1])
        said = result.stderr.splitlines()
        words = shlex.split(said[-1].removeprefix("next: ")) if said and said[-1].startswith("next: ") else []
    assert typed == PATH
    (calibration,) = (tmp_path / "calibrations").glob("*.toml")
    compared = json.loads(next((tmp_path / "outputs").glob("compare-*/comparison.json")).read_text())
    designed, calibrated = compared["compared"]
    assert calibrated["label"].endswith(f"@{calibration.stem}")
    assert designed["label"] == calibrated["label"].split("@")[0]
