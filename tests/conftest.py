"""Fixtures that several test files share. Builds and evaluations are kept: nobody changes them."""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from hypothesis import settings

from pneutouch.catalogue import Library
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.evaluation import Evaluation, evaluate
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.build import build
from tests.browser import FOUND, WITH_WEBGL, Pages, SharedBrowser, launched, leave_out_or_fail
from tests.running import Shared, in_new_process, in_process

ROOT = Path(__file__).resolve().parents[1]

# Tests and package are compiled once for the next run and for the processes that tests start, whatever the environment says.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
os.environ.pop("PNEUTOUCH_HOME", None)
# The workers of a run, which start with this environment, take the cores: a second thread each would wait for the others.
os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")

settings.register_profile("everyday", deadline=None, max_examples=40, derandomize=True)
settings.load_profile("everyday")

Command = Callable[..., subprocess.CompletedProcess[str]]


def pytest_collection_finish() -> None:
    """Leave what was imported and collected to the end of the run: no search for garbage goes through it again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def library() -> Library:
    return CachedLibrary((ROOT,))


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Shared:
    return Shared(tmp_path_factory)


@pytest.fixture(scope="session")
def evaluated(library: Library) -> Callable[..., Evaluation]:
    @cache
    def run(name: str, *assignments: str, model: str = "solid", closure: str = "variational") -> Evaluation:
        return evaluate(name, parse_changes(assignments), model=model, closure=closure, library=library)

    return run


@pytest.fixture(scope="session")
def built_as_a_user(shared: Shared) -> tuple[subprocess.CompletedProcess[str], Path]:
    """What ``pneutouch build paper-dome --out sensors --json`` prints in a process and folder of its own, and that folder."""
    words = ["build", "paper-dome", "--out", "sensors", "--json"]

    def fill(folder: Path) -> None:
        done = in_new_process(words, folder, {"PYTHONHASHSEED": "1"})
        (folder / "done.json").write_text(json.dumps([done.returncode, done.stdout, done.stderr]))

    folder = shared.folder("build-paper-dome", fill)
    return subprocess.CompletedProcess(words, *json.loads((folder / "done.json").read_text())), folder


@pytest.fixture(scope="session")
def built(
    request: pytest.FixtureRequest, evaluated: Callable[..., Evaluation], shared: Shared
) -> Callable[[str], Path]:
    """The output folder of a design, built once for all tests: to be read, not written. The paper's is built by a process."""

    @cache
    def run(name: str) -> Path:
        if name == "paper-dome":
            done, folder = request.getfixturevalue("built_as_a_user")
            assert done.returncode == 0, done.stderr
        else:
            folder = shared.folder(f"build-{name}", lambda fresh: build(evaluated(name), fresh / "sensors"))
        return folder / "sensors" / name

    return run


@pytest.fixture(scope="session")
def campaign_of_steps(shared: Shared) -> Path:
    """The simulated runs of one sensor at two pressures: to be read or copied, not written."""
    words = "simulate paper-dome --specimens 1 --runs 1 --kinds steps --pressures 0,12 --model atlas --out made"

    def fill(folder: Path) -> None:
        done = in_process(words.split(), folder)
        assert done.returncode == 0, done.stderr

    return shared.folder("campaign-of-steps", fill) / "made/paper-dome-campaign"


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Run the command line in an empty folder, in the process of the tests."""

    def run(*words: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        return in_process(words, cwd or tmp_path)

    return run


@pytest.fixture
def process(tmp_path: Path) -> Command:
    """Run the command line in an empty folder as a process of its own, as a user does; it costs a second of imports."""

    def run(*words: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        return in_new_process(words, cwd or tmp_path)

    return run


@pytest.fixture
def say(capsys: pytest.CaptureFixture[str]) -> Callable[[str], None]:
    """Print past pytest's capture, where figures are the result of a test."""

    def line(text: str) -> None:
        with capsys.disabled():
            print(f"\n{text}")  # noqa: T201

    return line


@pytest.fixture(scope="module")
def chromium() -> Iterator[SharedBrowser]:
    """One browser, with WebGL, for the tests of a file, as it draws on when idle; tests take their pages from `pages`."""
    leave_out_or_fail(FOUND, os.environ)
    with launched(*WITH_WEBGL) as browser:
        shared = SharedBrowser(browser)
        yield shared
        shared.resume()


@pytest.fixture
def pages(chromium: SharedBrowser) -> Iterator[Pages]:
    """Opens pages for one test, each in a profile of its own. No script may fail in them, and no rule on content be broken."""
    chromium.resume()
    opened = Pages(chromium.browser)
    yield opened
    opened.close()
    chromium.rest()
    assert opened.errors == []
