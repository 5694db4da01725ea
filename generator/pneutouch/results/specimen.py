"""Record of a built texture specimen."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True, slots=True)
class BlockRecord:
    """The block, in its own frame: x along the path of the scan."""

    length_mm: float
    """Length along the path of the scan."""
    width_mm: float
    """Width across the path."""
    height_mm: float
    """Height from the bottom to the scanned surface."""
    volume_mm3: float
    """Volume of the block without patterns."""


@dataclass(frozen=True, slots=True)
class ScanPathRecord:
    """The scan that the specimen is made for."""

    speed_mm_per_s: float
    """Speed of the sensor."""
    axis: Literal["x"]
    """Axis of the scan's path."""
    surface_z_mm: float
    """Height of the scanned surface in the block's frame."""


@dataclass(frozen=True, slots=True)
class PatternLayer:
    """A layer of bars or of another pattern."""

    name: str
    """Name of the layer."""
    kind: str
    """Kind of the pattern, as the specimen file states it."""
    pitches_mm: tuple[float, ...]
    """Pitches of the pattern along the path."""
    frequencies_Hz: tuple[float, ...]
    """Frequency of each pitch at the speed of the scan."""
    depth_mm: float
    """Depth of the upper faces below the scanned surface."""
    bottom_depth_mm: float
    """Depth of the lower faces below the scanned surface."""
    start_mm: float
    """Start of the pattern along the path."""
    end_mm: float
    """End of the pattern along the path."""
    width_mm_range: tuple[float, float]
    """Start and end of the pattern across the path."""
    volume_mm3: float
    """Volume of the mesh."""
    exact_volume_mm3: float | None
    """Volume of the exact solid; null: the pattern has none."""
    pattern: Mapping[str, Any]
    """Further properties of the pattern, such as the number of bars, by name."""


@dataclass(frozen=True, slots=True)
class SpecimenRecord:
    """A texture specimen: its block and its layers, in the block's frame, with depths below the scanned surface."""

    name: str
    """Name of the specimen."""
    title: str
    """Title of the specimen file."""
    block: BlockRecord
    """Size of the block."""
    materials: Mapping[str, str]
    """Material of each body."""
    volumes_mm3: Mapping[str, float]
    """Volume of each body."""
    inclusion_fraction: float
    """Volume of all patterns over that of the block."""
    block_to_print_frame_mm: tuple[float, float, float]
    """Offset from the block's frame to that of the print files."""
    scan: ScanPathRecord
    """Scan that it is made for."""
    layers: tuple[PatternLayer, ...]
    """Layers, in order."""
