"""Copies of the checkout, and the archives that are built from them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest

from tests.conftest import ROOT

PRIVATE = (
    "designs/private.toml",
    "designs/specimens/private.toml",
    "designs/designs/private.toml",
    "printprofiles/materials/private.toml",
    "docs/examples/private.toml",
    "user/designs/private.toml",
    "calibrations/private.toml",
)


def tracked(*folders):
    """Files that git tracks, by their paths in the checkout."""
    done = subprocess.run(["git", "ls-files", "-z", *folders], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip("no git checkout")
    return {name for name in done.stdout.split("\0") if name and (ROOT / name).is_file()}


def copied(folder, *names):
    """A copy of what git tracks of the checkout, or of the folders named, with private files in it."""
    for name in tracked(*names):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    for name in PRIVATE:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "designs/paper-dome.toml", folder / name)
    return folder


def packed(checkout, kind, folder, umask=0o022, **environment):
    """The archive of a kind that is built from the checkout. SOURCE_DATE_EPOCH is the one of the Makefile unless given."""
    words = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(folder)]
    known = {**os.environ, "SOURCE_DATE_EPOCH": "1580601600", "PYTHONDONTWRITEBYTECODE": "1", **environment}
    subprocess.run(words, cwd=checkout, check=True, capture_output=True, umask=umask, env=known)
    (archive,) = folder.iterdir()
    return archive
