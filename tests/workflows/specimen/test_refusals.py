"""What is refused: the message names file, key, value and what is right."""

from __future__ import annotations

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.specimen.draw import draw, load_specimen
from tests.workflows.specimen.test_build import LIBRARY, written

BARS = 'kind = "bars"\npitch_mm = 3\nheight_mm = 1\n'
REFUSED = {
    "thin bars": ('kind = "bars"\npitch_mm = 3\nwidth_mm = 0.4\n', ["width_mm = 0.4", "0.6 mm"]),
    "low bars": ('kind = "bars"\npitch_mm = 3\nheight_mm = 0.2\n', ["height_mm = 0.2", "0.6 mm"]),
    "no matrix between bars": ('kind = "bars"\npitch_mm = 2\nwidth_mm = 1.8\n', ["width_mm = 1.8", "0.2 mm of matrix"]),
    "thin struts": (
        'kind = "bcc"\ncell_mm = 5\nstrut_radius_mm = 0.2\n',
        ["strut_radius_mm = 0.2", "at least 0.25 mm"],
    ),
    "thick struts": ('kind = "bcc"\ncell_mm = 5\nstrut_radius_mm = 1.8\n', ["strut_radius_mm = 1.8", "at most"]),
    "thin by its fraction": (
        'kind = "octet"\ncell_mm = 4\nvolume_fraction = 0.05\n',
        ["volume_fraction = 0.05", "from"],
    ),
    "cell too fine for its fraction": (
        'kind = "bcc"\ncell_mm = 0.5\nvolume_fraction = 0.2\n',
        ["volume_fraction", "cell_mm"],
    ),
    "both": (
        'kind = "bcc"\ncell_mm = 5\nstrut_radius_mm = 0.5\nvolume_fraction = 0.2\n',
        ["exactly one of strut_radius_mm"],
    ),
    "neither": ('kind = "bcc"\ncell_mm = 5\n', ["exactly one of strut_radius_mm", "neither"]),
    "pitch and frequency": (
        BARS + "target_frequency_Hz = 1\n",
        ["exactly one of pitch_mm and target_frequency_Hz", "both"],
    ),
    "no pitch": ('kind = "bars"\n', ["exactly one of pitch_mm", "neither"]),
    "negative depth": (BARS + "depth_mm = -1\n", ["depth_mm = -1", "from 0 to 500 mm"]),
    "too deep": (BARS + "depth_mm = 7.5\n", ["depth_mm = 7.5", "block.height_mm"]),
    "beyond the end": (BARS + "end_mm = 30\n", ["end_mm = 30", "block.length_mm"]),
    "wider than the block": (BARS + "span_mm = 9\n", ["span_mm = 9", "block.width_mm"]),
    "nearly flush": (BARS + "span_mm = 7.9996\n", ["span_mm", "flush"]),
    "too full a surface": (
        'kind = "schwarz-p"\nform = "network"\ncell_mm = 4\nvolume_fraction = 0.9\n',
        ["volume_fraction = 0.9", "0.21"],
    ),
    "thin sheet": ('kind = "gyroid"\ncell_mm = 4\nvolume_fraction = 0.2\n', ["volume_fraction = 0.2", "0.6 mm"]),
    "thin sheet by thickness": ('kind = "gyroid"\ncell_mm = 4\nthickness_mm = 0.3\n', ["thickness_mm = 0.3", "0.6 mm"]),
    "network with thickness": (
        'kind = "gyroid"\nform = "network"\ncell_mm = 4\nthickness_mm = 1\n',
        ["a network has none"],
    ),
    "crests at the surface": ('kind = "sinusoid"\npitch_mm = 4\n', ["depth_mm = 0", "at least 0.6 mm"]),
    "unknown kind": ('kind = "bcd"\n', ['kind = "bcd"', "bcc"]),
    "unknown key": (BARS + "widht_mm = 1\n", ["widht_mm", "width_mm"]),
    "wrong type": ('kind = "bars"\npitch_mm = "3"\n', ['pitch_mm = "3"', "a number"]),
    "list of frequencies": ('kind = "random-phase"\ntarget_frequency_Hz = 1\n', ["target_frequencies_Hz"]),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(name, tmp_path):
    layer, words = REFUSED[name]
    path = written(tmp_path, f"[[layer]]\n{layer}")
    with pytest.raises(InputError) as caught:
        draw(load_specimen(path, library=LIBRARY))
    message = str(caught.value)
    assert message.startswith(f"{path}: layer[0]")
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("depth", "word"), [(0.5, "overlaps"), (1.0, "touches"), (1.0004, "comes within a micrometre")]
)
def test_layers_that_meet(depth, word, tmp_path):
    path = written(tmp_path, f"[[layer]]\n{BARS}[[layer]]\n{BARS}depth_mm = {depth}\n")
    with pytest.raises(InputError, match=rf"layer\[1\].depth_mm = {depth:g}: {word}"):
        draw(load_specimen(path, library=LIBRARY))


def test_far_too_many_cells(tmp_path):
    layer = '[[layer]]\nkind = "bcc"\ncell_mm = 1.2\nstrut_radius_mm = 0.25\n'
    path = written(tmp_path, layer, block="length_mm = 300\nwidth_mm = 200\nheight_mm = 40\n")
    with pytest.raises(InputError, match=r"layer\[0\].cell_mm = 1.2: .* million triangles; the most is 3 million"):
        draw(load_specimen(path, library=LIBRARY))


@pytest.mark.parametrize(
    ("assignment", "words"),
    [
        ("block.inclusion=Agilus30", ['inclusion = "Agilus30" is the matrix too']),
        ("block.inclusion=ABS", ['print.profile = "j735"', "cannot hold", "ABS"]),
        ("block.matrix=Agilus31", ['block.matrix = "Agilus31"', "Agilus30"]),
        ("print.profile=j736", ['print.profile = "j736"', "j735"]),
        ("block.length_mm=-3", ["block.length_mm = -3", "from 1 to 1000 mm"]),
        ("scan.speed_mm_per_s=0", ["scan.speed_mm_per_s = 0", "mm/s"]),
        ("frame.hole_diameter_mm=7", ["frame.hole_diameter_mm = 7", "frame.border_mm"]),
        ("frame.mark=ABCDEFGHIJKLMNOPQRSTUVWX", ["frame.mark", "do not fit"]),
    ],
)
def test_refused_settings(assignment, words):
    with pytest.raises(InputError) as caught:
        draw(load_specimen("texture-specimen", parse_changes([assignment]), LIBRARY))
    for word in words:
        assert word in str(caught.value)


def test_a_sensor_is_no_specimen():
    with pytest.raises(InputError, match=r"has no \[block\] table"):
        load_specimen("paper-dome", library=LIBRARY)
