"""The gallery: enough examples, each with title, picture and design, by the public interface alone; every design builds."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
GALLERY = ROOT / "docs" / "gallery"
EXAMPLES = sorted(GALLERY.rglob("plot_*.py"))
LEAST = 24

each = pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)


def test_there_are_enough_examples_each_in_a_titled_group():
    assert len(EXAMPLES) >= LEAST
    assert len({path.stem for path in EXAMPLES}) == len(EXAMPLES)
    for folder in {path.parent for path in EXAMPLES}:
        assert re.match(r"\S.+\n(-+)\n\n\S", (folder / "README.rst").read_text(encoding="utf-8"))


def test_the_site_orders_every_group():
    conf = (ROOT / "docs" / "conf.py").read_text(encoding="utf-8")
    order = re.search(r"for name in \((.+?)\)", conf)
    assert order is not None
    assert {*re.findall(r'"(\w+)"', order[1])} == {path.parent.name for path in GALLERY.glob("*/README.rst")}


@each
def test_an_example_has_title_picture_and_design(example):
    text = example.read_text(encoding="utf-8")
    title, line, _, *story = (ast.get_docstring(ast.parse(text)) or "").splitlines()
    assert title.endswith("?")
    assert line == "=" * len(title)
    assert story
    assert len(text.splitlines()) <= 70
    assert "print(" in text
    for axis in ("x", "y"):
        labels = re.findall(rf'{axis}label\w*(?:=|\()f?"([^"]+)"', text)
        assert labels or "plot_section" in text or "plot_mould" in text
    names = {
        node.id
        for part in ast.parse(text).body
        if isinstance(part, ast.Assign)
        for target in part.targets
        for node in ast.walk(target)
        if isinstance(node, ast.Name)
    }
    assert names & {"design", "designs"}


@each
def test_an_example_uses_the_public_interface_alone_and_names_no_path(example):
    text = example.read_text(encoding="utf-8")
    tree = ast.parse(text)
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
    packages = {alias.name for node in imports if isinstance(node, ast.Import) for alias in node.names}
    packages |= {node.module or "" for node in imports if isinstance(node, ast.ImportFrom)}
    assert "pneutouch" in packages
    assert not [name for name in packages if name.startswith("pneutouch.")]
    assert not re.search(r"\bpt\._|\.(_[a-z]|assembly|evaluation)\b", text)
    strings = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    assert not [value for value in strings if re.match(r"(/|~|[A-Za-z]:\\)\w", value)]


def designs_of(example: Path, folder: Path) -> str:
    """Run an example in an empty folder, save its designs there and return the names that it saved."""
    code = (
        "import runpy, sys\n"
        "import matplotlib; matplotlib.use('agg')\n"
        "from matplotlib import pyplot\n"
        "names = runpy.run_path(sys.argv[1])\n"
        "assert len(pyplot.get_fignums()) == 1, 'one picture'\n"
        "designs = names.get('designs') or [names['design']]\n"
        "saved = sys.argv[2]\n"
        "for k, design in enumerate(designs): design.save(f'{saved}/example-{k}.toml')\n"
    )
    saved, empty = folder / "designs", folder / "empty"
    saved.mkdir(), empty.mkdir()
    paths = os.pathsep.join([str(ROOT / "generator"), os.environ.get("PYTHONPATH", "")])
    env = {**os.environ, "PNEUTOUCH_HOME": str(folder / "home"), "PYTHONPATH": paths}
    command = [sys.executable, "-W", "error::UserWarning", "-c", code, str(example), str(saved)]
    ran = subprocess.run(command, cwd=empty, env=env, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.strip()
    assert not [*empty.iterdir()], "an example leaves files behind"
    assert not (folder / "home").exists(), "an example leaves files in the user's folder"
    return "\n".join(sorted(path.name for path in saved.iterdir()))


@pytest.mark.slow
def test_every_example_runs_leaves_nothing_behind_and_its_designs_build(tmp_path):
    """Designs that several examples share are built once."""
    import pneutouch as pt

    unlike: dict[str, pt.Design] = {}
    for example in EXAMPLES:
        folder = tmp_path / example.stem
        folder.mkdir()
        assert designs_of(example, folder)
        for file in sorted((folder / "designs").iterdir()):
            design = pt.load(file)
            unlike.setdefault(str(design.to_dict()), design)
    assert len(unlike) >= 6
    for number, design in enumerate(unlike.values()):
        built = design.build(tmp_path / f"built-{number}")
        assert (built / f"{design.name}.3mf").stat().st_size > 0, design.name
