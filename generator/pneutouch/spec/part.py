"""Catalogue parts of the connector: ports, seats and mounts, each one TOML with its source."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from pneutouch.spec.fields import Table


class Barb(Table):
    """A single hose barb for a soft tube, in mm."""

    title: str
    code: str
    family: Literal["barb"]
    tube_outer_diameter: float = Field(gt=0)
    tube_inner_diameter: float = Field(gt=0)
    stem_diameter: float = Field(gt=0)
    barb_diameter: float = Field(gt=0)
    bore_diameter: float = Field(gt=0)
    barb_length: float = Field(gt=0)
    stem_length: float = Field(gt=0)
    source: str = Field(min_length=8)


class GluedFlange(Table):
    """A flange glued into a groove that holds it on three faces up to the base plane."""

    title: str
    code: str
    family: Literal["glued-flange"]
    least_flange_mm: float = Field(gt=0, description="Smallest flange width and thickness, mm.")
    flange_over_wall: float = Field(gt=0, description="Flange width and thickness over the wall thickness.")
    ring_wall_mm: float = Field(gt=0, description="Rigid wall around the groove, mm.")
    channel_diameter_mm: float = Field(gt=0, description="Air channel through the body, mm.")
    source: str = Field(min_length=8)


class BoltCircle(Table):
    """Mounting holes on a circle: through holes outside the seat, or blind holes under it, in mm."""

    title: str
    code: str
    family: Literal["through", "blind"]
    screw: str
    count: int = Field(ge=2, le=12)
    hole_diameter: float = Field(gt=0)
    head_diameter: float = Field(gt=0)
    plate_thickness: float = Field(gt=0)
    hole_depth: float | None = Field(default=None, gt=0, description="Blind holes only.")
    source: str = Field(min_length=8)
