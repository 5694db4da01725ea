"""Pages of the documentation are run as a reader types them: ``python -m tests.pages [PAGE...] [--write]``.

A ``console`` block holds lines ``$ command``, each with its output below it, stdout and stderr as a terminal of 160 columns keeps them.
A line ``...`` stands for any number of lines, ``...`` inside a line for any text. In a tutorial ``python`` blocks are run as well, in one
namespace; a ``text`` block that follows one at once is what it prints. A page starts in an empty folder, which is the user's folder.
``--write`` renews what is shown and keeps what is left out.
"""

from __future__ import annotations

import argparse
import contextlib
import difflib
import itertools
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from unittest import mock

from tests.running import captured_together, on_a_terminal

DOCS = Path(__file__).resolve().parents[1] / "docs"
TUTORIALS = DOCS / "tutorials"
COLUMNS = 160
_LEFT_OUT = "..."
_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_SIMILAR = 0.5
"""Least share of a line (difflib's ratio) by which a changed line is taken for the one that was shown."""


@dataclass(frozen=True)
class Block:
    """A fenced block of a page: its language, its text, where the text stands, and whether it follows the block before at once."""

    language: str
    text: str
    start: int
    adjoins: bool


@dataclass
class Step:
    """One command or piece of Python of a page with what the page shows of its output."""

    run: Callable[[Path], str]
    name: str
    shown: list[str]
    span: tuple[int, int]
    """Of the shown output in the page's text."""
    said: list[str] = field(default_factory=list)

    @property
    def is_kept(self) -> bool:
        """Whether the page shows what was said."""
        return matches(self.shown, self.said)


def fenced(text: str) -> list[Block]:
    """The blocks of a page, in order."""
    found, end = [], -1
    for block in _FENCE.finditer(text):
        found.append(Block(block[1], block[2], block.start(2), end >= 0 and not text[end : block.start()].strip()))
        end = block.end()
    return found


def blocks(text: str, language: str) -> list[str]:
    """The texts of all blocks in a language."""
    return [block.text for block in fenced(text) if block.language == language]


def pages() -> list[Path]:
    """All pages with something to run: those with a console block, and the tutorials."""
    paths = sorted(DOCS.rglob("*.md"))
    return [path for path in paths if steps(path)]


def steps(path: Path) -> list[Step]:
    """What a page runs, in order."""
    text, names = path.read_text(encoding="utf-8"), {"__name__": "__main__"}
    found: list[Step] = []
    python: Block | None = None
    for block in fenced(text):
        if block.language == "console":
            found += _commands(block)
        elif block.language == "python" and path.is_relative_to(TUTORIALS):
            found.append(_piece(block, names, path.name))
        elif block.language == "text" and block.adjoins and python is not None:
            found[-1].shown = block.text.splitlines()
            found[-1].span = (block.start, block.start + len(block.text))
        python = block if block.language == "python" and path.is_relative_to(TUTORIALS) else None
    return found


def _commands(block: Block) -> Iterator[Step]:
    for part in re.finditer(r"^\$ (.*(?:\\\n.*)*)\n((?:(?!\$ ).*\n)*)", block.text, re.MULTILINE):
        line = part[1]
        yield Step(
            lambda folder, line=line: typed(line, folder),
            line,
            part[2].splitlines(),
            (block.start + part.start(2), block.start + part.end(2)),
        )


def _piece(block: Block, names: dict[str, object], page: str) -> Step:
    def run(folder: Path) -> str:
        with contextlib.chdir(folder), captured_together() as out:
            exec(compile(block.text, page, "exec"), names)
        return out.getvalue().decode()

    end = block.start + len(block.text)
    return Step(run, block.text.splitlines()[0], [], (end, end))


def typed(line: str, folder: Path) -> str:
    """What a terminal keeps of a command; one that is not ``pneutouch`` alone is the shell's. Raises AssertionError where it fails."""
    words = shlex.split(line.replace("\\\n", " "), comments=True)
    if words[0] == "pneutouch" and not {"|", ">", ";", "&&"} & set(words):
        code, text = on_a_terminal(words[1:], folder, COLUMNS)
    else:
        done = subprocess.run(
            line, shell=True, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
        )
        code, text = done.returncode, done.stdout
    # That no design meets a target is an answer.
    assert code == 0 or (code == 1 and words[:2] == ["pneutouch", "select"]), f"{line}: exit code {code}\n{text}"
    return text


def matches(shown: list[str], said: list[str]) -> bool:
    """Whether what is shown is what was said, but for what is left out."""
    pattern = "".join(
        r"(?:.*\n)*?" if line == _LEFT_OUT else ".*".join(map(re.escape, line.split(_LEFT_OUT))) + "\n"
        for line in shown
    )
    return re.fullmatch(pattern, "".join(f"{line}\n" for line in said)) is not None


def renewed(shown: list[str], said: list[str]) -> list[str]:
    """What was said, with that part left out that was left out before."""
    if matches(shown, said):
        return shown
    if not any(_LEFT_OUT in line for line in shown):
        return said
    kept: list[str] = []
    place = 0
    for line in shown:
        if line == _LEFT_OUT:
            kept.append(line)
            continue
        head, cut, _ = line.partition(_LEFT_OUT)
        ratios = [(_ratio(head, other[: len(head)] if cut else other), -k) for k, other in enumerate(said[place:])]
        ratio, back = max(ratios, default=(0.0, 0))
        if ratio < _SIMILAR:
            kept.append(_LEFT_OUT)
            continue
        if back < 0:
            kept.append(_LEFT_OUT)
        there = said[place - back]
        kept.append(there[: len(head)] + _LEFT_OUT if cut else there)
        place += 1 - back
    if place < len(said):
        kept.append(_LEFT_OUT)
    return [line for line, _ in itertools.groupby(kept) if line == _LEFT_OUT or line in kept]


def _ratio(one: str, other: str) -> float:
    return difflib.SequenceMatcher(None, one, other, autojunk=False).ratio()


def walk(path: Path, folder: Path) -> list[Step]:
    """Run a page in an empty folder; the steps with what each of them said."""
    home = {"PNEUTOUCH_HOME": ".", "COLUMNS": str(COLUMNS), "NO_COLOR": "1"}
    run = steps(path)
    with mock.patch.dict(os.environ, home), mock.patch.object(sys, "path", [str(folder), *sys.path]):
        for step in run:
            step.said = [line.rstrip() for line in step.run(folder).splitlines()]
    return run


def write(path: Path, run: list[Step]) -> None:
    """Put what was said into the page, from its end to its beginning; the page may have changed outside of its steps meanwhile."""
    text, now = path.read_text(encoding="utf-8"), steps(path)
    if [step.name for step in now] != [step.name for step in run]:
        raise ValueError(f"{path}: its steps were changed while it was run")
    for step, ran in zip(reversed(now), reversed(run), strict=True):
        if step.span[0] < step.span[1] or ran.said:
            lines = renewed(step.shown, ran.said)
            text = text[: step.span[0]] + "".join(f"{line}\n" for line in lines) + text[step.span[1] :]
    path.write_text(text, encoding="utf-8")


def differences(run: list[Step]) -> str:
    """What the page shows otherwise than it was said; empty where nothing does."""
    wrong = [step for step in run if not step.is_kept]
    return "\n".join(
        "\n".join([f"$ {step.name}", *difflib.ndiff(step.shown, renewed(step.shown, step.said))]) for step in wrong
    )


@contextlib.contextmanager
def _folder(kept: Path | None) -> Iterator[Path]:
    """An empty folder: the one to be kept, else one that is removed."""
    if kept is not None:
        kept.mkdir(parents=True)
        yield kept.resolve()
        return
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder).resolve()


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.pages", description=__doc__.split("\n")[0])
    parser.add_argument("page", nargs="*", type=Path, help="pages; left out: all that run something")
    parser.add_argument("--write", action="store_true", help="renew what the pages show")
    parser.add_argument(
        "--keep", type=Path, metavar="DIR", help="a new folder that keeps what the pages write, by their names"
    )
    given = parser.parse_args()
    failed = 0
    for path in [each.resolve() for each in given.page] or pages():
        with _folder(given.keep and given.keep / path.stem) as folder:
            run = walk(path, folder)
        text = differences(run)
        failed |= bool(text)
        sys.stdout.write(f"{path.relative_to(DOCS)}: {len(run)} steps{', differs' if text else ''}\n{text}\n")
        if given.write:
            write(path, run)
    return int(bool(failed) and not given.write)


if __name__ == "__main__":
    raise SystemExit(main())
