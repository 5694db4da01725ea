"""Numbers of a material in another unit, and settings that are no lines of a file, are refused with what would be right."""

from __future__ import annotations

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.material import MakingFacts, Material
from pneutouch.spec.read import validate
from tests.refusals import refused


def read(library, name, **keys):
    content = library.load("materials", name).model_dump(mode="python", exclude_none=True)
    return validate(Material, {**content, **keys}, "mine.toml")


def quantity(**numbers):
    return {**numbers, "source": "made up for a test"}


@pytest.mark.parametrize("numbers", [{"value": 120.0}, {"value": 0.2, "high": 120.0}, {"low": 0.2, "high": 120.0}])
def test_an_elastomer_as_stiff_as_a_plastic_is_refused(library, numbers):
    with pytest.raises(
        InputError, match=r"mine\.toml: shear_modulus_MPa\.\w+: 120 MPa is more than the 60 MPa .* modelled .*kPa\?"
    ):
        read(library, "TangoPlus", shear_modulus_MPa=quantity(**numbers))
    read(library, "VeroClear", shear_modulus_MPa=quantity(**numbers))
    assert read(library, "TangoPlus", shear_modulus_MPa=quantity(value=60.0)).shear_modulus_MPa.value == 60.0


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ({"value": 1030.0}, r"density_g_per_cm3\.value = 1030: must be from 0\.5 to 3 g/cm3; is it in kg/m3\?"),
        ({"low": 1.0, "high": 1100.0}, r"density_g_per_cm3\.high = 1100: .* kg/m3"),
        ({"value": 0.001}, r"value = 0\.001: must be from 0\.5 to 3 g/cm3$"),
    ],
)
def test_a_density_in_another_unit_is_refused(library, numbers, said):
    with pytest.raises(InputError, match=said):
        read(library, "DragonSkin20", density_g_per_cm3=quantity(**numbers))
    assert read(library, "DragonSkin20", density_g_per_cm3=quantity(low=0.5, high=3.0)).density_g_per_cm3.high == 3.0


@pytest.mark.parametrize("density", [0.1, 7.9, 25.0])
def test_a_connector_may_be_of_wood_or_steel(library, density):
    of_steel = read(library, "VeroClear", density_g_per_cm3=quantity(value=density))
    assert of_steel.density_g_per_cm3.value == density


@pytest.mark.parametrize(
    ("density", "said"),
    [
        (7900.0, r"mine\.toml: density_g_per_cm3\.value = 7900: must be from 0\.1 to 25 g/cm3 .*; is it in kg/m3\?"),
        (0.05, r"value = 0\.05: must be from 0\.1 to 25 g/cm3 for a rigid material$"),
    ],
)
def test_a_rigid_material_of_no_known_density_is_refused(library, density, said):
    with pytest.raises(InputError, match=said):
        read(library, "VeroClear", density_g_per_cm3=quantity(value=density))
    with refused("", fields=["density_g_per_cm3"]):
        read(library, "DragonSkin20", density_g_per_cm3=quantity(value=7.9))


@pytest.mark.parametrize("shift", [[[20.0, 1.0], [20.0, 2.0]], [[10.0, 0.0], [20.0, 1.0]], [[20.0]]])
def test_a_shift_by_temperature_rises_and_has_factors_above_zero(library, shift):
    terms = [{"share": 0.5, "time_s": 1.0}]
    with pytest.raises(InputError):
        read(
            library,
            "TangoPlus",
            shear_modulus_is="relaxed",
            relaxation=[{"terms": terms, "source": "made up for a test", "shift": shift}],
        )


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("extrusion_multiplier", "115%"),
        ("extrusion_multiplier", 115.0),
        ("extrusion_multiplier", 0.0),
        ("fill_density", "20%\nstart_gcode = M112"),
        ("brim\nwidth", 5.0),
    ],
)
def test_a_setting_that_is_no_line_is_refused_with_its_key(key, value):
    with pytest.raises(InputError) as caught:
        validate(MakingFacts, {"slicer": {key: value}, "source": "made up for a test"}, "own.toml")
    assert caught.value.file == "own.toml" and caught.value.key == "slicer"
