"""The driver of the fuzzing, but for atheris itself: processor time, counts, and which inputs are kept."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys

import pytest

from tests.fuzzing import keep as keeping
from tests.fuzzing.__main__ import NESTED, counts, shares
from tests.fuzzing.place import ROOT
from tests.fuzzing.targets import TARGETS

LOG = """INFO: Seed: 1
#1\tNEW    cov: 60 ft: 70 corp: 1/1kb exec/s: 0 rss: 100Mb
#2\tINITED cov: 100 ft: 130 corp: 2/3kb exec/s: 0 rss: 100Mb
#64\tpulse  cov: 120 ft: 170 corp: 4/9kb lim: 4096 exec/s: 32 rss: 100Mb
#90\tREDUCE cov: 121 ft: 171 corp: 4/8kb lim: 4096 exec/s: 30 rss: 100Mb L: 12/4096 MS: 1 Custom-
"""


def test_all_share_the_time_and_nested_formats_have_three_times_as_much():
    assert set(NESTED) < set(TARGETS)
    parts = shares(list(TARGETS), 3600.0)
    assert set(parts) == set(TARGETS) and sum(parts.values()) == pytest.approx(3600)
    assert parts["threemf"] == pytest.approx(3 * parts["design"])
    assert list(parts.values()) == sorted(parts.values(), reverse=True)


def test_counts_are_those_of_the_first_and_of_the_last_line(tmp_path):
    assert counts(tmp_path)["runs"] == 0
    (tmp_path / "log").write_text(LOG)
    (tmp_path / "count.json").write_text(json.dumps({"runs": 90, "seconds": 3.0, "ended": 1}))
    (tmp_path / "findings.jsonl").write_text('{"where": "KeyError x.py:3", "words": "a"}\n')
    (tmp_path / "crash-1").write_bytes(b"")
    found = counts(tmp_path)
    assert (found["edges"], found["features"], found["runs"]) == ([100, 121], [130, 171], 90)
    assert found["findings"] == ["KeyError x.py:3: a", "crash-1"]


def test_the_smallest_inputs_that_reach_new_code_are_kept_and_the_old_ones_stay(tmp_path, monkeypatch):
    monkeypatch.setattr(keeping, "CORPUS", tmp_path)
    (tmp_path / "tasks-csv").mkdir()
    (tmp_path / "tasks-csv" / "old").write_bytes(b"")
    empty, rows = b"name\n\n\n", b"force_range_N\n" + b"15\n" * 51
    kept = keeping.keep("tasks-csv", [rows + b"15\n", rows, empty, b""])
    assert b"" in kept and rows in kept and rows + b"15\n" not in kept
    assert (tmp_path / "tasks-csv" / "old").is_file()
    assert {path.read_bytes() for path in (tmp_path / "tasks-csv").iterdir()} == set(kept)
    assert keeping.keep("tasks-csv", [rows + b"15\n"]) == [
        path.read_bytes() for path in sorted((tmp_path / "tasks-csv").iterdir())
    ]


@pytest.mark.skipif(importlib.util.find_spec("atheris") is not None, reason="atheris is installed")
def test_without_atheris_the_driver_states_what_to_install():
    done = subprocess.run([sys.executable, "-m", "tests.fuzzing", "head"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 2 and "pip install atheris" in done.stderr
