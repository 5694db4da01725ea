"""The page of every shipped printer and process: each number with its source."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from pneutouch.catalogue import Library
from pneutouch.schemas.pieces import unit_of
from pneutouch.spec.fields import Table
from pneutouch.spec.grade import MixingCurve, MixingPoint
from pneutouch.spec.printer import FeatureSize, Printer
from pneutouch.spec.values import Quantity
from reference_pages import markdown
from reference_pages.markdown import code, plain, table

_ROOT = Path(__file__).parents[3]

_INTRO = (
    "What the print rules and the estimates take from the shipped profiles, made from `printprofiles/*.toml`; every "
    "number with its source. A file of the same name in your `printprofiles/` comes first. The keys are those of "
    "[printer](files.md#printer) and [mixing](files.md#mixing). The cured materials are on "
    "[Materials](../materials.md), the pressure gauges on [Gauges](../gauges.md)."
)

_COMPARED = ("name", "machine", "process", "build volume, mm", "layers, µm", "accuracy, mm", "walls, mm: rigid", "soft")


def printers() -> dict[str, Printer]:
    """The shipped profiles by name."""
    return Library((_ROOT,)).all("printers", Printer)


def curves() -> dict[str, MixingCurve]:
    """The shipped mixing curves by name."""
    return Library((_ROOT,)).all("mixing", MixingCurve)


def page() -> str:
    """The page."""
    listed = printers()
    compared = table(_COMPARED, [_compared(name, one) for name, one in listed.items()])
    least = "Walls: below the first number it fails, below the second it is at risk."
    profiles = [section(name, one) for name, one in listed.items()]
    mixing = ["## Mixing curves", *(_curve(name, one) for name, one in curves().items())]
    return markdown.page("Printers and processes", _INTRO, compared, least, *profiles, *mixing)


def section(name: str, printer: Printer) -> str:
    """The section of a profile."""
    at_once = f"{printer.resins_at_once} at once" if printer.resins_at_once > 1 else "one at a time"
    facts = (
        f"{plain(printer.title)}, process {printer.process}. Runs {', '.join(map(code, printer.resins))}, {at_once}. "
        f"Support: {plain(printer.support)}."
    )
    modes = [(plain(mode.name), "yes" if mode.digital_materials else "no", plain(mode.source)) for mode in printer.mode]
    rows = [(code(key), value, plain(unit), plain(source)) for key, value, unit, source in numbers(printer)]
    tables = [table(("mode", "mixes resins", "source"), modes), table(("number", "value", "unit", "source"), rows)]
    return "\n\n".join([f"## {name}", facts, *tables])


def numbers(of: Table, path: str = "") -> Iterator[tuple[str, str, str, str]]:
    """Key, value, unit and source of every sourced number."""
    for key in type(of).model_fields:
        value, here = getattr(of, key), f"{path}{key}"
        if isinstance(value, Quantity):
            ends = "" if value.low is None or value.value is None else f" ({value.low:g} to {value.high:g})"
            yield here, f"{value.text()}{ends}", unit_of(key), value.source
        elif isinstance(value, list) and value and isinstance(value[0], Table):
            for one in value:
                yield from numbers(one, f"{here} {getattr(one, 'name', '')}: ")
        elif isinstance(value, Table) and hasattr(value, "source"):
            yield here, _values(value), unit_of(key), str(value.source)
        elif isinstance(value, Table):
            yield from numbers(value, f"{here}.")
        elif isinstance(value, int | float) and not isinstance(value, bool) and hasattr(of, "source"):
            yield here, f"{value:g}", unit_of(key), str(of.source)


def _values(of: Table) -> str:
    """The numbers of a table with one source."""
    given = {key: getattr(of, key) for key in type(of).model_fields if key != "source"}
    numbers = (f"{key} {value:g}" for key, value in given.items() if isinstance(value, int | float))
    return ", ".join(numbers) or "; ".join(f"{key}: {value}" for key, value in given.items() if value)


def _compared(name: str, printer: Printer) -> tuple[str, ...]:
    envelope = printer.envelope_mm
    volume = "" if envelope is None else f"{envelope.x:g} × {envelope.y:g} × {envelope.z:g}"
    layers = ", ".join(f"{mode.layer_height_um:g}" for mode in printer.mode if mode.layer_height_um is not None)
    walls = (_ends(printer.smallest.wall_rigid_mm), _ends(printer.smallest.wall_soft_mm))
    return (
        f"[{name}](#{name})",
        plain(printer.title),
        printer.process,
        volume,
        layers,
        printer.accuracy_mm.text(),
        *walls,
    )


def _ends(size: FeatureSize | None) -> str:
    if size is None:
        return ""
    return f"{size.recommended:g}" if size.least is None else f"{size.least:g}, {size.recommended:g}"


def _curve(name: str, curve: MixingCurve) -> str:
    rows = [_point(point) for point in curve.points]
    head = ("volume fraction of the stiff resin", "its range", "shear modulus, MPa", "of the material", "source")
    facts = f"{plain(curve.title)}: {code(curve.soft)} with {code(curve.stiff)}. {plain(curve.assumption)}"
    return "\n\n".join([f"### {name}", facts, table(head, rows)])


def _point(point: MixingPoint) -> tuple[str, ...]:
    known = point.low == point.high
    modulus = "" if point.shear_modulus_MPa is None else f"{point.shear_modulus_MPa:g}"
    span = "" if known else f"{point.low:g} to {point.high:g}"
    return f"{point.fraction:g}", span, modulus, code(point.material or ""), plain(point.source)
