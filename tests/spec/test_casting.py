"""What is cast: its table, its profile, and that no printed design reads of it."""

import pytest

from pneutouch.catalogue.library import compared, elastomers
from pneutouch.catalogue.listing import listing
from pneutouch.errors import InputError
from pneutouch.spec.material import HyperelasticLaw, Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import validate
from tests.refusals import refused


def content(library, kind, name):
    return library.load(kind, name).model_dump(mode="python", exclude_none=True)


def changed(tables, **keys):
    return {**tables, "casting": {**tables["casting"], **keys}}


def test_a_cast_resin_is_an_elastomer_that_is_listed_as_cast(library):
    silicone = library.load("materials", "DragonSkin20")
    assert silicone.is_cast and silicone.kind == "elastomer" and silicone.kind_shown == "cast"
    titles = {entry["name"]: entry["title"] for entry in listing("materials", library)["materials"]}
    assert titles["DragonSkin20"] == "Dragon Skin 20, cast" and titles["TangoPlus"] == "TangoPlus, elastomer"


def test_parts_by_mass_add_up(library):
    casting = library.load("materials", "DragonSkin20").casting
    assert casting.masses_g(30.0) == [15.0, 15.0]
    ten_to_one = casting.model_copy(update={"parts_by_mass": [10.0, 1.0]})
    assert ten_to_one.masses_g(11.0) == pytest.approx([10.0, 1.0])


@pytest.mark.parametrize(
    ("keys", "problem"),
    [
        ({"parts_by_mass": [1.0, 0.0]}, "parts_by_mass"),
        ({"shrinkage_percent": {"value": 12.0, "source": "a made-up source"}}, "from 0 to 10 %"),
        ({"shrinkage_percent": {"value": -1.0, "source": "a made-up source"}}, "from 0 to 10 %"),
        ({"pot_life_min": {"value": 0.0, "source": "a made-up source"}}, "pot_life_min"),
        ({"mixed_viscosity_Pa_s": {"value": 2e5, "source": "cps for Pa s"}}, "mixed_viscosity_Pa_s"),
    ],
)
def test_figures_in_another_unit_are_refused(library, keys, problem):
    tables = content(library, "materials", "DragonSkin20")
    with pytest.raises(InputError, match=problem):
        validate(Material, changed(tables, **keys), "mine.toml")


def test_a_rigid_or_mixed_material_is_not_cast(library):
    casting = content(library, "materials", "DragonSkin20")["casting"]
    for name in ("ABS", "FLX9950"):
        with refused("", fields=["casting"]):
            validate(Material, {**content(library, "materials", name), "casting": casting}, "mine.toml")


def test_what_no_printed_material_states_is_not_in_what_its_designs_are_hashed_by(library):
    assert "casting" not in library.load("materials", "TangoPlus").model_dump(mode="json")
    law = {"name": "yeoh", "constants": [0.1, 0.0, 0.0], "source": "a made-up source"}
    assert set(validate(HyperelasticLaw, law, "law").model_dump()) == set(law)
    fitted = validate(HyperelasticLaw, {**law, "largest_stretch": 2.0, "misfit_percent": 3.0}, "law")
    assert fitted.model_dump()["misfit_percent"] == 3.0


def test_a_printed_design_is_compared_with_printed_resins_and_a_cast_one_with_cast_ones(library):
    printer, casting = library.load("printers", "objet260-connex"), library.load("printers", "silicone-casting")
    assert not any(one.is_cast for one in elastomers(library).values())
    measured = {name for name, one in elastomers(library).items() if one.measured is not None}
    assert set(compared(library, printer)) == measured and len(measured) == 7
    assert measured < set(compared(library, casting))
    cast = {name: one for name, one in compared(library, casting).items() if name not in measured}
    assert cast and all(one.is_cast for one in cast.values())


def test_casting_has_no_pixels_no_layers_and_no_envelope(library):
    profile = library.load("printers", "silicone-casting")
    silicone = library.load("materials", "DragonSkin20")
    mode = profile.mode_for(silicone)
    assert mode is not None and mode.label == "room temperature cure"
    assert profile.finest_step(mode) == 0.02
    for figure in (lambda: profile.pixel, lambda: profile.envelope, lambda: mode.layer_um):
        with pytest.raises(InputError, match="a cast body is not printed"):
            figure()
    assert profile.mode_for(library.load("materials", "TangoPlus")) is None
    assert library.load("printers", "objet260-connex").mode_for(silicone) is None


@pytest.mark.parametrize("name", ["silicone-casting", "abs-filament", "sla-resin"])
def test_a_process_has_what_it_needs_and_no_more(library, name):
    tables = content(library, "printers", name)
    other = "casting" if tables["process"] != "casting" else "filament"
    with pytest.raises(InputError, match="casting"):
        validate(Printer, {**tables, "process": other}, "mine.toml")
    modes = [{key: value for key, value in mode.items() if key != "layer_height_um"} for mode in tables["mode"]]
    if tables["process"] != "casting":
        with pytest.raises(InputError, match="layer_height_um"):
            validate(Printer, {**tables, "mode": modes}, "mine.toml")
