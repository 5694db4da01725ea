"""Record of a tray of sensors, as it was laid out."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LabelRow:
    """A body on a tray, a row of the label list; x and y are the middle of the part that it belongs to."""

    label: str
    """Label of the part."""
    body: str
    """Name of the body."""
    file: str
    """Path of the body's mesh file."""
    design: str
    """Name of the design."""
    varied: str
    """Key of the design that is varied, TABLE.KEY; empty: none."""
    value: str | float | list[float | int]
    """Value of that key; empty: none."""
    copy: int
    """Number of the copy, from 1."""
    material: str
    """Title of its material."""
    base_resins: str
    """Base resins of the material."""
    job: int
    """Number of the job, from 1."""
    mode: str
    """Print mode."""
    layers: int
    """Number of layers."""
    x_mm: float
    """Middle of the part along x."""
    y_mm: float
    """Middle of the part along y."""
    turned_deg: int
    """Angle by which the part is turned about z."""
    size_x_mm: float
    """Size along x before the turn."""
    size_y_mm: float
    """Size along y before the turn."""
    height_mm: float
    """Height of the body."""
    mass_g: float
    """Mass of the body."""
    mark: str
    """Kind of the mark: text, tally or none; raised, if it is."""
    mark_face: str
    """Face that carries the mark."""
    mark_depth_mm: float
    """Depth of the mark."""
    mark_stroke_mm: float
    """Width of the mark's strokes."""
    mark_note: str
    """A note on the mark in words; empty: none."""


@dataclass(frozen=True, slots=True)
class TrayJobRecord:
    """A print job: the parts of a tray that are printed together."""

    name: str
    """Name of the job's files."""
    mode: str
    """Print mode."""
    layer_height_um: float
    """Height of a layer."""
    layers: int
    """Number of layers."""
    height_mm: float
    """Height of the job."""
    resins: tuple[str, ...]
    """Resins that are loaded."""
    parts: int
    """Number of parts."""
    mesh_tolerance_mm: float
    """Greatest distance from the exact surface that the meshes may have."""
    fill: Mapping[str, float]
    """Shares of the envelope's area that bounding boxes and outlines of the parts cover."""


@dataclass(frozen=True, slots=True)
class TrayRecord:
    """A tray of sensors."""

    tray: str
    """Name of the tray."""
    folder: str
    """Folder that it was written to."""
    printer: str
    """Title of the printer."""
    parts: int
    """Number of parts."""
    resin_changes: str
    """Changes of resin between the jobs, in words."""
    left_out: tuple[str, ...]
    """Parts left out, and the reasons."""
    jobs: tuple[TrayJobRecord, ...]
    """Print jobs of the tray."""
    labels: tuple[LabelRow, ...]
    """Bodies in the order of the labels."""
