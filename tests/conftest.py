"""Fixtures that several test files share. Builds and evaluations are cached: they are immutable."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from hypothesis import settings

from pneutouch.catalogue import Library
from pneutouch.evaluation import Evaluation, evaluate
from pneutouch.workflows.build import build as build_design

ROOT = Path(__file__).resolve().parents[1]

settings.register_profile("everyday", deadline=None, max_examples=40, derandomize=True)
settings.load_profile("everyday")


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def library() -> Library:
    return Library((ROOT,))


@pytest.fixture(scope="session")
def evaluated(library: Library) -> Callable[..., Evaluation]:
    @cache
    def run(name: str, *assignments: str, model: str = "solid", closure: str = "variational") -> Evaluation:
        return evaluate(name, list(assignments), model=model, closure=closure, library=library)

    return run


@pytest.fixture(scope="session")
def built(evaluated: Callable[..., Evaluation], tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    @cache
    def run(name: str) -> Path:
        return build_design(evaluated(name), tmp_path_factory.mktemp("outputs"))

    return run


@pytest.fixture
def command(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run the command line in an empty folder, as a user does."""

    def run(*words: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "COLUMNS": "200"}
        return subprocess.run(
            [sys.executable, "-m", "pneutouch", *words], cwd=cwd or tmp_path, env=environment,
            capture_output=True, text=True, timeout=120, check=False,
        )  # fmt: skip

    return run
