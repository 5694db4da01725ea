"""Where the kept inputs of the targets lie, by the name of the target."""

from pathlib import Path

CORPUS = Path(__file__).parent / "corpus"
