"""The air's path holds the gas that the dead volume is computed from, piece by piece."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError, PneutouchError
from pneutouch.parts import assemble
from pneutouch.parts.air_path import air_path

ONE_PIECE = {"print.profile": "j735", "print.connector_profile": "j735", "membrane.material": "Agilus30"}

CAST = {"print.profile": "silicone-casting", "membrane.material": "DragonSkin20"}


@pytest.mark.parametrize("seat", ["glued-flange", "clamped-flange-M2", "one-piece", "cast-ring"])
@pytest.mark.parametrize("mount", ["bolt-circle-4xM3", "finger-16", "robot-50-4-M6"])
def test_the_pieces_hold_the_volume_of_connector_and_tube(library, mount, seat):
    built = 0
    for port in library.paths("ports"):
        changes = {"connector.port": port, "connector.mount": mount, "connector.seat": seat}
        if seat == "one-piece":
            changes |= {**ONE_PIECE, "connector.material": "VeroClear"}
        if seat == "cast-ring":
            changes |= {**CAST, "membrane.inner_radius_mm": 7.0}
        try:
            assembly = assemble(load_scene("paper-dome", changes, library))
        except PneutouchError:
            continue
        pieces = air_path(assembly.scene, assembly.layout)
        drawn = assembly.internal_volume + assembly.tube_volume
        assert sum(piece.volume for piece in pieces) == pytest.approx(drawn, rel=1e-12)
        assert pieces[-1].name == "tube" and pieces[-1].length == 300.0
        assert pieces[-1].radius == pytest.approx(0.5 * assembly.scene.tube.inner_diameter)
        assert all(piece.length > 0 and piece.radius > 0 for piece in pieces)
        built += 1
    assert built or (mount, seat) == ("finger-16", "one-piece")


def test_a_barb_is_a_narrow_neck_between_channel_and_tube(library):
    assembly = assemble(load_scene("paper-dome", {}, library))
    channel, port, tube = air_path(assembly.scene, assembly.layout)
    assert (channel.name, port.name, tube.name) == ("channel", "port", "tube")
    assert port.radius == pytest.approx(0.5 * assembly.scene.port.bore_diameter)
    assert port.length == pytest.approx(assembly.scene.port.stem_length + assembly.scene.port.barb_length)


def test_no_tube_is_no_piece(library):
    assembly = assemble(load_scene("paper-dome", {"pneumatics.tube_length_mm": 0.0}, library))
    assert "tube" not in [piece.name for piece in air_path(assembly.scene, assembly.layout)]


def test_adaptors_behind_the_tube_are_pieces_and_gas_of_the_line(library):
    plain, more = (
        assemble(load_scene("fingertip-dome", changes, library))
        for changes in ({}, {"pneumatics.adaptors_mm": [[12.0, 1.0], [5, 3]]})
    )
    pieces = air_path(more.scene, more.layout)
    assert pieces[:-2] == air_path(plain.scene, plain.layout)
    assert [(one.name, one.length, round(2.0 * one.radius, 9)) for one in pieces[-2:]] == [
        ("adaptor", 12.0, 1.0),
        ("adaptor", 5.0, 3.0),
    ]
    assert more.drawn_volume - plain.drawn_volume == pytest.approx(sum(one.volume for one in pieces[-2:]))


@pytest.mark.parametrize("wrong", [[[1.0]], [[5.0, 0.01]], [[5.0, 2.0, 1.0]], [[-3.0, 1.0]], [[2.0, 1.0]] * 21])
def test_an_adaptor_that_cannot_be_is_refused_by_its_key(wrong, library):
    with pytest.raises(InputError) as error:
        load_scene("fingertip-dome", {"pneumatics.adaptors_mm": wrong}, library)
    assert error.value.key.startswith("pneumatics.adaptors_mm")
