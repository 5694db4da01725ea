"""A dome of every shipped printed elastomer is checked and predicted as `new` writes it, whatever process prints it."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import Library
from pneutouch.catalogue.library import compared
from pneutouch.output.new import process_values
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

LIBRARY = Library.default()
PRINTED = {n: m for n, m in LIBRARY.all("materials", Material).items() if m.kind == "elastomer" and not m.is_cast}
SECTION_MM2 = 6.0 * 1.5
TENSION = {
    "FilaFlex60A": [(1.31295, 12.63, 1.85056), (2.25181, 25.90, 6.47885), (4.12954, 37.34, 17.12999)],
    "FilaFlex70A": [(1.31300, 17.96, 2.62065), (2.25201, 35.44, 8.84774), (4.13003, 49.39, 22.62771)],
    "Chinchilla": [(1.28128, 16.83, 2.39315), (2.12512, 34.54, 8.15047), (3.81280, 49.63, 21.01457)],
    "NinjaFlex": [(1.31303, 32.14, 4.67653), (2.25211, 57.97, 14.44911), (4.13027, 90.90, 41.61517)],
    "Cheetah": [(1.34386, 90.68, 13.46511), (2.37543, 128.34, 33.73591), (4.43859, 213.94, 105.24954)],
}
"""Three points of each filament of SoRoForge (DOI 10.1089/3dp.2023.0010): stretch, mean raw force of eight specimens in
N, and the stress in MPa of its tables for simulations."""


@pytest.mark.parametrize("process", ["polyjet", "filament", "resin", "casting"])
def test_every_process_has_a_printer_that_makes_an_elastomer(process):
    values = process_values(process, None, LIBRARY)
    printer = LIBRARY.load("printers", values["print"]["profile"])
    assert printer.process == process
    assert printer.mode_for(LIBRARY.load("materials", values["membrane"]["material"])) is not None


@pytest.mark.parametrize("process", ["polyjet", "filament", "resin", "casting"])
def test_the_measured_resins_give_the_error_whatever_the_printer(process):
    printer = LIBRARY.load("printers", process_values(process, None, LIBRARY)["print"]["profile"])
    measured = {name for name, one in PRINTED.items() if one.measured is not None}
    assert len(measured) == 7
    assert measured <= compared(LIBRARY, printer).keys()


def test_every_printed_elastomer_has_a_printer():
    printers = LIBRARY.all("printers", Printer).values()
    assert [n for n, m in PRINTED.items() if not any(one.mode_for(m) for one in printers)] == []


@pytest.mark.parametrize("name", TENSION)
def test_the_published_stresses_are_true_ones(name):
    for stretch, force, stress in TENSION[name]:
        assert stretch * force / SECTION_MM2 == pytest.approx(stress, rel=0.01)


@pytest.mark.parametrize("name", TENSION)
def test_laws_of_filaments_follow_the_nominal_stress_within_their_misfit(name):
    law, (stretch, force, _) = PRINTED[name].law, TENSION[name][0]
    above = stretch**2 + 2 / stretch - 3
    assert law.name == "yeoh" and stretch < law.largest_stretch
    slope = sum(k * constant * above ** (k - 1) for k, constant in enumerate(law.constants, start=1))
    nominal = 2 * slope * (stretch - stretch**-2)
    assert nominal == pytest.approx(force / SECTION_MM2, rel=law.misfit_percent / 100)
