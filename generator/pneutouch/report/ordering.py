"""The ordering code: every field of a part number has a meaning that can be read back."""

from pneutouch.catalogue import ResolvedDesign


def part_number(scene: ResolvedDesign) -> str:
    """Part number, such as PNT-R0925-T150-TP-B4-GF-M3."""
    return "-".join(code for code, _ in _fields(scene))


def code_table(scene: ResolvedDesign) -> list[list[str]]:
    """Each field of the part number with its meaning."""
    return [[code, meaning] for code, meaning in _fields(scene)]


def _fields(scene: ResolvedDesign) -> list[tuple[str, str]]:
    membrane = scene.design.membrane
    return [
        ("PNT", "pneumatic touch sensor, hemispherical"),
        (f"R{100 * membrane.inner_radius_mm:04.0f}", f"inner radius {membrane.inner_radius_mm:g} mm"),
        (f"T{100 * membrane.wall_thickness_mm:03.0f}", f"wall {membrane.wall_thickness_mm:g} mm"),
        (scene.membrane_material.code, scene.membrane_material.label),
        (scene.port.code, scene.port.title),
        (scene.seat.code, scene.seat.title),
        (scene.mount.code, scene.mount.title),
    ]
