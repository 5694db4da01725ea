"""What is wrong with a stack of voxels is named: every rule checked on the way back."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest
from PIL import Image

from pneutouch.errors import InputError
from pneutouch.export.voxels.png import encode, table
from pneutouch.export.voxels.stack import MANIFEST, read_stack


def other_slice(folder, number, change):
    path = folder / f"graded-dome_{number}.png"
    with Image.open(path) as picture:
        changed = change(picture.copy())
    changed.save(path, compress_level=1)
    return path


def repainted(folder, number, spoil=None, cut=None, dpi=(600, 300)):
    """The slice encoded anew by our own writer: a sound PNG with another content."""
    held = read_stack(folder)
    labels, colours = held.labels(number), held.colours
    if spoil is not None:
        colours = np.append(colours, table([(12, 200, 34, 255)]))
        labels[spoil] = len(colours) - 1
    (folder / f"graded-dome_{number}.png").write_bytes(encode(labels[:, :cut], colours, dpi))


def test_the_folder_of_a_build_is_answered_by_its_3mf(tmp_path):
    (tmp_path / "mine.3mf").write_bytes(b"")
    with pytest.raises(InputError, match=r"no stack\.json") as caught:
        read_stack(tmp_path)
    assert caught.value.remedy == f"of a build, give {tmp_path / 'mine.3mf'}"


def truncated(folder):
    path = folder / "graded-dome_40.png"
    path.write_bytes(path.read_bytes()[:-20])


def flipped(folder):
    path = folder / "graded-dome_40.png"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def altered(key, value):
    def change(folder):
        path = folder / MANIFEST
        content = json.loads(path.read_text())
        content[key] = value
        path.write_text(json.dumps(content))

    return change


def swapped(folder):
    one, other = (folder / f"graded-dome_{k}.png" for k in (40, 150))
    content = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(content)


SPOILED = {
    "palette": (
        lambda f: other_slice(f, 40, lambda p: p.convert("P")),
        r"_40\.png: the PNG is an indexed palette; a slice must be RGBA",
    ),
    "RGB": (lambda f: other_slice(f, 40, lambda p: p.convert("RGB")), r"_40\.png: the PNG is RGB without alpha"),
    "stray": (
        lambda f: repainted(f, 40, spoil=(7, 9)),
        r"_40\.png: the pixel in column 9, row 7 is \(12, 200, 34, 255\), which stands for no resin",
    ),
    "size": (lambda f: repainted(f, 40, cut=-1), r"_40\.png: \d+ x \d+ pixels; all slices must be"),
    "dpi": (lambda f: repainted(f, 40, dpi=(300, 600)), r"_40\.png: states 300 x 600 dpi; must be 600 x 300 dpi"),
    "gap": (lambda f: (f / "graded-dome_40.png").unlink(), r"graded-dome_40\.png is missing"),
    "last": (
        lambda f: shutil.copy(f / "graded-dome_0.png", f / "graded-dome_9999.png"),
        r"is missing; slices must be numbered without gaps",
    ),
    "padded": (lambda f: (f / "graded-dome_4.png").rename(f / "graded-dome_04.png"), r"_04\.png: is no slice"),
    "truncated": (truncated, r"_40\.png: the PNG is cut off"),
    "damaged": (flipped, r"_40\.png: the PNG is damaged"),
    "swapped": (swapped, r"_40\.png: was changed after it was written"),
    "no manifest": (lambda f: (f / MANIFEST).unlink(), r"holds no stack\.json"),
    "broken manifest": (lambda f: (f / MANIFEST).write_text("{"), r"stack\.json: not JSON"),
    "other format": (altered("format", 99), r"format = 99"),
    "altered hash": (altered("slices", ["0" * 64]), r"sha256 is not that of its slices"),
    "missing key": (altered("dpi", None), r"stack\.json: dpi is missing"),
    "text": (lambda f: (f / "graded-dome_40.png").write_text("x"), r"_40\.png: not a PNG file"),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", SPOILED)
def test_what_is_wrong_with_a_stack_is_named(stack, case):
    spoil, said = SPOILED[case]
    spoil(stack)
    with pytest.raises(InputError, match=said):
        read_stack(stack)


def test_fewer_than_thirty_slices_are_refused(stack):
    manifest = json.loads((stack / MANIFEST).read_text())
    for number in range(29, manifest["layers"]):
        (stack / f"graded-dome_{number}.png").unlink()
    from pneutouch.export.voxels.stack import whole_hash

    kept = manifest["slices"][:29]
    (stack / MANIFEST).write_text(json.dumps({**manifest, "layers": 29, "slices": kept, "sha256": whole_hash(kept)}))
    with pytest.raises(InputError, match="29 slices; the utility takes no fewer than 30"):
        read_stack(stack)
