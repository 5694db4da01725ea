"""The 3MF that is written: composites of base resins, the thumbnail, what a body says of itself."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.body import Body
from pneutouch.errors import ComputationError, InputError
from pneutouch.export.threemf import threemf
from pneutouch.export.threemf_read import read_threemf
from pneutouch.spec.material import Material, Mix
from pneutouch.spec.read import validate
from tests.conftest import ROOT
from tests.export.threemf_files import MODEL, read_strictly
from tests.refusals import refused

SPACE = {
    "": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "m": "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
}
CORNERS = np.array([[0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 0, 5]], float) + 1
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def material(**changes):
    """A digital material of a lab's own."""
    content = {
        "title": "Lab mix",
        "code": "LM",
        "kind": "elastomer",
        "base_resins": ["TangoPlus", "VeroClear"],
        "colour": "#BE965A",
        "density_g_per_cm3": {"value": 1.15, "source": "our own scales"},
        "poisson_ratio": {"value": 0.49, "source": "assumed here"},
        "shear_modulus_MPa": {"value": 0.4, "source": "our own test"},
        **changes,
    }
    return validate(Material, content, "lab.toml")


def mixed(**fractions):
    return material(
        base_resins=list(fractions), mix={"fractions": fractions, "source": "dispensed volumes of a test print"}
    )


def tetrahedron(resin, name="membrane", role="membrane", shift=0.0):
    return Body(name, role, resin, CORNERS + shift, FACES)


def written(tmp_path, *bodies, **more):
    path = tmp_path / "x.3mf"
    path.write_bytes(threemf("x", bodies, {"Title": "t"}, **more))
    return path


def xml(path):
    with zipfile.ZipFile(path) as archive:
        return ElementTree.fromstring(archive.read(MODEL))


def test_a_known_mix_is_a_composite_of_its_base_resins(tmp_path):
    path = written(tmp_path, tetrahedron(mixed(TangoPlus=0.625, VeroClear=0.375)), tetrahedron(material(), "b", "b", 9))
    root = xml(path)
    bases = [base.get("name") for base in root.findall(".//basematerials/base", SPACE)]
    assert bases == ["TangoPlus", "VeroClear", "Lab mix (TangoPlus + VeroClear)"]
    (group,) = root.findall(".//m:compositematerials", SPACE)
    assert group.get("matid") == root.find(".//basematerials", SPACE).get("id")
    indices = [int(index) for index in group.get("matindices").split()]
    values = [[float(v) for v in entry.get("values").split()] for entry in group.findall("m:composite", SPACE)]
    assert [dict(zip(indices, row, strict=True)) for row in values] == [{0: 0.625, 1: 0.375}]
    objects = {thing.get("name"): thing for thing in root.findall(".//object", SPACE)}
    assert objects["membrane"].get("pid") == group.get("id")
    assert objects["b"].get("pid") == group.get("matid")
    assert objects["x"].get("pid") is None and objects["x"].get("pindex") is None
    assert not [triangle for triangle in root.findall(".//triangle", SPACE) if triangle.get("pid")]


def test_a_composite_reads_strictly_without_warning_and_comes_back(tmp_path):
    one, other = mixed(TangoPlus=1 / 3, VeroClear=2 / 3), mixed(A=0.2, B=0.3, C=0.5)
    path = written(tmp_path, tetrahedron(one), tetrahedron(other, "plug", "plug", 9.0))
    _, reader = read_strictly(path)
    assert reader.GetWarningCount() == 0
    first, second = read_threemf(path).bodies
    assert first.material == one.label and second.material == other.label
    assert first.mix == pytest.approx(one.mix.fractions, abs=1e-6)
    assert second.mix == pytest.approx(other.mix.fractions, abs=1e-6)
    assert first.colour == second.colour == one.colour


def test_without_a_mix_there_is_no_composite(tmp_path, library):
    path = written(
        tmp_path, tetrahedron(material()), tetrahedron(library.load("materials", "ABS"), "c", "connector", 9)
    )
    root = xml(path)
    assert root.find(".//m:compositematerials", SPACE) is None
    assert [body.mix for body in read_threemf(path).bodies] == [{}, {}]


def test_a_single_resin_with_a_mix_stays_a_base_material(tmp_path):
    path = written(tmp_path, tetrahedron(mixed(TangoPlus=1.0)))
    assert xml(path).find(".//m:compositematerials", SPACE) is None


def test_a_resin_is_one_base_material_whatever_is_made_of_it(tmp_path):
    body, mix = tetrahedron(material()), mixed(TangoPlus=0.5, VeroClear=0.5)
    other = replace(body, name="other", role="ring", vertices=body.vertices + 9)
    path = written(tmp_path, body, other)
    assert len(xml(path).findall(".//basematerials/base", SPACE)) == 1
    pure = material(title="TangoPlus", base_resins=["TangoPlus"])
    path = written(
        tmp_path, tetrahedron(pure, "a"), tetrahedron(mix, "b", shift=9.0), tetrahedron(mix, "c", shift=18.0)
    )
    names = [base.get("name") for base in xml(path).findall(".//basematerials/base", SPACE)]
    assert sorted(names) == ["TangoPlus", "VeroClear"]
    assert [one.mix for one in read_threemf(path).bodies[1:]] == [{"TangoPlus": 0.5, "VeroClear": 0.5}] * 2


def test_the_thumbnail_is_the_packages_own_and_changes_nothing_else(tmp_path):
    image = b"\x89PNG\r\n\x1a\n" + bytes(range(256))
    body = tetrahedron(material())
    bare, with_image = threemf("x", (body,), {}), threemf("x", (body,), {}, image)
    assert with_image == threemf("x", (body,), {}, image)
    path = tmp_path / "x.3mf"
    path.write_bytes(with_image)
    model, reader = read_strictly(path)
    assert reader.GetWarningCount() == 0
    assert bytes(model.GetPackageThumbnailAttachment().WriteToBuffer()) == image
    assert read_threemf(path).thumbnail
    with zipfile.ZipFile(path) as archive:
        framed = archive.read(MODEL)
    path.write_bytes(bare)
    assert not read_threemf(path).thumbnail
    with zipfile.ZipFile(path) as archive:
        assert archive.read(MODEL) == framed


@pytest.mark.parametrize("text", ["a" * 66_000, "'" * 11_000], ids=["long", "escaped"])
def test_what_lib3mf_cannot_read_back_is_never_handed_on(text):
    """The two limits of lib3mf that our own metadata is laid out for; a later lib3mf may lift them."""
    with pytest.raises(ComputationError, match="cannot read back what it wrote"):
        threemf("x", (tetrahedron(material()),), {"Title": text})


def test_no_shipped_material_states_a_mix(library):
    assert [name for name, resin in library.all("materials", Material).items() if resin.mix] == []


@given(parts=st.lists(st.integers(1, 1000), min_size=1, max_size=3))
def test_fractions_that_add_up_to_one_are_taken(parts):
    fractions = {f"resin {k}": part / sum(parts) for k, part in enumerate(parts)}
    assert mixed(**fractions).mix.fractions == fractions


@given(parts=st.lists(st.integers(1, 1000), min_size=2, max_size=3), off=st.floats(2e-6, 0.5))
def test_fractions_that_do_not_are_refused(parts, off):
    fractions = {f"resin {k}": part / sum(parts) for k, part in enumerate(parts)}
    fractions["resin 0"] += off
    with refused("mix"):
        mixed(**fractions)


@pytest.mark.parametrize(
    ("fractions", "said"),
    [
        ({"TangoPlus": 1.0}, "names TangoPlus; it must name exactly the base_resins: TangoPlus, VeroClear"),
        ({"TangoPlus": 0.5, "VeroWhite": 0.5}, "must name exactly the base_resins"),
        ({"TangoPlus": 0.5, "VeroClear": 0.3, "Agilus": 0.2}, "must name exactly the base_resins"),
        ({"TangoPlus": 1.0, "VeroClear": 0.0}, "VeroClear = 0: must be more than 0"),
        ({"TangoPlus": 1.5, "VeroClear": -0.5}, "VeroClear = -0.5: must be more than 0"),
        ({"TangoPlus": 0.6, "VeroClear": 0.39}, "add up to 0.99; they must add up to 1"),
        ({"TangoPlus": 0.5, "VeroClear": float("nan")}, "VeroClear"),
        ({"TangoPlus": 0.5, "VeroClear": "half"}, "VeroClear"),
        ({}, "add up to 0; they must add up to 1"),
    ],
)
def test_a_wrong_mix_is_refused_with_the_file_and_what_would_be_right(fractions, said):
    with pytest.raises(InputError) as error:
        material(mix={"fractions": fractions, "source": "dispensed volumes"})
    assert "lab.toml: mix" in str(error.value)
    assert said in str(error.value)


def test_a_mix_without_a_source_is_refused():
    with refused("mix.source"):
        material(mix={"fractions": {"TangoPlus": 0.5, "VeroClear": 0.5}})


def test_a_labs_own_file_with_a_mix_builds_a_composite(tmp_path, library):
    """As the docstring says: ``[mix]`` with a source and ``[mix.fractions]`` in a material file."""
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    text = (ROOT / "printprofiles/materials/FLX9960.toml").read_text()
    text += '\n[mix]\nsource = "weighed cartridges, 12 prints"\n[mix.fractions]\nTangoPlus = 0.7\nVeroClear = 0.3\n'
    (folder / "FLX9960.toml").write_text(text)
    own = type(library)((tmp_path, ROOT)).load("materials", "FLX9960")
    assert own.mix == Mix(fractions={"TangoPlus": 0.7, "VeroClear": 0.3}, source="weighed cartridges, 12 prints")
    path = written(tmp_path, tetrahedron(own))
    assert sorted(read_threemf(path).bodies[0].mix.values()) == pytest.approx([0.3, 0.7])
