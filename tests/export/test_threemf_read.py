"""Reading a 3MF back: what was written comes back, other makers' files too."""

from __future__ import annotations

import lib3mf
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.export.threemf import threemf
from pneutouch.export.threemf_read import read_threemf
from tests.export.test_threemf import material, tetrahedron, written
from tests.export.threemf_files import with_model


@pytest.mark.slow
def test_what_was_built_comes_back(built, evaluated):
    evaluation = evaluated("fingertip-dome")
    package = read_threemf(built("fingertip-dome") / "fingertip-dome.3mf")
    assembly = evaluation.assembly
    assert [body.name for body in package.bodies] == [body.name for body in assembly.bodies]
    for read, body, solid in zip(package.bodies, assembly.bodies, assembly.solids, strict=True):
        assert np.array_equal(read.triangles, body.triangles)
        assert read.vertices == pytest.approx(body.vertices + assembly.print_offset, abs=5e-6)
        assert (read.material, read.colour) == (solid.material.label, solid.material.colour)
        assert read.volume == pytest.approx(body.volume, rel=1e-5)
        assert read.size == pytest.approx(body.bounds[1] - body.bounds[0], abs=1e-5)
    assert package.thumbnail and package.recipe is not None
    assert package.warnings == ()
    assert package.metadata["Title"] == evaluation.scene.design.document.title
    assert package.metadata["recipe"] == package.recipe
    assert {"Application", "Description", "input-hash", "versions", "mesh-tolerance-mm"} <= package.metadata.keys()
    assert "design" not in package.metadata


@given(
    shift=st.floats(-1000, 1000),
    scale=st.floats(0.01, 100),
    title=st.text(st.characters(min_codepoint=32, exclude_categories=["Cs", "Cn", "Cc"]), min_size=1, max_size=60),
)
def test_any_vertices_and_text_come_back(tmp_path_factory, shift, scale, title):
    body = tetrahedron(material(title=title))
    body = type(body)(title, "membrane", body.material, body.vertices * scale + shift, body.triangles)
    path = tmp_path_factory.mktemp("x") / "x.3mf"
    path.write_bytes(threemf("x", (body,), {"Title": title}))
    package = read_threemf(path)
    assert package.metadata["Title"] == title
    assert package.bodies[0].material == body.material.label
    assert package.bodies[0].name == title
    assert package.bodies[0].vertices == pytest.approx(body.vertices, rel=2e-7, abs=2e-6)


@pytest.mark.slow
@pytest.mark.parametrize("text", ["", " ", '"x" ', "a  b\n\tc ", "é漢&<>\"' "], ids=range(5))
@pytest.mark.parametrize("size", [1, 60_000, 65_535, 200_000, 2_000_000])
def test_metadata_of_any_length_comes_back(tmp_path, text, size):
    """lib3mf itself reads no text of 64 KiB, and no escape that lies across a multiple of 64 KiB."""
    value = (text * size)[:size]
    path = tmp_path / "x.3mf"
    path.write_bytes(threemf("x", (tetrahedron(material()),), {"Title": "t", "recipe": value, "recipes": "other"}))
    package = read_threemf(path)
    assert package.recipe == value
    assert set(package.metadata) == {"Title", "recipe", "recipes"}


def foreign(tmp_path, unit, colour=False):
    """A 3MF of another maker: no metadata, another unit, a colour or nothing as property."""
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(unit)
    mesh = model.AddMeshObject()
    for corner in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        mesh.AddVertex(lib3mf.Position((lib3mf.ctypes.c_float * 3)(*corner)))
    for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)):
        mesh.AddTriangle(lib3mf.Triangle((lib3mf.ctypes.c_uint32 * 3)(*face)))
    if colour:
        group = model.AddColorGroup()
        mesh.SetObjectLevelProperty(group.GetResourceID(), group.AddColor(wrapper.RGBAToColor(1, 2, 255, 255)))
    model.AddBuildItem(mesh, wrapper.GetIdentityTransform())
    path = tmp_path / "foreign.3mf"
    path.write_bytes(bytes(model.QueryWriter("3mf").WriteToBuffer()))  # WriteToFile sets the process's locale to C
    return path


@pytest.mark.parametrize(("unit", "length"), [("Inch", 25.4), ("Meter", 1000.0), ("MicroMeter", 0.001)])
def test_other_units_become_millimetres(tmp_path, unit, length):
    package = read_threemf(foreign(tmp_path, getattr(lib3mf.ModelUnit, unit)))
    (body,) = package.bodies
    assert body.size == pytest.approx([length] * 3)
    assert body.volume == pytest.approx(length**3 / 6)
    assert (body.material, body.colour, package.recipe, package.thumbnail) == (None, None, None, False)


def test_a_colour_is_no_material(tmp_path):
    (body,) = read_threemf(foreign(tmp_path, lib3mf.ModelUnit.MilliMeter, colour=True)).bodies
    assert (body.material, body.colour) == (None, "#0102FF")


def test_a_recipe_in_another_makers_namespace_is_not_ours(tmp_path):
    path = with_model(
        written(tmp_path, tetrahedron(material())),
        tmp_path / "y.3mf",
        lambda model: model.replace(b"https://pneutouch.org/3mf/2026", b"https://example.org/other"),
    )
    assert read_threemf(path).recipe is None
