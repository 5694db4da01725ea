"""Mixing curves in files of a lab's own: what is refused, and what a measured one gives."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixed_material, mixing
from pneutouch.errors import InputError
from pneutouch.selection.mixes import greatest, levels
from pneutouch.spec.grade import Grade
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from tests.catalogue.mixes import mixed
from tests.conftest import ROOT
from tests.refusals import refused


def changed(tmp_path, name="TangoPlus+VeroClear", **top):
    content = read_toml(ROOT / "printprofiles/mixing/TangoPlus+VeroClear.toml")
    if "points" in top and "curves" not in top:
        del content["curves"]
    content.update(top)
    folder = tmp_path / "printprofiles/mixing"
    folder.mkdir(parents=True)
    (folder / f"{name}.toml").write_text(toml_text(content))
    return Library((tmp_path, ROOT))


def point(fraction, **more):
    return {"fraction": fraction, "source": "a source of its own", **more}


ZERO = point(0.0, material="TangoPlus")
NAMES = {"fraction": "middle", "fraction_low": "stiff", "fraction_high": "soft"}
BAD = [
    (
        {"points": [ZERO, point(0.2, shear_modulus_MPa=0.5), point(0.1, shear_modulus_MPa=0.9)]},
        "fraction 0.1 after 0.2",
    ),
    ({"points": [ZERO, point(0.2, shear_modulus_MPa=0.5), point(0.2, shear_modulus_MPa=0.9)]}, "they must rise"),
    (
        {"points": [ZERO, point(0.1, shear_modulus_MPa=0.5), point(0.2, shear_modulus_MPa=0.4)]},
        "0.4 MPa at fraction 0.2 after 0.5 MPa",
    ),
    ({"points": [point(0.1, material="TangoPlus"), point(0.2, material="FLX9960")]}, "must be 0, the soft resin alone"),
    ({"points": [ZERO, point(0.2)]}, "either material or shear_modulus_MPa"),
    ({"points": [ZERO, point(0.2, material="FLX9960", shear_modulus_MPa=1.0)]}, "either material or shear_modulus_MPa"),
    (
        {"points": [ZERO, point(0.2, material="FLX9960", shear_modulus_spread_MPa=1.0)]},
        "a spread needs its shear_modulus_MPa",
    ),
    ({"points": [ZERO, point(0.2, material="FLX9960", fraction_low=0.3)]}, "must lie between fraction_low = 0.3"),
    (
        {"points": [ZERO, point(0.1, material="FLX9950", fraction_high=0.4), point(0.2, material="FLX9960")]},
        "it must not fall",
    ),
    ({"points": [ZERO, point(0.2, material="FLX9961")]}, "no such name among the materials"),
    ({"points": [ZERO, point(0.2, material="Agilus30")]}, "has Agilus30 in it"),
    ({"points": [ZERO, point(0.2, material="VeroClear")]}, "has no shear_modulus_MPa"),
    ({"points": [ZERO, point(0.2, shear_modulus_MPa=-1.0)]}, "shear_modulus_MPa"),
    (
        {"curves": {"fraction": "a", "fraction_low": "b", "fraction_high": "a"}},
        "every curve must have a name of its own",
    ),
    (
        {"curves": NAMES, "points": [ZERO, point(0.2, material="FLX9960")]},
        "leave [curves] out of a curve that was measured",
    ),
    (
        {
            "curves": NAMES,
            "points": [
                ZERO,
                point(0.1, material="FLX9950", fraction_low=0.0, fraction_high=0.2),
                point(0.2, material="FLX9960", fraction_low=0.1, fraction_high=0.3),
            ],
        },
        "they must begin with 0 and rise",
    ),
    ({"soft": "Agilus30"}, 'must be "TangoPlus" and "VeroClear"'),
    ({"stiff": "TangoPlus"}, "another resin than soft"),
]


@pytest.mark.parametrize(("top", "said"), BAD, ids=[said[:40] for _, said in BAD])
def test_a_wrong_curve_names_its_file_and_what_would_be_right(tmp_path, top, said):
    library = changed(tmp_path, **top)
    with pytest.raises(InputError) as error:
        mixed(0.1, library=library)
    assert said in str(error.value)
    assert "TangoPlus+VeroClear.toml" in str(error.value)


def test_a_measured_curve_has_no_band_but_a_spread(tmp_path):
    measured = [
        point(f, shear_modulus_MPa=mu, shear_modulus_spread_MPa=0.1 * mu)
        for f, mu in ((0.0, 0.2), (0.2, 0.9), (0.4, 4.0))
    ]
    material = mixed(0.3, library=changed(tmp_path, points=measured))
    found = material.shear_modulus_MPa
    assert found.low is found.high is None
    assert found.spread == pytest.approx(0.1 * found.value)
    assert 0.9 < found.value < 4.0
    assert material.curves == []


def test_a_measured_curve_takes_no_name(tmp_path):
    measured = [point(f, shear_modulus_MPa=mu) for f, mu in ((0.0, 0.2), (0.4, 4.0))]
    content = Grade.model_validate({"from": "TangoPlus", "to": "VeroClear", "fraction": 0.1, "curve": "j750-tension"})
    with pytest.raises(InputError) as error:
        mixed_material(content, changed(tmp_path, points=measured), file="here")
    assert "leave it out: TangoPlus+VeroClear has one curve" in str(error.value)


def test_a_mixing_curve_through_a_plastic_is_refused(tmp_path):
    """A rigid resin may have a modulus; a membrane of it may not."""
    folder = tmp_path / "printprofiles"
    (folder / "materials").mkdir(parents=True)
    (folder / "mixing").mkdir()
    stiff = read_toml(ROOT / "printprofiles/materials/VeroClear.toml")
    stiff["shear_modulus_MPa"] = {"value": 700.0, "source": "made up for a test"}
    (folder / "materials/VeroClear.toml").write_text(toml_text(stiff))
    curve = read_toml(ROOT / "printprofiles/mixing/TangoPlus+VeroClear.toml")
    del curve["curves"]
    point = {"fraction": 1.0, "material": "VeroClear", "source": "the stiff resin alone"}
    (folder / "mixing/TangoPlus+VeroClear.toml").write_text(toml_text({**curve, "points": [*curve["points"], point]}))
    with pytest.raises(
        InputError, match=r"here: membrane\.material: fraction = 0\.9: .* shear modulus of [\d.]+ MPa is more"
    ):
        mixed(0.9, library=Library((tmp_path, ROOT)))


def stiff_curve(tmp_path, factor=1.0):
    """A measured curve that goes on to 105 MPa, all moduli times a factor."""
    points = [point(f, shear_modulus_MPa=factor * mu) for f, mu in ((0.0, 0.2), (0.2, 0.8), (0.5, 105.0))]
    return changed(tmp_path, curves=None, points=points)


def test_a_stiff_point_of_a_curve_is_no_fault_of_a_soft_mix(tmp_path):
    library = stiff_curve(tmp_path)
    assert 0.2 < mixed(0.15, library=library).shear_modulus_MPa.value < 0.8
    law = mixing("TangoPlus", "VeroClear", library)
    top = law.wall_top
    assert float(law.modulus_at(np.array(top))) == pytest.approx(60.0, rel=5e-3)
    assert mixed(top, library=library).shear_modulus_MPa.value <= 60.0
    assert greatest(law) == top
    resins = [mixed(float(fraction), library=library) for fraction in levels(law)]
    assert resins[-1].shear_modulus_MPa.value == pytest.approx(60.0, rel=5e-3)


@pytest.mark.parametrize(("fraction", "at"), [(0.5, None), ([0.0, 0.5], None)], ids=["constant", "graded"])
def test_the_stiffest_place_of_a_mix_is_bounded(tmp_path, fraction, at):
    """The mean of the grade is below the bound, its rim is not."""
    library = stiff_curve(tmp_path)
    with pytest.raises(InputError) as error:
        mixed(fraction, at, library=library)
    said = (
        "here: membrane.material: fraction = 0.5: by the mixing curve TangoPlus+VeroClear its shear modulus of 105 MPa"
    )
    assert said in str(error.value)
    assert "take at most 0.473" in str(error.value) and "of VeroClear, or correct" in str(error.value)


def test_a_curve_in_kPa_is_refused_where_it_is_used(tmp_path):
    with refused("membrane.material: fraction", 0.1):
        mixed(0.1, library=stiff_curve(tmp_path, 1000.0))


def test_a_mix_as_dense_as_a_metal_is_refused(tmp_path):
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    heavy = read_toml(ROOT / "printprofiles/materials/VeroClear.toml")
    heavy["density_g_per_cm3"] = {"value": 19.0, "source": "made up for a test"}
    (folder / "VeroClear.toml").write_text(toml_text(heavy))
    with pytest.raises(
        InputError, match=r"here: membrane\.material = .*: a mix of 4\.7\d g/cm3 must be from 0\.5 to 3"
    ):
        mixed(0.2, library=Library((tmp_path, ROOT)))
