"""docs/howto/printing.md: its design builds, its commands run, and its tables name what there is."""

from __future__ import annotations

import re
import shlex

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.parts import assemble
from pneutouch.printability.rulebook import RULES
from tests.conftest import ROOT

TEXT = (ROOT / "docs/howto/printing.md").read_text(encoding="utf-8")


def test_the_design_of_the_page_can_be_drawn(library, tmp_path):
    path = tmp_path / "page.toml"
    path.write_text(re.search(r"```toml\n(.*?)```", TEXT, re.DOTALL)[1])
    assembly = assemble(load_scene(str(path), None, library))
    assert [solid.name for solid in assembly.solids] == ["membrane", "connector", "ring"]


def test_the_tables_name_every_part_and_every_rule(library):
    for kind in ("ports", "seats", "mounts"):
        for name in library.paths(kind):
            assert f"`{name}`" in TEXT or f"`-{name.rsplit('-', 1)[1]}`" in TEXT, name
    table = TEXT.partition("| rule | checks |")[2].partition("\n\n")[0]
    named = {word.strip() for line in re.findall(r"^\| ([a-z, ]+) \|", table, re.MULTILINE) for word in line.split(",")}
    assert named == set(RULES)


@pytest.mark.slow
def test_the_commands_of_the_page_run(command):
    for line in re.search(r"```sh\n(.*?)```", TEXT, re.DOTALL)[1].splitlines():
        result = command(*shlex.split(line, comments=True)[1:])
        assert result.returncode == 0, result.stderr
