"""Pictures have an opaque light ground: on a dark page letters without one cannot be read."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgba

from pneutouch.report.style import figure, svg

DRAWN = re.compile(r"\{http://www.w3.org/2000/svg\}(path|rect|use|image|text|line|circle|polygon)")
LIGHT = 0.9
DARK = 0.2
IN_THE_DARK = {"studio-dark.png", "studio-large.png"}
"""Screens of the studio in dark colours."""


def ground(text: str) -> tuple[float, ...]:
    """Colour of what is drawn first in an SVG, which must cover it all."""
    root = ET.fromstring(text)
    defined = {part for defs in root.iter("{http://www.w3.org/2000/svg}defs") for part in defs.iter()}
    first = next(part for part in root.iter() if DRAWN.fullmatch(part.tag) and part not in defined)
    look = dict(re.findall(r"([a-z-]+): ([^;]+)", first.get("style", "")))
    corners = np.array(re.findall(r"-?[\d.]+", first.get("d", "")), float).reshape(-1, 2)
    box = [float(value) for value in root.get("viewBox").split()]
    np.testing.assert_allclose([*corners.min(axis=0), *corners.max(axis=0)], box, atol=0.01)
    assert "opacity" not in look
    return to_rgba(look["fill"])


def pictures(root, kind):
    """Pictures of the docs that are kept; a site that was built here is left out."""
    paths = sorted((root / "docs").rglob(f"*.{kind}"))
    return [path for path in paths if not {"_build", "auto_gallery"} & set(path.parts)]


def test_every_drawing_of_the_docs_has_a_light_ground(root):
    drawings = pictures(root, "svg")
    assert len(drawings) > 10
    for path in drawings:
        colour = ground(path.read_text(encoding="utf-8"))
        assert colour[3] == 1, path
        assert min(colour[:3]) > LIGHT, path


def test_every_photograph_of_the_docs_is_opaque_with_a_light_ground(root):
    paths = pictures(root, "png")
    assert len(paths) > 1
    for path in paths:
        image = matplotlib.image.imread(path)
        assert image.shape[2] == 3 or image[..., 3].min() == 1, path
        corners = image[[0, 0, -1, -1], [0, -1, 0, -1], :3]
        assert (corners.max() < DARK) if path.name in IN_THE_DARK else (corners.min() > LIGHT), path


def test_a_figure_is_written_with_its_ground_and_axes_that_do_not_hide_it():
    with figure(60, 40) as drawn:
        drawn.subplots(1, 2)
        text = svg(drawn)
    assert ground(text) == (1, 1, 1, 1)


def test_the_check_sees_a_picture_without_a_ground():
    with figure(60, 40) as drawn:
        drawn.subplots()
        text = svg(drawn)
    with pytest.raises(ValueError, match="fill"):
        assert ground(text.replace("fill: #ffffff", "fill: fill", 1))
    assert ground(text.replace("fill: #ffffff", "fill: none", 1))[3] == 0
