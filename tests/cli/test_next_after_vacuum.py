"""The command that follows a build of a design with vacuum, which a campaign has not."""

from __future__ import annotations

import shlex

import pytest

from tests.running import in_process

KEY = "pneumatics.driving_pressures_kPa"


@pytest.mark.parametrize("pressures", ["[-5, -3]", "[-5, 0, 12]"])
def test_the_next_command_after_a_build_with_vacuum_works(pressures, tmp_path):
    built = in_process(["build", "paper-dome", "--set", f"{KEY}={pressures}"], tmp_path)
    assert built.returncode == 0, built.stderr
    words = shlex.split(built.stderr.rpartition("next: pneutouch ")[2])
    planned = in_process(words, tmp_path)
    assert planned.returncode == 0, planned.stderr


def test_the_remedy_for_a_plan_of_a_vacuum_works(tmp_path):
    refused = in_process(["plan", "paper-dome", "--set", f"{KEY}=[-5, -3]"], tmp_path)
    assert refused.returncode == 2
    words = shlex.split(refused.stderr[refused.stderr.index("--set '") :])[:2]
    planned = in_process(["plan", "paper-dome", *words], tmp_path)
    assert planned.returncode == 0, planned.stderr
