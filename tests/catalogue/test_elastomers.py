"""A dome of every shipped printed elastomer is checked and predicted as `new` writes it, whatever process prints it."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import Library
from pneutouch.output.new import process_values
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

LIBRARY = Library.default()
PRINTED = {n: m for n, m in LIBRARY.all("materials", Material).items() if m.kind == "elastomer" and not m.is_cast}
TRUE_STRESS_MPA = {"FilaFlex60A": 1.85056, "FilaFlex70A": 2.62065, "NinjaFlex": 4.67653}
"""At a stretch of 1.313, as SoRoForge publishes it (DOI 10.1089/3dp.2023.0010): force over the section now."""


@pytest.mark.parametrize("process", ["polyjet", "filament", "resin", "casting"])
def test_every_process_has_a_printer_that_makes_an_elastomer(process):
    values = process_values(process, None, LIBRARY)
    printer = LIBRARY.load("printers", values["print"]["profile"])
    assert printer.process == process
    assert printer.mode_for(LIBRARY.load("materials", values["membrane"]["material"])) is not None


def test_every_printed_elastomer_has_a_printer():
    printers = LIBRARY.all("printers", Printer).values()
    assert [n for n, m in PRINTED.items() if not any(one.mode_for(m) for one in printers)] == []


@pytest.mark.parametrize("name", TRUE_STRESS_MPA)
def test_laws_of_filaments_give_the_nominal_stress_of_the_published_true_one(name):
    stretch, law = 1.313, PRINTED[name].law
    above = stretch**2 + 2 / stretch - 3
    assert law.name == "yeoh" and law.largest_stretch == 2
    slope = sum(k * constant * above ** (k - 1) for k, constant in enumerate(law.constants, start=1))
    nominal = 2 * slope * (stretch - stretch**-2)
    assert nominal * stretch == pytest.approx(TRUE_STRESS_MPA[name], rel=0.05)
