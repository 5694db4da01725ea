"""Draw the charts of docs/background: ``PYTHONPATH=docs/_ext python -m pictures [NAME ...]``, without a name all."""

from __future__ import annotations

import sys
from pathlib import Path

from pictures.charts import CHARTS

FOLDER = Path(__file__).resolve().parents[2] / "background"


def main(*names: str) -> None:
    """Draw and write them."""
    for name in names or CHARTS:
        (FOLDER / f"{name}.svg").write_text(CHARTS[name](), encoding="utf-8")
        sys.stdout.write(f"wrote docs/background/{name}.svg\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
