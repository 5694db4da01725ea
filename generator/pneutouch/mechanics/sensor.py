"""What the mechanics needs to know of a sensor: numbers in mm and MPa, nothing of files or printers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sensor:
    """A dome with its gas and its plate. ``break_stretch`` is the stretch at which the resin may tear."""

    inner_radius: float
    wall_thickness: float
    shear_modulus: float
    poisson_ratio: float
    ambient_pressure: float
    dead_volume: float
    plate_radius: float
    depth: float
    steps: int
    break_stretch: float | None
    gauge_limit: float
