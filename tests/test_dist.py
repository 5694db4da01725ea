"""Wheel and source archive: the same bytes wherever and whenever they are built, and all that the tests need."""

from __future__ import annotations

import os
import tarfile
import zipfile
from hashlib import sha256

import pytest

from tests.conftest import ROOT
from tests.packaging import copied, packed, tracked

pytestmark = pytest.mark.slow

ELSEWHERE = {"umask": 0o077, "TZ": "Asia/Tokyo", "LC_ALL": "C", "PYTHONHASHSEED": "7"}


def digest(path):
    return sha256(path.read_bytes()).hexdigest()


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    return copied(tmp_path_factory.mktemp("here"))


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory):
    """The same checkout, deeper, of another day and with other permissions."""
    folder = copied(tmp_path_factory.mktemp("there") / "a folder of another name")
    for path in folder.rglob("*"):
        os.utime(path, (1e9, 1e9))
        if path.is_file() and not path.stat().st_mode & 0o100:
            path.chmod(0o600)
    return folder


@pytest.fixture(scope="module")
def sdist(here, tmp_path_factory):
    return packed(here, "sdist", tmp_path_factory.mktemp("sdist"))


@pytest.fixture(scope="module")
def source(sdist, tmp_path_factory):
    folder = tmp_path_factory.mktemp("source")
    with tarfile.open(sdist) as archive:
        archive.extractall(folder, filter="data")
    (top,) = folder.iterdir()
    return top


def test_the_source_archive_has_the_same_bytes_wherever_it_is_built(sdist, elsewhere, tmp_path):
    assert digest(packed(elsewhere, "sdist", tmp_path, **ELSEWHERE)) == digest(sdist)


def test_checkouts_and_the_source_archive_make_the_same_wheel(here, elsewhere, source, tmp_path_factory):
    first = packed(here, "wheel", tmp_path_factory.mktemp("first"))
    again = packed(elsewhere, "wheel", tmp_path_factory.mktemp("again"), **ELSEWHERE)
    of_source = packed(source, "wheel", tmp_path_factory.mktemp("of-source"), **ELSEWHERE)
    assert digest(first) == digest(again) == digest(of_source)


def test_every_date_of_the_wheel_is_the_one_that_make_dist_sets(here, tmp_path):
    epoch = 1580601600
    assert f"SOURCE_DATE_EPOCH={epoch}" in (ROOT / "Makefile").read_text()
    with zipfile.ZipFile(packed(here, "wheel", tmp_path)) as archive:
        assert {entry.date_time for entry in archive.infolist()} == {(2020, 2, 2, 0, 0, 0)}


def test_the_source_archive_holds_all_that_git_tracks_and_nothing_else(source):
    """So every test runs from it, but those that run git."""
    held = {path.relative_to(source).as_posix() for path in source.rglob("*") if path.is_file()}
    assert held == tracked() | {"PKG-INFO"}
