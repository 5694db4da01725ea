"""Trays that several test files read: nobody writes into their folders."""

from __future__ import annotations

from pathlib import Path

import pytest

from pneutouch.workflows.tray.lay import lay
from pneutouch.workflows.tray.order import order_of_file
from pneutouch.workflows.tray.write import write_tray
from tests.workflows.tray.laid import EXAMPLE, flags


@pytest.fixture(scope="session")
def seven(library):
    return lay(order_of_file(EXAMPLE), library)


@pytest.fixture(scope="session")
def folder(seven, tmp_path_factory):
    return Path(write_tray(seven, tmp_path_factory.mktemp("outputs") / "seven").folder)


@pytest.fixture(scope="session")
def laid_seats(library):
    return flags(library, ["stiff-dome"], ["connector.seat=glued-flange,one-piece,clamped-flange-M2"], 2)


@pytest.fixture(scope="session")
def seats(laid_seats, tmp_path_factory):
    laid = laid_seats
    return laid, Path(write_tray(laid, tmp_path_factory.mktemp("outputs") / "seats").folder)
