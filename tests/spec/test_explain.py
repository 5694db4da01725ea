"""What the refusal of a value states: the form of a table, what a list holds, bounds; each a whole sentence."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import KINDS, Library
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign
from pneutouch.spec.design import DesignFile
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import read_toml, validate
from pneutouch.spec.target import Target
from pneutouch.spec.tray import Tray
from tests.conftest import ROOT
from tests.refusals import refused


@pytest.mark.parametrize(
    ("kind", "name", "change", "said"),
    [
        ("materials", "TangoPlus", {"colour": "grey"}, 'colour = "grey": must be #RRGGBB in capitals, such as #C8BFB4'),
        (
            "printers",
            "j735",
            {"envelope_mm": [250, 210, 220]},
            'envelope_mm = [250, 210, 220]: must be a table such as { x = ..., y = ..., z = ..., source = "..." }',
        ),
        (
            "gauges",
            "smc-pse543",
            {"noise_kPa": 0.05},
            'noise_kPa = 0.05: must be a table such as { value = ..., source = "..." }, from 0 to 1000 kPa',
        ),
        (
            "materials",
            "TangoPlus",
            {"density_g_per_cm3": None},
            'density_g_per_cm3: missing; give density_g_per_cm3 = { value = ..., source = "..." }: Density of the cured',
        ),
        ("printers", "j735", {"title": None}, "title: missing; add it: Name of the machine."),
        ("printers", "j735", {"mode": None}, 'mode: missing; give mode = [{ name = "...", digital_materials = ...'),
    ],
)
def test_a_refusal_shows_the_form(kind, name, change, said):
    library = Library((ROOT,))
    content = {**read_toml(library.paths(kind)[name]), **change}
    with pytest.raises(InputError) as caught:
        KINDS[kind].validate({key: value for key, value in content.items() if value is not None}, "mine.toml")
    assert str(caught.value).startswith(f"mine.toml: {said}")


SENSITIVE = {"target": {"sensitivity_kPa_per_N": 1.0}}


@pytest.mark.parametrize(
    ("model", "content", "said"),
    [
        (
            Target,
            {**SENSITIVE, "given": {"materials": "TangoPlus"}},
            'given.materials = "TangoPlus": must be a list of names, each one of the materials; write ["TangoPlus"]',
        ),
        (
            Target,
            {**SENSITIVE, "given": {"materials": []}},
            "given.materials = []: must be a list with at least one entry, each one of the materials",
        ),
        (
            Target,
            {**SENSITIVE, "setting": {"assignments": 3}},
            "setting.assignments = 3: must be a list of texts: What changes the base design, TABLE.KEY=VALUE each.",
        ),
        (
            Target,
            {"target": {"sensitivity_kPa_per_N": 1.0, "same_sensitivity_at_kPa": [3.0]}},
            "target.same_sensitivity_at_kPa = [3.0]: must be a list with at least 2 entries: Two driving pressures",
        ),
        (
            Target,
            {"target": {"sensitivity_kPa_per_N": 1.0, "same_sensitivity_at_kPa": 3.0}},
            "target.same_sensitivity_at_kPa = 3.0: must be a list of numbers: Two driving pressures",
        ),
        (
            Tray,
            {"entry": [{"design": "x"}, {"design": "x", "over": {"membrane.wall_thickness_mm": 1.5}}]},
            "entry[1].over.membrane.wall_thickness_mm = 1.5: must be a list; write [1.5]",
        ),
        (
            Tray,
            {"tray": {"bodies": "plug"}, "entry": [{"design": "x"}]},
            'tray.bodies = "plug": must be a list of texts: membrane, connector, ring, plug; left out: all that this '
            'printer prints; write ["plug"]',
        ),
        (
            DesignFile,
            {"pneumatics": {"driving_pressures_kPa": 5000.0}},
            "pneumatics.driving_pressures_kPa = 5000.0: must be a list of numbers, from -100 to 1000 kPa",
        ),
        (
            DesignFile,
            {"contact": {"profile_mm": [1, [2.0, 3.0]]}},
            "contact.profile_mm[0] = 1: must be a list of numbers, from -250 to 250 mm",
        ),
        (
            DesignFile,
            {"pneumatics": {"driving_pressures_kPa": 5.0}},
            "pneumatics.driving_pressures_kPa = 5.0: must be a list of numbers, from -100 to 1000 kPa; write [5.0]",
        ),
    ],
)
def test_a_list_is_refused_by_what_it_holds(model, content, said):
    with pytest.raises(InputError) as caught:
        validate(model, content, "a.toml")
    assert str(caught.value).startswith(f"a.toml: {said}"), caught.value


@pytest.mark.parametrize(
    ("model", "content", "said"),
    [
        (Printer, {"resins_at_once": 0}, "resins_at_once = 0: must be at least 1"),
        (DesignFile, {"document": {"title": 81 * "x"}}, "must be text of at most 80 characters"),
        (Tray, {"entry": [{"design": "x", "over": 5}]}, 'entry[0].over = 5: must be a table: one "table.key" with its'),
        (Campaign, {"columns": {"force": "F"}}, 'columns.force = "F": must be a table such as { name = "..." }\n'),
        (DesignFile, {"membrane": {"material": {"to": "A", "fraction": 0.1}}}, "material.from: missing; add it: Soft"),
    ],
)
def test_a_refusal_is_a_whole_sentence(model, content, said):
    with pytest.raises(InputError) as caught:
        validate(model, content, "a.toml")
    assert said in f"{caught.value}\n"


def test_too_many_values_are_refused_by_their_greatest_number():
    content = {"entry": [{"design": "x", "over": {"membrane.wall_thickness_mm": [1.0] * 200}}]}
    with refused("entry[0].over.membrane.wall_thickness_mm"):
        validate(Tray, content, "a.toml")
    with refused("setting.assignments"):
        validate(Target, {**SENSITIVE, "setting": {"assignments": ["a.b=1"] * 101}}, "a.toml")


def test_a_text_in_place_of_tables_is_refused_by_them(library):
    content = read_toml(library.paths("printers")["objet260-connex"])
    with pytest.raises(InputError) as caught:
        validate(Printer, {**content, "mode": "0.15 mm"}, "a.toml")
    assert str(caught.value).startswith('a.toml: mode = "0.15 mm": must be a list of tables: Print modes, one table')
    assert caught.value.remedy == "write each as [[mode]]"
