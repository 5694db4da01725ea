"""Lines after a copy of a printer profile, a gauge or a material: numbers to put in, and the next command."""

from pathlib import Path

from pneutouch.catalogue import Library
from pneutouch.catalogue.runs import makers
from pneutouch.spec.material import Material


def next_of_profile(kind: str, path: Path) -> tuple[tuple[str, ...], str]:
    """The command that reads a copy at ``path``, and the steps before it."""
    name = path.stem
    if kind == "printers":
        return ("coupons", "--profile", name), f"put the title, the resins and the numbers of your machine into {path}"
    if kind == "gauges":
        command = ("predict", "paper-dome", "--set", f"pneumatics.gauge={name}")
        return command, f"put the title and the numbers of your gauge into {path}"
    library = Library.default()
    material: Material = library.load("materials", name)
    first = f"put the title, the code and the numbers of your material into {path}"
    if material.kind == "elastomer" and makers(material, library):
        return ("new", f"{name}-dome", "--material", name), first
    return ("list", "materials"), first
