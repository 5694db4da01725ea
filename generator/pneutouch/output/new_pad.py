"""A new pad: its file, and the design of its cell beside it, sized for the pitch."""

import math
from contextlib import suppress
from pathlib import Path
from typing import Any

from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.errors import InputError
from pneutouch.output.new import (
    PRINTED_PORT,
    check_free,
    drawn,
    new_design,
    process_values,
    usual_pressures_kPa,
    write_design,
)
from pneutouch.parts import assemble
from pneutouch.parts.pad import lay_out_pad
from pneutouch.spec.design import DesignFile
from pneutouch.spec.material import Material
from pneutouch.spec.pad import PadFile, PadTable
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import Changes, override, validate
from pneutouch.spec.toml_text import design_template

_PARTS = (("glued-flange", PRINTED_PORT), ("glued-flange-narrow", PRINTED_PORT), ("glued-flange-narrow", "barb-3x2"))
"""Seats and ports of a new cell, the widest first; the wall of the last one's tip is for PolyJet alone."""
_SHARE, _WALL, _THICK = 0.42, 0.16, 0.3
"""Outer radius of a new dome over the pitch, so that pressed neighbours do not meet; its wall over its inner radius,
and the greatest share of the outer radius at which the wall that the printer recommends is taken: own choice."""


def new_pad(
    name: str,
    folder: Path,
    layout: str,
    pitch_mm: float | None,
    process: str | None = None,
    material: str | None = None,
    changes: Changes | None = None,
    shape: str | None = None,
) -> tuple[Path, Path, str | None]:
    """Write ``folder/pads/name.toml`` and the design of its cell, ``folder/name-cell.toml``; never over a file.

    Returns both paths and the note on the profile of `new_design`. ``changes`` and ``shape`` are of the cell. Raises
    InputError."""
    table: dict[str, Any] = {"cell": f"{name}-cell", "layout": layout}
    table |= {} if pitch_mm is None else {"pitch_mm": pitch_mm}
    file = validate(PadFile, {"pad": table}, name)
    check_free(name, folder / "pads", kind="pads")
    check_free(f"{name}-cell", folder)
    library = Library.default()
    values = process_values(process, material, library)
    printer: Printer = library.load("printers", values["print"]["profile"])
    if printer.is_casting:
        remedy = "take polyjet, filament or resin"
        raise InputError("the membrane of a pad is printed", key="process", value=process, remedy=remedy)
    given, pitch = changes or {}, file.pad.pitch_mm
    own = _cell(file.pad, values, printer, given, library, shape)
    if own is None:
        wider = (file.pad.model_copy(update={"pitch_mm": 0.5 * half}) for half in range(math.ceil(2 * pitch), 201))
        least = next((one.pitch_mm for one in wider if _cell(one, values, printer, given, library, shape)), None)
        remedy = "give another process" if least is None else f"give at least {least:g} mm, or another process"
        raise InputError("too small for a cell of this printer", key="pitch", value=pitch, remedy=remedy)
    cell, note = new_design(f"{name}-cell", folder, process, material, own)
    kept = f"The cell is the design {name}-cell; every other key may be left out."
    text = design_template(name, {"pad": {**table, "pitch_mm": pitch}}, kept, PadFile)
    return write_design(name, folder / "pads", text, "pads"), cell, note


def _cell(
    pad: PadTable, values: dict[str, Any], printer: Printer, changes: Changes, library: Library, shape: str | None
) -> dict[str, Any] | None:
    """Changes of the values of a new design that make it a cell of a pad, with the first of `_PARTS` for which there is
    space on the manifold and on a connector of its own; None if there is none."""
    sizes = _sizes(pad.pitch_mm, printer)
    if sizes is None:
        return None
    own: dict[str, Any] = {**sizes, "connector.mount": "plain"}
    rigid: Material = library.load("materials", "VeroClear")
    if printer.mode_for(rigid) is not None:
        # A filament printer's spigots would be as coarse as the channels in them.
        own |= {"connector.material": "VeroClear", "print.connector_profile": values["print"]["profile"]}
    own |= drawn({**sizes, **changes}, shape, None) or {}
    source = DesignSource("cell", override(values, own, DesignFile), "cell")
    soft: Material = library.load("materials", values["membrane"]["material"])
    try:
        usual = source.changed({})
    except InputError:
        if shape is None:
            raise
        # Sizes of a shape in proportion to the radius have no space for the printer's wall.
        return None
    pressures_kPa = usual_pressures_kPa(soft, usual) or usual.pneumatics.driving_pressures_kPa
    own.setdefault("pneumatics.driving_pressures_kPa", pressures_kPa)
    for seat, port in _PARTS[: None if printer.process == "polyjet" else 2]:
        parts = {"connector.seat": seat, "connector.port": port, **own}
        with suppress(InputError):
            scene = load_scene(DesignSource("cell", values, "cell"), parts, library)
            assemble(scene)
            lay_out_pad(scene, pad, "pad")
            return parts
    return None


def _sizes(pitch_mm: float, printer: Printer) -> dict[str, float] | None:
    """Radius and wall of a dome for a pitch, by key; None if the printer's least wall leaves no dome."""
    outer, feature = _SHARE * pitch_mm, printer.smallest.wall("elastomer")
    least = feature.recommended if feature.recommended <= _THICK * outer else feature.least or feature.recommended
    wall = max(least, _WALL / (1.0 + _WALL) * outer)
    radius = math.floor(100.0 * (outer - wall)) / 100.0
    return {"membrane.inner_radius_mm": radius, "membrane.wall_thickness_mm": round(wall, 2)} if radius >= 1.0 else None
