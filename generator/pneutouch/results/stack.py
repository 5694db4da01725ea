"""A stack of voxel slices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ResinVoxels:
    """A base resin."""

    rgba: tuple[int, ...]
    """Colour of the resin in the slices."""
    voxels: int
    """Number of voxels."""
    volume_mm3: float
    """Volume of its voxels."""


@dataclass(frozen=True, slots=True)
class BodyVoxels:
    """A body; the keys that follow its volumes are of a mixed body alone."""

    material: str
    """Label of the material."""
    resins: tuple[str, ...]
    """Base resins that it is mixed of."""
    voxels: int
    """Number of voxels."""
    volume_mm3: float
    """Volume of its voxels."""
    exact_volume_mm3: float
    """Volume of the exact solid."""
    made_up_within_mm: float | None = None
    """Distance from the skin within which its missing stiff resin is added."""
    stiff_resin: str | None = None
    """The stiff resin of the mix."""
    skin_voxels: int | None = None
    """Voxels at the surface, which stay the soft resin."""
    fraction_requested: float | None = None
    """Volume fraction of the stiff resin that the design states."""
    fraction_given: float | None = None
    """Volume fraction of the stiff resin that the dither was given, where the skin stays soft."""
    fraction_realised: float | None = None
    """Volume fraction of the stiff resin in the voxels."""
    worst_cube: float | None = None
    """Greatest deviation of the realised fraction from the given one in a cube."""
    cubes: int | None = None
    """Number of cubes that are compared."""


@dataclass(frozen=True, slots=True)
class DitherRecord:
    """Spread of fractions over voxels."""

    method: str
    """Method."""
    seed: int
    """Seed of the random numbers."""
    cube_mm: float
    """Edge of the cubes in which the fraction is compared with the request."""
    least_share_of_a_cube: float
    """Share of a cube that must lie in the body for it to be compared."""


@dataclass(frozen=True, slots=True)
class StackRecord:
    """A stack of voxel slices."""

    name: str
    """Name."""
    input_hash: str
    """Digest of the inputs and the version."""
    printer: str
    """Printer."""
    mode: str
    """Print mode."""
    orientation: str
    """Orientation of the print."""
    versions: Mapping[str, str]
    """Versions of the program and of the libraries that the bytes depend on."""
    print_frame_offset_mm: tuple[float, ...]
    """From the design frame to the print frame."""
    prefix: str
    """Beginning of the slices' file names."""
    dpi: tuple[float, float]
    """Voxels an inch along x and y."""
    pixel_um: tuple[float, float]
    """Size of a voxel along x and y."""
    layer_um: float
    """Height of a layer."""
    pixels: tuple[int, int]
    """Voxels along x and y."""
    layers: int
    """Number of slices."""
    size_mm: tuple[float, ...]
    """Size of the stack."""
    first_voxel_mm: tuple[float, ...]
    """Centre of the first voxel."""
    background_rgba: tuple[int, ...]
    """Colour where no resin is printed."""
    resins: Mapping[str, ResinVoxels]
    """Base resins by name."""
    bodies: Mapping[str, BodyVoxels]
    """Bodies by name."""
    dither: DitherRecord
    """Spread of fractions over voxels."""
    assumptions: tuple[str, ...]
    """Assumptions, in sentences."""
    sha256: str
    """SHA-256 of the content, hexadecimal."""
    slices: tuple[str, ...]
    """Digest of each slice, from the first on."""
