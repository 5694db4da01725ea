"""A pad whose cell has a made-up table in the cache: nothing is pressed, and the studio finds it as its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.touch.cell import RADII, SHARES, TILTS, CellTable, greatest_lean
from pneutouch.output.new_pad import new_pad
from pneutouch.workflows.pad.load import load_pad
from pneutouch.workflows.pad.touch import pad_model

NAME, PRESSURE = "tip", "4.2"
"""The pad, and the driving pressure that its form begins with."""
_POINTS = 33


def kept_pad(home: Path) -> None:
    """Write a pad of three cells into the user's folder, and its table into the cache; the environment names both."""
    new_pad(NAME, home / "designs", "row:3", 9.0)
    pad_model(load_pad(NAME), float(PRESSURE), made_up)


def made_up(sensor: Sensor, pressure: float) -> CellTable:
    """A table by rules of thumb: force and rise by powers of the travel, sideways forces by the lean."""
    radius, outer, depth = sensor.dome.inner_radius, sensor.dome.shape.outer_radius, 2.0
    sizes, travel = radius * np.array(RADII)[:, None], np.linspace(0.0, depth, _POINTS)
    lean = greatest_lean(depth, outer, sizes) * np.array(SHARES)
    arrays = {"numbers": np.array([radius, outer, depth, outer, 150.0, pressure])}
    down = (outer + sizes) * np.sqrt(1 - lean**2) - sizes
    beside = np.log(RADII), np.array(SHARES), lean
    for kind, rows, columns, sine, stiff, first in (
        ("balls", *beside, sizes / (sizes + outer), down),
        ("cylinders", *beside, np.sqrt(sizes / (sizes + outer)), down),
        (
            "plates",
            np.zeros(1),
            np.array(TILTS),
            np.array([TILTS]),
            np.ones((1, 1)),
            outer / np.sqrt(1 - np.array([TILTS]) ** 2),
        ),
    ):
        force = 0.3 * np.sqrt(stiff * np.ones_like(sine))[..., None] * travel**1.4
        columns_of = [force, 0.6 * force, 0.5 * outer * force, 2e-3 * force * (1.0 - 0.2 * sine[..., None])]
        arrays |= {f"{kind}_rows": rows, f"{kind}_columns": columns**2, f"{kind}_values": np.stack(columns_of, axis=-1)}
        arrays |= {f"{kind}_first": first, f"{kind}_reach": np.full(first.shape, depth)}
    return CellTable.of(arrays)
