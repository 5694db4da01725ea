"""A remedy that names a port holds: drawn with that port, the sensor has no such finding any more."""

from __future__ import annotations

import re

import pytest

from pneutouch.catalogue.library import PACKAGE
from pneutouch.evaluation.evaluate import evaluate


def on_connector(changes):
    return {
        one.rule: one.fix for one in evaluate("paper-dome", changes, model="atlas").findings if one.body == "connector"
    }


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"connector.port": "luer-female"},
        {"connector.material": "ClearResin", "print.connector_profile": "sla-resin"},
    ],
)
def test_every_port_that_a_remedy_names_ends_its_finding(changes):
    fixes = on_connector(changes)
    for rule in {"walls", "channels"} & fixes.keys():
        (named,) = re.findall(r"connector\.port = (\S+) or ([^\s,]+)", fixes[rule])
        for port in named:
            assert rule not in on_connector({**changes, "connector.port": port})


def test_ports_of_the_designs_own_tube_are_named_first():
    assert re.findall(r"connector\.port = (\S+)", on_connector({})["walls"]) == ["push-in-4"]


def test_a_tube_that_the_design_names_goes_with_every_port_that_a_remedy_names(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    (tmp_path / "parts/ports").mkdir(parents=True)
    of_3x2 = (PACKAGE / "parts/ports/barb-3x2.toml").read_text()
    (tmp_path / "parts/ports/mine.toml").write_text(of_3x2.replace('tubes = ["3x2"]', 'tubes = ["4x3"]'))
    named = {"connector.port": "mine", "pneumatics.tube": "4x3"}
    assert re.findall(r"connector\.port = ([^,]+)", on_connector(named)["walls"]) == ["thread-M5"]
    assert "walls" not in on_connector({**named, "connector.port": "thread-M5"})


def test_a_port_of_the_user_that_is_not_valid_is_not_proposed_and_stops_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    (tmp_path / "parts/ports").mkdir(parents=True)
    (tmp_path / "parts/ports/a-bad-one.toml").write_text('family = "barb"\n')
    assert "a-bad-one" not in on_connector({})["walls"]
