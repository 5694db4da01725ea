"""The figures of the paper from stored ones, into paper/: ``make paper``."""

from __future__ import annotations

import shutil
from pathlib import Path

import typst

ROOT = Path(__file__).resolve().parents[1]
PAPER = ROOT / "paper"
POINTS_PER_INCH = 200.0


def main() -> None:
    """Copy the picture of the dome, and draw the chart of speed over accuracy as PNG, which the journal takes."""
    shutil.copyfile(ROOT / "docs/paper-dome.png", PAPER / "paper-dome.png")
    page = b'#set page(width: auto, height: auto, margin: 0pt)\n#image("/docs/background/speed-accuracy.svg")\n'
    drawn = typst.compile(page, root=str(ROOT), format="png", ppi=POINTS_PER_INCH)
    (PAPER / "speed-accuracy.png").write_bytes(drawn)
    print("paper/paper-dome.png\npaper/speed-accuracy.png")


if __name__ == "__main__":
    main()
