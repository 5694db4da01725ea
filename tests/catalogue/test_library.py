"""What is shipped, against the paper's tables; resins by code and base resins together."""

from __future__ import annotations

import itertools

import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.catalogue.listing import listing
from pneutouch.errors import InputError
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

PAPER_TABLE_1 = {
    "TangoPlus": (0.17, 27.6, 29.5),
    "FLX9940": (0.27, 38.5, 42.4),
    "FLX9950": (0.55, 50.4, 51.1),
    "FLX9960": (0.91, 59.9, 60.5),
    "FLX9970": (1.64, 68.9, 68.2),
    "FLX9985": (4.00, 80.4, 76.0),
    "FLX9995": (5.33, 91.3, 87.0),
}


@pytest.mark.parametrize("name", PAPER_TABLE_1)
def test_resins_carry_the_papers_table_1(name, library):
    material: Material = library.load("materials", name)
    found = (material.shear_modulus_MPa.value, material.shore_a.value, material.shore_a_one_year.value)
    assert found == PAPER_TABLE_1[name]
    assert material.shore_a.spread > 0
    assert material.poisson_ratio.value == 0.49
    assert material.density_g_per_cm3.value == 1.15
    assert material.elongation_at_break_percent.least < material.elongation_at_break_percent.most
    assert material.tensile_strength_MPa is not None


def test_digital_materials_name_their_base_resins_and_are_told_apart_by_them(library):
    materials = library.all("materials", Material)
    keys = [(material.title, tuple(material.base_resins)) for material in materials.values()]
    assert len(set(keys)) == len(keys)
    for material in materials.values():
        assert material.is_digital == material.title.endswith("-DM")
        if material.is_digital:
            assert material.base_resins == ["TangoPlus", "VeroClear"]
            assert "TangoPlus + VeroClear" in material.label


def test_stiffness_rises_and_elongation_falls_with_hardness(library):
    chosen = [library.load("materials", name) for name in PAPER_TABLE_1]
    for one, other in itertools.pairwise(chosen):
        assert one.shear_modulus_MPa.value < other.shear_modulus_MPa.value
        assert one.shore_a.value < other.shore_a.value
        assert one.elongation_at_break_percent.least > other.elongation_at_break_percent.least


def test_every_number_names_a_source(library):
    for kind in ("materials", "printers"):
        for name in library.paths(kind):
            found = _sources(library.load(kind, name).model_dump())
            assert found, name
            assert all(len(source) > 7 for source in found)


def _sources(content):
    if isinstance(content, dict):
        here = [content["source"]] if "source" in content else []
        return here + [source for value in content.values() for source in _sources(value)]
    if isinstance(content, list):
        return [source for value in content for source in _sources(value)]
    return []


def test_printers_run_digital_materials_only_with_both_resins_loaded_and_in_a_mixing_mode(library):
    objet: Printer = library.load("printers", "objet260-connex")
    tango, mixed, agilus = (library.load("materials", name) for name in ("TangoPlus", "FLX9960", "Agilus30"))
    assert objet.mode_for(tango).layer_height_um == 16
    assert objet.mode_for(mixed).layer_height_um == 30
    assert objet.mode_for(agilus) is None
    single = objet.model_copy(update={"resins_at_once": 1})
    assert single.mode_for(mixed) is None


def test_mesh_tolerance_is_the_finest_step_and_clearance_the_accuracies_added(library):
    scene = load_scene("paper-dome", None, library)
    assert scene.mesh_tolerance == pytest.approx(0.016)
    assert scene.fit_clearance == pytest.approx(0.10 + 0.20)
    mixed = load_scene("paper-dome", {"membrane.material": "FLX9960"}, library)
    assert mixed.mesh_tolerance == pytest.approx(0.030)


def test_a_file_in_the_working_folder_overrides_the_shipped_one(tmp_path, root):
    own = tmp_path / "printprofiles"
    own.mkdir()
    text = (root / "printprofiles/objet260-connex.toml").read_text().replace("value = 0.10", "value = 0.07")
    (own / "objet260-connex.toml").write_text(text)
    library = Library((tmp_path, root))
    assert library.load("printers", "objet260-connex").accuracy_mm.value == 0.07
    assert library.load("printers", "j735").accuracy_mm.value == 0.127


def test_a_broken_file_in_the_catalogue_names_itself(tmp_path, root):
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    broken = folder / "TangoPlus.toml"
    broken.write_text((root / "printprofiles/materials/TangoPlus.toml").read_text().replace("source = ", "sauce = "))
    with pytest.raises(InputError, match=r"TangoPlus\.toml: .*sauce: unknown key. Did you mean source"):
        load_scene("paper-dome", None, Library((tmp_path, root)))


def test_a_specimen_asked_for_as_a_design_is_called_by_its_name(library):
    with pytest.raises(
        InputError, match="texture-specimen: is a texture specimen; it can be built, checked and scanned"
    ):
        load_scene("texture-specimen", None, library)


@pytest.mark.parametrize("kind", ["ports", "seats", "mounts", "tubes"])
def test_a_kind_of_part_is_listed_under_parts(kind):
    with pytest.raises(InputError, match=f'^kind = "{kind}": unknown; they are listed under parts$'):
        listing(kind)
    assert kind in {entry["kind"] for entry in listing("parts")["parts"]}
