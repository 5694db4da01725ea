"""Content of a 3MF or of a voxel stack as the program states it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneutouch.results.stack import ResinVoxels


@dataclass(frozen=True, slots=True)
class ShownBody:
    """A body of a 3MF."""

    name: str
    """Name of the body."""
    material: str | None
    """Name of its material; null: it has none."""
    colour: str | None
    """Colour; null: it has none."""
    mix: Mapping[str, float]
    """Volume fractions of the resins that it is mixed from; empty: it is not mixed."""
    size_mm: tuple[float, ...]
    """Lengths along x, y and z."""
    volume_mm3: float
    """Volume of the mesh."""
    vertices: int
    """Number of vertices."""
    triangles: int
    """Number of triangles."""


@dataclass(frozen=True, slots=True)
class ShownRecipe:
    """Recipe of a build, that is all its inputs, as stored in the built file with format, versions and input hash."""

    format: str
    """Format of the recipe."""
    name: str
    """Name of the design."""
    version: str
    """Version of the program that built it."""
    inputs: Mapping[str, Any]
    """Everything that the build follows from, as data."""
    input_hash: str
    """Short digest of the inputs and of the program's version."""
    versions: Mapping[str, Any]
    """Versions of the program and of the libraries that the bytes depend on."""
    other_versions: tuple[str, ...]
    """Program and libraries whose version here differs from the stored one, in words."""


@dataclass(frozen=True, slots=True)
class ShownPackage:
    """Content of a 3MF."""

    file: str
    """Path of the file."""
    bodies: tuple[ShownBody, ...]
    """Bodies of the file."""
    thumbnail: bool
    """True if the file has a picture."""
    warnings: tuple[str, ...]
    """Doubtful parts of the file, in words."""
    metadata: Mapping[str, str]
    """Metadata of the file by name, without the recipe."""
    recipe: ShownRecipe | None
    """Recipe that it was built from; null: it has none."""


@dataclass(frozen=True, slots=True)
class PrintedResin(ResinVoxels):
    """A resin of a stack, counted in the slices."""

    share_of_the_print: float
    """Voxels of this resin over those of all resins."""


@dataclass(frozen=True, slots=True)
class ShownStack:
    """Content of a voxel stack: the resins as counted, and entries of its manifest."""

    stack: str
    """Folder of the stack."""
    resins: Mapping[str, PrintedResin]
    """Resins by name."""
    held: Mapping[str, Any]
    """Further entries of the stack's manifest, unchanged."""
