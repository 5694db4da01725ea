"""Every print rule has a text, and a picture of a good and of a bad case that are what the rule finds today."""

from __future__ import annotations

import ast
import json
import shutil
from functools import cache

import pytest
from pictures.rules import EXHIBITS
from pictures.rules.draw import FOLDER, RECORD, SIDES, picture, picture_name, recorded
from reference_pages import rules
from reference_pages.markdown import cell, plain

from tests.conftest import ROOT

NAMES = rules.NAMES
EVERYDAY = ("contact faces", "envelope", "resins", "edges", "gaps", "voxels")
"""Rules whose cases are made in a third of a second; the others are slow together."""

STORED = json.loads(RECORD.read_text(encoding="utf-8"))


@cache
def page():
    return rules.page()


def test_every_rule_has_its_cases_and_both_pictures():
    assert set(EXHIBITS) == set(STORED) == set(NAMES)
    pictures = {picture_name(rule, side) for rule in NAMES for side in SIDES}
    assert {path.name for path in FOLDER.iterdir()} == {*pictures, RECORD.name}


def test_no_finding_in_the_package_has_the_name_of_another_rule():
    """Names that are written out where a finding is made."""
    named = set()
    for path in (ROOT / "generator/pneutouch/printability").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Finding":
                first = node.args[0]
                named |= {first.value} if isinstance(first, ast.Constant) else set()
    assert len(named) > 10
    assert named <= set(NAMES)


@pytest.mark.parametrize("rule", NAMES)
def test_the_good_case_passes_and_the_bad_one_is_reported_on_the_page(rule):
    good, bad = (STORED[rule][side]["findings"] for side in SIDES)
    assert bad and all(finding["rule"] == rule for finding in [*good, *bad])
    # Of a mix or a bubble a note is made of every case; nothing worse of a good one.
    assert {finding["severity"] for finding in good} <= {"note"}
    assert not good or any(finding["severity"] != "note" for finding in bad)
    text = page().partition(f"\n### {rule}\n")[2].partition("\n### ")[0]
    assert "If it is broken: " in text
    for finding in bad:
        assert all(cell(plain(finding[key])) in text for key in ("message", "fix", "source"))


@pytest.mark.parametrize("missing", ["walls-bad.svg", "release-good.svg"])
def test_a_rule_without_a_picture_makes_no_page(missing, tmp_path, monkeypatch):
    shutil.copytree(FOLDER, tmp_path / "rules")
    monkeypatch.setattr(rules, "PICTURES", tmp_path / "rules")
    assert rules.page().startswith("# Print rules")
    (tmp_path / "rules" / missing).unlink()
    with pytest.raises(FileNotFoundError, match=missing):
        rules.page()


def test_every_limit_of_a_size_states_its_source():
    text = page()
    for printer in rules.printers().values():
        for limit in set(rules._LIMITS.values()):
            for _, size in rules._sizes(printer, limit):
                assert cell(plain(size.source)) in text


@pytest.mark.parametrize("rule", [r if r in EVERYDAY else pytest.param(r, marks=pytest.mark.slow) for r in NAMES])
def test_findings_and_pictures_are_what_the_code_gives_today(rule):
    for side, case in zip(SIDES, EXHIBITS[rule](), strict=True):
        assert json.loads(json.dumps(recorded(case))) == STORED[rule][side], f"{rule}: make rule-pictures"
        assert picture(case, side) + "\n" == (FOLDER / picture_name(rule, side)).read_text(encoding="utf-8"), rule
