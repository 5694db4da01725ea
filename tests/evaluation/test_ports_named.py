"""A remedy that names a port holds: drawn with that port, the sensor has no such finding any more."""

from __future__ import annotations

import re

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.catalogue.library import PACKAGE
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.subject import subject_of
from pneutouch.output.new import PRINTED_PORT
from pneutouch.parts import assemble
from pneutouch.parts.port import port_shape
from pneutouch.printability.rules.feature_sizes import CHECKS
from pneutouch.printability.view import PrintView


def sizes(design, changes):
    """Rule and size in mm of what is too small on the connector of a design."""
    view = PrintView(subject_of(assemble(load_scene(design, changes))))
    found = [one for check in CHECKS.values() for one in check(view)]
    return {(one.rule, round(one.excess.measured, 2)) for one in found if one.body in ("connector", "plug")}


def on_connector(changes, design="paper-dome"):
    """The remedies of the findings on sizes of the connector, by rule and size in mm."""
    findings = evaluate(design, changes, model="auto" if design in ("cast-dome", "graded-dome") else "atlas").findings
    small = [one for one in findings if one.body in ("connector", "plug") and one.rule in CHECKS]
    return {(one.rule, round(one.excess.measured, 2)): one.fix for one in small}


NAMED = re.compile(r"((?:connector|print)\.\w+) = (\S+)(?: or (\S+))?")


@pytest.mark.parametrize(
    ("design", "changes", "ended"),
    [
        ("paper-dome", {}, {"connector.port"}),
        ("paper-dome", {"connector.port": "luer-female"}, {"connector.port"}),
        (
            "paper-dome",
            {"connector.material": "ClearResin", "print.connector_profile": "sla-resin"},
            {"connector.port"},
        ),
        # The screws' holes are the mount's: no port ends them, and those of a clamp nothing.
        ("fingertip-dome", {}, {"connector.port", "connector.mount"}),
        ("cast-dome", {}, {"connector.port"}),
        ("graded-dome", {}, {"connector.port"}),
        ("agilus-dome", {}, {"connector.port"}),
    ],
)
def test_every_part_that_a_remedy_names_ends_its_finding_and_no_other_is_proposed(design, changes, ended):
    fixes, keys = on_connector(changes, design), set()
    for finding, fix in fixes.items():
        named = NAMED.findall(fix)
        assert re.findall(r"(?:connector|print)\.\w+", fix) == [key for key, *_ in named]
        for key, *names in named:
            keys.add(key)
            for name in filter(None, names):
                assert finding not in sizes(design, {**changes, key: name})
    assert keys == ended


def walls(changes):
    """The remedy of the thinnest wall; empty without one."""
    return next((fix for (rule, _), fix in on_connector(changes).items() if rule == "walls"), "")


def test_ports_of_the_designs_own_tube_are_named_first():
    assert re.findall(r"connector\.port = (\S+)", walls({})) == ["push-in-4"]


def test_a_tube_that_the_design_names_goes_with_every_port_that_a_remedy_names(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    (tmp_path / "parts/ports").mkdir(parents=True)
    of_3x2 = (PACKAGE / "parts/ports/barb-3x2.toml").read_text()
    (tmp_path / "parts/ports/mine.toml").write_text(of_3x2.replace('tubes = ["3x2"]', 'tubes = ["4x3"]'))
    named = {"connector.port": "mine", "pneumatics.tube": "4x3"}
    assert re.findall(r"connector\.port = ([^,]+)", walls(named)) == ["thread-M5"]
    assert not walls({**named, "connector.port": "thread-M5"})


def test_a_port_of_the_user_that_is_not_valid_is_not_proposed_and_stops_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    (tmp_path / "parts/ports").mkdir(parents=True)
    (tmp_path / "parts/ports/a-bad-one.toml").write_text('family = "barb"\n')
    assert "a-bad-one" not in walls({})


MACHINES = {"abs-filament": "ABS", "sla-resin": "ClearResin", "objet260-connex": "VeroClear", "j735": "VeroClear"}


@pytest.mark.parametrize("profile", MACHINES)
def test_the_port_of_a_new_design_is_large_enough_for_every_printer(profile):
    made = {"print.connector_profile": profile, "connector.material": MACHINES[profile]}
    assert not sizes("paper-dome", {**made, "connector.port": PRINTED_PORT})


@pytest.mark.parametrize("port", ["barb-4x2.5", "barb-3x2", "barb-6x4"])
def test_the_least_wall_of_a_barb_is_that_of_the_drawing(port):
    scene = load_scene("paper-dome", {"connector.port": port})
    drawn = port_shape(scene.port, scene.tube, scene.hole_undersize)
    (tip, _), _ = drawn.outside[0]
    least = next(size for rule, size in sizes("paper-dome", {"connector.port": port}) if rule == "walls")
    assert least == pytest.approx(tip - drawn.hollow[0][0], abs=0.01)
