"""The comparison itself: what it finds and what it lets pass."""

from __future__ import annotations

import copy
import math

import pytest

from tests.figures.compare import differences, plain

DOCUMENT = {
    "design": "paper-dome",
    "passed": True,
    "told": ["the modulus is published, not measured"],
    "states": [{"driving_pressure_kPa": 22.0, "force_N": [0.0, 1.5], "limit": None, "told": 2, "figures": ["force_N"]}],
}


def changed(*path, value):
    document = copy.deepcopy(DOCUMENT)
    *above, last = path
    holder = document
    for part in above:
        holder = holder[part]
    if value is None:
        del holder[last]
    else:
        holder[last] = value
    return document


def test_a_document_equals_itself():
    assert not list(differences(DOCUMENT, copy.deepcopy(DOCUMENT)))


@pytest.mark.parametrize(
    ("path", "value", "line"),
    [
        (("states", 0, "force_N", 1), 1.50001, "states.0.force_N.1: 1.5 before, 1.50001 now"),
        (("states", 0, "force_N", 0), 2e-7, "states.0.force_N.0: 0.0 before, 2e-07 now"),
        (("states", 0, "force_N", 1), math.nan, "states.0.force_N.1: 1.5 before, nan now"),
        (("states", 0, "force_N"), [0.0], "states.0.force_N: 2 entries before, 1 now"),
        (("states", 0, "driving_pressure_kPa"), 22.0002, "states.0.driving_pressure_kPa: 22.0 before, 22.0002 now"),
        (("states", 0, "limit"), 0.0, "states.0.limit: None before, 0.0 now"),
        (("states", 0, "told"), None, "states.0.told: 2 before, not there now"),
        (("states", 0, "more"), 3, "states.0.more: not there before, 3 now"),
        (("passed",), 1, "passed: True before, 1 now"),
        (("design",), "soft-pad", "design: 'paper-dome' before, 'soft-pad' now"),
        (("told", 0), "nothing", "told.0: 'the modulus is published, not measured' before, 'nothing' now"),
    ],
)
def test_a_change_is_found(path, value, line):
    assert list(differences(DOCUMENT, changed(*path, value=value))) == [line]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("states", 0, "force_N", 1), 1.5 * (1 + 2e-6)),
        (("states", 0, "force_N", 0), 1e-7),
        (("states", 0, "driving_pressure_kPa"), 22.00005),
        (("told", 0), "the modulus is a published value"),
    ],
)
def test_rounding_and_other_words_are_no_change(path, value):
    assert not list(differences(DOCUMENT, changed(*path, value=value)))


@pytest.mark.parametrize(("key", "found"), [("correlation", 0), ("covariance", 0), ("residuals", 1)])
def test_the_covariance_of_a_fit_is_compared_to_fewer_digits(key, found):
    before, now = ({key: {"matrix": [[1.0, value], [value, 1.0]]}} for value in (0.05752, 0.05762))
    assert len(list(differences(before, now))) == 2 * found


def test_a_whole_number_in_a_list_is_not_true():
    assert list(differences({"passed": [True, 1]}, {"passed": [1, 1]})) == ["passed.0: True before, 1 now"]


def test_what_follows_bytes_and_versions_is_left_out():
    one = {
        "versions": {"numpy": "2.4"},
        "files": {"a.stl": {"bytes": 9, "sha256": "0" * 64}},
        "of": {"baf0a17c32cd": {"b": 1}},
    }
    other = {"versions": {}, "files": {"a.stl": {"bytes": 8, "sha256": "1" * 64}}, "of": {"be9aa6cdd3c7": {"b": 1}}}
    assert plain(one) == plain(other) == {"files": {"a.stl": {}}, "of": [{"b": 1}]}
    assert plain("/home/user/designs/paper-dome.toml") == "paper-dome.toml"
