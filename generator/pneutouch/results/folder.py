"""The manifest of an output folder."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneutouch.results.coupons import PrintedCoupon
from pneutouch.results.printing import Finding, JobEstimate, TrayFinding
from pneutouch.results.tray import TrayJobRecord


@dataclass(frozen=True, slots=True)
class FileEntry:
    """A file of the folder."""

    sha256: str
    """SHA-256 of the content, hexadecimal."""
    bytes: int
    """Size of the file in bytes."""


@dataclass(frozen=True, slots=True)
class BodyMesh:
    """The mesh of a body."""

    triangles: int
    """Number of triangles."""
    volume_mm3: float
    """Volume of the mesh."""
    exact_volume_mm3: float | None = None
    """Volume of the exact solid."""
    tolerance_mm: float | None = None
    """Greatest distance from the exact surface that the mesh may have."""
    measured_deviation_mm: float | None = None
    """Greatest distance of the mesh from the exact surface."""


@dataclass(frozen=True, slots=True)
class SiliconeRecord:
    """The silicone that fills a mould once."""

    cavities: int
    """Number of cavities."""
    cavity_mL: float
    """Volume of the silicone in one cavity."""
    channels_mL: float
    """Volume of pour channel and vents of one cavity."""
    overflow_mL: float
    """Volume that may overflow at one cavity."""
    loss_mL: float
    """Volume that is lost in cup and syringe."""
    volume_mL: float
    """Volume to mix, with the loss."""
    mass_g: float
    """Mass to weigh, of all parts together."""
    parts_g: tuple[float, ...]
    """Mass to weigh of each part of the silicone."""


@dataclass(frozen=True, slots=True)
class MouldRecord:
    """The mould of a cast membrane."""

    cavities: int
    """Number of cavities."""
    parts: Mapping[str, int]
    """Number of pieces to print, by part."""
    scale: float
    """Lengths of the mould over those of the cured membrane, for the shrinkage."""
    mesh_tolerance_mm: float
    """Tolerance that the meshes keep."""
    wall_error_mm: float
    """Greatest error of the wall by the clearance between the parts."""
    release_strain_percent: float
    """Greatest strain of the membrane as it is taken off the core."""
    silicone: SiliconeRecord
    """Silicone that fills the mould once."""
    mesh: Mapping[str, BodyMesh]
    """Meshes by part."""


@dataclass(frozen=True, slots=True)
class Manifest:
    """Inputs of a folder, and the digest of every file in it; each command adds its own measurements."""

    name: str
    """Name of the design, set or folder that the files belong to."""
    versions: Mapping[str, str]
    """Versions of the program and of the libraries that the bytes depend on."""
    files: Mapping[str, FileEntry]
    """Files by path."""
    inputs: Mapping[str, Any] | None = None
    """Everything that the folder follows from, as data."""
    input_hash: str | None = None
    """Short digest of the inputs and of the program's version."""
    mesh: Mapping[str, BodyMesh] | None = None
    """Meshes by body."""
    print_frame_offset_mm: tuple[float, float, float] | None = None
    """Shift from the design frame to the print frame."""
    left_out: Mapping[str, str] | tuple[str, ...] | None = None
    """Parts left out, and the reasons."""
    mould: MouldRecord | None = None
    """The mould of a cast membrane."""
    estimates: tuple[JobEstimate, ...] | None = None
    """Resin and time of each print job."""
    glue_mL: float | None = None
    """Volume of glue for the seat."""
    findings: tuple[TrayFinding | Finding, ...] | None = None
    """Findings of the print rules."""
    jobs: tuple[TrayJobRecord, ...] | None = None
    """Print jobs of a tray."""
    resin_changes: str | None = None
    """A note on changes of resin."""
    coupons: tuple[PrintedCoupon, ...] | None = None
    """Coupons, piece by piece."""
