"""Record of a stack of voxel slices."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ResinVoxels:
    """A base resin in the slices."""

    rgba: tuple[int, ...]
    """Colour of the resin in the slices."""
    voxels: int
    """Number of voxels."""
    volume_mm3: float
    """Volume of its voxels."""


@dataclass(frozen=True, slots=True)
class BodyVoxels:
    """A body in the slices; the keys after its volumes are written for a mixed body only."""

    material: str
    """Label of the material."""
    resins: tuple[str, ...]
    """Base resins of the material."""
    voxels: int
    """Number of voxels."""
    volume_mm3: float
    """Volume of its voxels."""
    exact_volume_mm3: float
    """Volume of the exact solid."""
    made_up_within_mm: float | None = None
    """Distance from the skin within which the stiff resin that the skin lacks is added."""
    stiff_resin: str | None = None
    """The stiff resin of the mix."""
    skin_voxels: int | None = None
    """Voxels at the surface, which are all of the soft resin."""
    fraction_requested: float | None = None
    """Volume fraction of the stiff resin that the design states."""
    fraction_given: float | None = None
    """Volume fraction of the stiff resin that was dithered, so that the skin stays soft."""
    fraction_realised: float | None = None
    """Volume fraction of the stiff resin counted in the voxels."""
    worst_cube: float | None = None
    """Greatest deviation of the counted fraction from the dithered one in a cube."""
    cubes: int | None = None
    """Number of cubes that are compared."""


@dataclass(frozen=True, slots=True)
class DitherRecord:
    """Method by which volume fractions are distributed over voxels."""

    method: str
    """Name of the method."""
    seed: int
    """Seed of the random numbers."""
    cube_mm: float
    """Edge of the cubes in which the counted fraction is compared with the dithered one."""
    least_share_of_a_cube: float
    """Least share of a cube that must lie in the body for the comparison."""


@dataclass(frozen=True, slots=True)
class StackRecord:
    """A stack of voxel slices."""

    name: str
    """Name of the stack."""
    input_hash: str
    """Short digest of the inputs and of the program's version."""
    printer: str
    """Printer."""
    mode: str
    """Print mode."""
    orientation: str
    """Orientation of the print."""
    versions: Mapping[str, str]
    """Versions of the program and of the libraries that the bytes depend on."""
    print_frame_offset_mm: tuple[float, ...]
    """Shift from the design frame to the print frame."""
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
    """Lengths of the stack along x, y and z."""
    first_voxel_mm: tuple[float, ...]
    """Centre of the first voxel in the print frame."""
    background_rgba: tuple[int, ...]
    """Colour where no resin is printed."""
    resins: Mapping[str, ResinVoxels]
    """Base resins by name."""
    bodies: Mapping[str, BodyVoxels]
    """Bodies by name."""
    dither: DitherRecord
    """Method by which volume fractions are distributed over voxels."""
    assumptions: tuple[str, ...]
    """Assumptions, in sentences."""
    sha256: str
    """SHA-256 of the digests of all slices, in order."""
    slices: tuple[str, ...]
    """SHA-256 of each slice, in order."""
