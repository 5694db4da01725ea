"""Draw docs/howto/connectors.svg: each seat and mount in section, each port."""

from __future__ import annotations

from pathlib import Path

from pneutouch.catalogue import Library, load_scene
from pneutouch.parts import Assembly, assemble
from pneutouch.report.section import draw_section
from pneutouch.report.style import figure, svg
from pneutouch.spec.read import parse_changes

ROOT = Path(__file__).resolve().parents[3]

SHOWN = (
    ("glued-flange", "barb-4x2.5", "bolt-circle-4xM3"),
    ("clamped-flange-M2", "thread-M5", "rear-3xM2"),
    ("one-piece", "luer-female", "plain"),
    ("glued-flange", "push-in-4", "robot-50-4-M6"),
    ("clamped-flange-M2", "thread-M3", "finger-16"),
    ("one-piece", "barb-6x4", "robot-50-4-M6"),
)


def assembly(seat: str, port: str, mount: str) -> Assembly:
    """The paper's dome on a connector that the same machine prints."""
    chosen = [f"connector.seat={seat}", f"connector.port={port}", f"connector.mount={mount}"]
    return assemble(load_scene("stiff-dome", parse_changes(chosen), Library((ROOT,))))


def main() -> None:
    """Draw and write it."""
    with figure(180, 105) as drawn:
        for ax, (seat, port, mount) in zip(drawn.subplots(2, 3).flat, SHOWN, strict=True):
            draw_section(ax, assembly(seat, port, mount))
            ax.set_aspect("equal")
            ax.set_xlim(-34, 44)
            ax.set_ylim(-31, 13)
            ax.axis("off")
            ax.set_title(f"seat {seat}\nport {port}\nmount {mount}", fontsize=6.5, loc="left")
        (ROOT / "docs" / "howto" / "connectors.svg").write_text(svg(drawn), encoding="utf-8")


if __name__ == "__main__":
    main()
