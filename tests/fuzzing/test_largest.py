"""The largest input of each reader takes as much memory as docs/background/hardening.md states."""

from __future__ import annotations

import sys

import pytest
from benchmarks.store import stored

from tests.fuzzing.largest import CASES, measured
from tests.fuzzing.targets import TARGETS

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="the peak of a process is read from /proc"),
]

SHARE, FIXED = 1.5, 64.0
"""Of the stored memory; and MiB, since allocators differ between systems."""

KNOWN = {(name, case.words): case for name, cases in CASES.items() for case in cases}


@pytest.mark.parametrize("row", stored("largest-inputs"), ids=lambda row: f"{row['reader']}, {row['input']}")
def test_the_largest_input_takes_no_more_memory_than_stated(row, tmp_path):
    case = KNOWN[row["reader"], row["input"]]
    if library := TARGETS[case.target].library:
        pytest.importorskip(library)
    found = measured(case, tmp_path)
    assert found["bytes"] == pytest.approx(row["bytes"], rel=0.02)
    assert ("refused" if found["refusal"] else "read") == row["outcome"], found["refusal"]
    assert found["mebibytes"] <= SHARE * row["mebibytes"] + FIXED


def test_every_stated_input_is_measured():
    assert {(row["reader"], row["input"]) for row in stored("largest-inputs")} == set(KNOWN)
