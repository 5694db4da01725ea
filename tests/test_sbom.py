"""The list of dependencies holds what the lock file holds, each reference leads somewhere, and it repeats to the byte."""

from __future__ import annotations

import json
import re

import pytest
from release.sbom import LOCK, document, licences, locked, main


def test_every_locked_version_and_hash_is_listed():
    text = LOCK.read_text()
    content = document()
    listed = {(one["name"], one["version"]) for one in content["components"]}
    assert listed == set(re.findall(r"^([a-z0-9._-]+)==(\S+)", text, re.M))
    hashes = [each["content"] for one in content["components"] for each in one["externalReferences"][0]["hashes"]]
    assert sorted(hashes) == sorted(re.findall(r"--hash=sha256:(\w+)", text))


def test_who_requires_what_leads_to_components_and_all_are_required():
    content = document()
    known = {one["bom-ref"] for one in content["components"]} | {content["metadata"]["component"]["bom-ref"]}
    assert {one["ref"] for one in content["dependencies"]} == known
    needed = {each for one in content["dependencies"] for each in one.get("dependsOn", ())}
    assert needed == known - {content["metadata"]["component"]["bom-ref"]}


def test_it_repeats_to_the_byte_and_holds_no_time(tmp_path, capsys):
    main(tmp_path / "a.json")
    main(tmp_path / "b.json")
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    content = json.loads((tmp_path / "a.json").read_text())
    assert (content["bomFormat"], content["specVersion"]) == ("CycloneDX", "1.6")
    assert not {"serialNumber", "timestamp"} & (content.keys() | content["metadata"].keys())
    assert f"{len(content['components'])} components" in capsys.readouterr().out


def test_licences_are_those_that_the_metadata_states():
    assert licences("numpy") and licences("no-such-package") == []


def test_a_line_that_is_not_understood_is_refused():
    with pytest.raises(ValueError, match="not understood: numpy"):
        locked("numpy>=2 \\")
