"""What the pages of the documentation show is what their commands say today."""

from __future__ import annotations

import pytest

from tests import pages
from tests.pages import DOCS, TUTORIALS, blocks, differences, matches, renewed, steps, walk, write

CHEAP = ("howto/tray.md",)
"""Pages that take about five seconds; the others are slow."""

PAGES = [path.relative_to(DOCS).as_posix() for path in pages.pages()]


@pytest.mark.parametrize("name", [n if n in CHEAP else pytest.param(n, marks=pytest.mark.slow) for n in PAGES])
def test_a_page_shows_what_its_commands_say(name, tmp_path):
    run = walk(DOCS / name, tmp_path)
    assert run
    assert differences(run) == "", f"python -m tests.pages docs/{name} --write renews the page"


def test_cheap_pages_are_pages_that_run_something():
    assert set(CHEAP) <= set(PAGES)


@pytest.mark.parametrize(
    ("shown", "said", "alike"),
    [
        (["a"], ["a"], True),
        (["a"], ["a", "b"], False),
        (["a", "..."], ["a"], True),
        (["...", "b"], ["a", "b"], True),
        (["a", "...", "d"], ["a", "b", "c", "d"], True),
        (["a", "...", "d"], ["a", "b", "c"], False),
        (["a ... c"], ["a bb c"], True),
        (["a ... c"], ["a bb d"], False),
        (["a.c"], ["abc"], False),
        ([], [], True),
    ],
)
def test_what_is_left_out_may_be_anything_and_nothing_else_may(shown, said, alike):
    assert matches(shown, said) is alike
    assert matches(renewed(shown, said), said)


def test_renewing_keeps_what_is_left_out():
    said = ["first row  1.25", "second row  7", "third row  2.5", "written: x", "next: y"]
    assert renewed(["first row  1.20", "...", "next: y"], said) == ["first row  1.25", "...", "next: y"]
    assert renewed(["first row ...", "next: z"], said) == ["first row ...", "...", "next: y"]
    assert renewed(["first row  1.20"], said) == said
    assert renewed(["...", "gone entirely", "written: x"], said) == ["...", "written: x", "..."]


def test_a_page_is_run_in_order_and_written(tmp_path, monkeypatch):
    page = tmp_path / "tutorials" / "page.md"
    page.parent.mkdir()
    page.write_text(
        "```console\n$ echo one > file\n$ cat file\nold\n```\n\n```python\nx = 2\n```\n\nand\n\n"
        "```python\nfrom pathlib import Path\nprint(x + 1, Path('file').read_text())\n```\n\n```text\nold\n```\n\n```text\nnot an output\n```\n"
    )
    monkeypatch.setattr(pages, "TUTORIALS", page.parent)
    (tmp_path / "run").mkdir()
    run = walk(page, tmp_path / "run")
    assert [step.is_kept for step in run] == [True, False, True, False]
    write(page, run)
    text = page.read_text()
    assert "$ cat file\none\n```" in text and "```text\n3 one\n\n```" in text and "not an output" in text
    (tmp_path / "again").mkdir()
    assert differences(walk(page, tmp_path / "again")) == ""


def test_a_command_that_fails_stops_the_page(tmp_path):
    with pytest.raises(AssertionError, match="exit code 2"):
        pages.typed("pneutouch predict no-such-design", tmp_path)


def test_a_terminal_shows_wrapped_lines_and_no_stages(tmp_path):
    said = pages.typed("pneutouch check paper-dome", tmp_path)
    assert " ...\n" not in said and "\x1b" not in said
    assert said.splitlines()[-1].startswith("next: ")
    assert max(len(line) for line in said.splitlines() if not line.startswith("next")) <= pages.COLUMNS


def test_every_tutorial_runs_something():
    for path in sorted(TUTORIALS.glob("*.md")):
        assert path.name == "index.md" or steps(path), path.name


def test_no_console_block_is_without_a_command():
    for path in sorted(DOCS.rglob("*.md")):
        text = path.read_text(encoding="utf-8")
        assert all(block.startswith("$ ") for block in blocks(text, "console")), path
