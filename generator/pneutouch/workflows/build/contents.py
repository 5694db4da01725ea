"""Description of the files of a build, in words."""

from collections.abc import Iterable
from fnmatch import fnmatchcase

_NAME = "NAME"
"""Stands for the name of the design."""

CONTENTS: tuple[tuple[tuple[str, ...], str], ...] = (
    (
        ("datasheet.html", "datasheet.pdf"),
        "the datasheet; the page has a 3D view that can be rotated, reads on a phone and prints",
    ),
    (("NAME.3mf",), "both bodies as one assembly, with material names and colours"),
    (("stl/*.stl",), "one file a body, all in one frame, for tray software that reads STL"),
    (("NAME.step", "NAME.glb"), "the exact solids for CAD; the meshes for viewers"),
    (
        ("NAME-pressed.png", "NAME-pressed.glb"),
        "the pressed dome in three dimensions, with the contact pressure on it (models `solid` and `harmonic`)",
    ),
    (
        ("mould/*",),
        "of a cast design: its mould, each part as it is printed, all on build plates, closed for CAD, apart for "
        "viewers, in section",
    ),
    (("prediction.json",), "every figure and curve, with units in the names"),
    (("print-sheet.md",), "which body takes which resin, orientation, cleaning, fits"),
    (("manifest.json",), "inputs, versions, measured mesh deviation, SHA-256 of every file"),
)
"""Files of an output folder that belong together, by patterns of their names, with a description; as in
docs/reference/files.md."""


def described(names: Iterable[str], design: str) -> list[tuple[list[str], str]]:
    """The files of the output folder of ``design`` by group, with a description; groups without a file left out."""
    left = list(names)
    groups = []
    for patterns, words in CONTENTS:
        expected = [pattern.replace(_NAME, design) for pattern in patterns]
        there = [name for pattern in expected for name in left if fnmatchcase(name, pattern)]
        left = [name for name in left if name not in there]
        groups.append((there, words))
    return [(there, words) for there, words in [*groups, (left, "")] if there]
