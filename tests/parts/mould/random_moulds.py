"""Moulds of random cast designs: closed, apart, no undercut, volumes exact.

``python -m tests.parts.mould.random_moulds [COUNT [SEAT]]``. The designs are drawn with a fixed seed over what a design file may
state of a membrane and its mould.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pneutouch.catalogue import DesignSource, load_scene
from pneutouch.parts.mould import MouldAssembly, mould_of
from pneutouch.printability.measure.mould import cavity_match, overlaps, undercuts
from pneutouch.units import UM

SEED, COUNT = 20, 50


@dataclass(frozen=True)
class MouldCheck:
    """What was measured on one mould. ``volume_error`` and ``cavity_error`` are relative, of the meshes to the exact
    volumes of all parts and of the void to the exact cavity; ``offset_um`` is the mean distance of void and membrane."""

    design: str
    triangles: int
    closed: bool
    overlaps: int
    undercuts: int
    offset_um: float
    volume_error: float
    cavity_error: float

    @property
    def sound(self) -> bool:
        """Closed, apart, without undercut, and volumes within 0.1 %."""
        right = max(self.volume_error, self.cavity_error) < 1e-3
        return self.closed and not self.overlaps and not self.undercuts and right


def random_moulds(count: int = COUNT, seed: int = SEED, seat: str = "glued-flange") -> Iterator[MouldAssembly]:
    """Moulds of random cast designs: radius 3 to 20 mm, walls of 0.05 to 0.3 of it, 1 to 6 cavities."""
    draw = np.random.default_rng(seed)
    for k in range(count):
        radius, wall = float(draw.uniform(3, 20)), float(draw.uniform(0.05, 0.3))
        mould = {
            "cavities": int(draw.integers(1, 7)),
            "wall_mm": float(draw.uniform(2, 8)),
            "draft_deg": float(draw.uniform(0.5, 4)),
            "fastener": str(draw.choice(["screws", "clips"])),
            "vent_diameter_mm": float(draw.uniform(1.5, 1.75)),
            "sprue_diameter_mm": float(draw.uniform(1.5, 1.75)),
            "clearance_mm": float(draw.uniform(0.05, 0.3)),
            "shrinkage_percent": float(draw.uniform(0, 3)),
        }
        content = {
            "membrane": {"inner_radius_mm": radius, "wall_thickness_mm": wall * radius, "material": "DragonSkin20"},
            "indentation": {"depth_mm": 0.3 * radius},
            "connector": {"mount": "plain", "seat": seat},
            "print": {"profile": "silicone-casting"},
            "mould": mould,
        }
        yield mould_of(load_scene(DesignSource(f"random-{k + 1}", content, f"random-{k + 1}.toml")))


def checked(mould: MouldAssembly) -> MouldCheck:
    """Measure one mould."""
    match, exact = cavity_match(mould.size, mould.closed, mould.tolerance), mould.size.cavity_volume
    membrane, shape = mould.scene.design.membrane, mould.size.shape
    return MouldCheck(
        design=(
            f"R0 {membrane.inner_radius_mm:.1f}, wall {membrane.wall_thickness_mm:.2f}, {shape.cavities} cavities, "
            f"{shape.fastener}"
        ),
        triangles=sum(len(body.triangles) for body in mould.bodies),
        closed=all(body.is_closed() for body in mould.bodies),
        overlaps=len(overlaps(mould.closed)),
        undercuts=len(undercuts(mould.size, mould.bodies, mould.tolerance)),
        offset_um=match.offset / UM,
        volume_error=max(abs(b.volume / s.volume - 1) for b, s in zip(mould.bodies, mould.solids, strict=True)),
        cavity_error=abs(match.void / exact - 1),
    )


def table(checks: list[MouldCheck]) -> str:
    """One line a design, and a last one over all."""
    lines = [
        f"{'design':44} {'triangles':>9} {'closed':>6} {'overlaps':>8} {'undercuts':>9} {'void, um':>8} {'parts':>8} "
        f"{'cavity':>8}"
    ]
    for one in checks:
        lines.append(
            f"{one.design:44} {one.triangles:9d} {one.closed!s:>6} {one.overlaps:8d} {one.undercuts:9d} "
            f"{one.offset_um:8.4f} {one.volume_error:8.1e} {one.cavity_error:8.1e}"
        )
    worst = max(checks, key=lambda one: one.volume_error), max(checks, key=lambda one: one.cavity_error)
    lines.append(
        f"{sum(one.sound for one in checks)} of {len(checks)} sound; greatest distance of void and membrane "
        f"{max(one.offset_um for one in checks):.4f} um, greatest error of a part's volume {worst[0].volume_error:.1e}, "
        f"of the cavity's {worst[1].cavity_error:.1e}"
    )
    return "\n".join(lines)


if __name__ == "__main__":
    chosen = sys.argv[2] if len(sys.argv) > 2 else "glued-flange"
    drawn = random_moulds(int(sys.argv[1]) if len(sys.argv) > 1 else COUNT, seat=chosen)
    sys.stdout.write(table([checked(mould) for mould in drawn]) + "\n")
