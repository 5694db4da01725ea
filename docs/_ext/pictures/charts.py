"""Every chart of docs/background by its name, from stored measurements or from what the code gives in seconds."""

from __future__ import annotations

from collections.abc import Callable

from pictures.accuracy import CHARTS as ACCURACY
from pictures.background import CHARTS as BACKGROUND
from pictures.mixing import CHARTS as MIXING
from pictures.paper import CHARTS as PAPER
from pictures.presses import CHARTS as PRESSES
from pictures.prints import CHARTS as PRINTS
from pictures.shapes import CHARTS as SHAPES
from pictures.texture import CHARTS as TEXTURE

ALL = (ACCURACY, BACKGROUND, MIXING, PAPER, PRESSES, PRINTS, SHAPES, TEXTURE)
CHARTS: dict[str, Callable[[], str]] = {name: draw for charts in ALL for name, draw in charts.items()}
