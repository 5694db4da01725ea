"""Where the checkout is; the tests' own module of it imports half of the program, whose branches would then not be counted."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
