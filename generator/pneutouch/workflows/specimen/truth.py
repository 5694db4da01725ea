"""True patterns of a specimen, as data: the ground truth that a scan is compared with."""

from typing import Any

from pneutouch.parts.specimen import PatternGeometry
from pneutouch.spec.specimen import Layer
from pneutouch.workflows.specimen.draw import SpecimenBodies

_DECIMALS = 6


def truth(drawn: SpecimenBodies) -> dict[str, Any]:
    """Block, path and layers in the block's frame, mm: x along the path, depths below the scanned surface."""
    scene, block = drawn.scene, drawn.scene.specimen.block
    volumes = {body.name: body.volume for body in drawn.bodies}
    return {
        "name": scene.name,
        "title": scene.specimen.document.title,
        "block": {
            "length_mm": block.length_mm,
            "width_mm": block.width_mm,
            "height_mm": block.height_mm,
            "volume_mm3": _rounded(scene.block.volume),
        },
        "materials": {body.name: body.material.label for body in drawn.bodies},
        "volumes_mm3": {name: _rounded(volume) for name, volume in volumes.items()},
        "inclusion_fraction": _rounded(volumes["inclusion"] / scene.block.volume),
        "block_to_print_frame_mm": drawn.offset.tolist(),
        "scan": {"speed_mm_per_s": scene.specimen.scan.speed_mm_per_s, "axis": "x", "surface_z_mm": block.height_mm},
        "layers": [
            _layer(drawn, layer, pattern) for layer, pattern in zip(scene.specimen.layer, drawn.patterns, strict=True)
        ],
    }


def title(layer: Layer, number: int) -> str:
    """Name of a layer as given, else its number."""
    return layer.name or f"layer {number + 1}"


def frequencies(drawn: SpecimenBodies, pattern: PatternGeometry) -> list[float]:
    """Frequencies in Hz of a pattern at the speed of the scan."""
    return [drawn.scene.specimen.scan.speed_mm_per_s / pitch for pitch in pattern.pitches]


def _layer(drawn: SpecimenBodies, layer: Layer, pattern: PatternGeometry) -> dict[str, Any]:
    number, top = drawn.scene.specimen.layer.index(layer), drawn.scene.block.high[2]
    low, high = pattern.box.low, pattern.box.high
    return {
        "name": title(layer, number),
        "kind": layer.kind,
        "pitches_mm": [_rounded(pitch) for pitch in pattern.pitches],
        "frequencies_Hz": [_rounded(frequency) for frequency in frequencies(drawn, pattern)],
        "depth_mm": _rounded(top - high[2]),
        "bottom_depth_mm": _rounded(top - low[2]),
        "start_mm": _rounded(low[0]),
        "end_mm": _rounded(high[0]),
        "width_mm_range": [_rounded(low[1]), _rounded(high[1])],
        "volume_mm3": _rounded(pattern.mesh.volume),
        "exact_volume_mm3": None if pattern.volume is None else _rounded(pattern.volume),
        "pattern": {
            key: _rounded(value) if isinstance(value, float) else value for key, value in pattern.truth.items()
        },
    }


def _rounded(value: float) -> float:
    return round(float(value), _DECIMALS) + 0.0
