"""Each rule fires on a part made to break it, and none is an error on the shipped designs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from pneutouch.errors import RuleBrokenError
from pneutouch.pipeline.build import refuse
from pneutouch.printability import check
from pneutouch.printability.check import RULES
from pneutouch.printability.rules import contact_faces, walls


def severities(evaluation, rule):
    return [finding.severity for finding in evaluation.findings if finding.rule == rule]


def test_no_shipped_design_breaks_a_rule(library, evaluated):
    for name in library.shelf("designs"):
        assert "error" not in [finding.severity for finding in evaluated(name).findings], name


def test_a_thin_wall_is_an_error_and_a_thinnish_one_a_warning(evaluated):
    assert (
        severities(
            evaluated("paper-dome", "membrane.wall_thickness_mm=0.5", "pneumatics.driving_pressures_kPa=[0]"), "walls"
        )[0]
        == "error"
    )
    thin = evaluated("stiff-dome", "membrane.wall_thickness_mm=0.8")
    assert "warning" in severities(thin, "walls")
    assert "error" not in severities(thin, "walls")


def test_a_wall_finding_says_what_where_how_far_and_why(evaluated):
    finding = evaluated(
        "paper-dome", "membrane.wall_thickness_mm=0.5", "pneumatics.driving_pressures_kPa=[0]"
    ).findings[0]
    document = finding.document()
    assert "0.50 mm" in document["message"]
    assert "0.6 mm" in document["message"]
    assert document["where_mm"] == [0.0, 0.0, 9.75]
    assert "membrane.wall_thickness_mm" in document["fix"]
    assert "vendor" in document["source"]


def test_a_small_bore_fires(evaluated):
    evaluation = evaluated("paper-dome")
    small = evaluation.scene.port.model_copy(update={"bore_diameter": 0.5})
    assembly = replace(evaluation.assembly, scene=replace(evaluation.scene, port=small))
    assert any("0.5 mm" in finding.message for finding in RULES["holes"](assembly, evaluation.prediction))
    polyjet = evaluated("stiff-dome")
    tiny = replace(polyjet.assembly, scene=replace(polyjet.scene, port=small))
    assert RULES["holes"](tiny, polyjet.prediction)[0].severity == "error"


def test_overlapping_and_parted_bodies_fire(evaluated):
    import numpy as np

    evaluation = evaluated("paper-dome")
    membrane, connector = evaluation.assembly.bodies

    class Moved:
        def __init__(self, shift):
            self.bodies = (membrane.moved(np.array([0.0, 0.0, shift])), connector)
            self.layout, self.solids = evaluation.assembly.layout, evaluation.assembly.solids

    overlap = contact_faces.check(Moved(-0.2), evaluation.prediction)
    assert overlap[0].severity == "error"
    assert "overlap" in overlap[0].message
    parted = contact_faces.check(Moved(0.2), evaluation.prediction)
    assert "share" in parted[0].message


def test_driving_near_and_beyond_a_limit_fires(evaluated):
    assert severities(evaluated("paper-dome", "pneumatics.driving_pressures_kPa=[0, 38]"), "driving") == ["warning"]
    beyond = evaluated("stiff-dome", "pneumatics.driving_pressures_kPa=[0, 120]")
    assert severities(beyond, "driving") == ["error"]
    with pytest.raises(RuleBrokenError, match="gauge range"):
        refuse(beyond)


def test_a_long_bore_is_hard_to_clean(evaluated):
    evaluation = evaluated("stiff-dome")
    long = evaluation.scene.port.model_copy(update={"stem_length": 20.0})
    assembly = replace(evaluation.assembly, scene=replace(evaluation.scene, port=long))
    assert RULES["cleaning"](assembly, evaluation.prediction)[0].severity == "warning"


def test_findings_come_errors_first(evaluated):
    found = check(
        *(getattr(evaluated("stiff-dome", "membrane.wall_thickness_mm=0.5"), key) for key in ("assembly", "prediction"))
    )
    order = [finding.severity for finding in found]
    assert order == sorted(order, key=["error", "warning", "note"].index)
    assert walls.check in RULES.values()
