"""Pictures of the tutorials, from what their commands wrote: ``python -m benchmarks.tutorial_pictures DIR``.

DIR is the folder of ``python -m tests.pages docs/tutorials/*.md --keep DIR``.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from PIL import Image

TUTORIALS = Path(__file__).resolve().parents[1] / "docs" / "tutorials"

PICTURES = {"first-sensor-pressed.png": "first-sensor/outputs/my-sensor/my-sensor-pressed.png"}
"""Picture of a page, and the file in DIR that it is."""

DRAWINGS = {"cast-sensor-mould.svg": "cast-sensor/outputs/my-cast/mould/my-cast-mould.svg"}
"""The same for drawings, which are taken as they are."""

_WIDTH, _COLOURS = 640, 128


def main(folder: Path) -> None:
    for name, place in PICTURES.items():
        picture = Image.open(folder / place).convert("RGB")
        small = picture.resize((_WIDTH, round(_WIDTH * picture.height / picture.width)), Image.Resampling.LANCZOS)
        small.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(
            TUTORIALS / name, optimize=True
        )
    for name, place in DRAWINGS.items():
        shutil.copy(folder / place, TUTORIALS / name)
    for name in (*PICTURES, *DRAWINGS):
        print(f"wrote docs/tutorials/{name}: {(TUTORIALS / name).stat().st_size} bytes")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
