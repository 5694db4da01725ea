"""The datasheet: one HTML page and one PDF from the same content and the same figures."""

from __future__ import annotations

import base64
import datetime
import json
import tempfile
from pathlib import Path
from typing import Any

from pneutouch.export.scene import cut_open
from pneutouch.mechanics import Sensor
from pneutouch.report import curves
from pneutouch.report.certainty import ends, shares
from pneutouch.report.drawing import section_drawing
from pneutouch.report.graded_sheet import CAPTIONS, graded_figures
from pneutouch.report.picture import picture
from pneutouch.report.shares import share_bars
from pneutouch.report.sheet import Sheet
from pneutouch.report.style import FONTS
from pneutouch.report.tradeoff import tradeoff_chart
from pneutouch.report.tuning import tuning_chart
from pneutouch.report.variants import ResinCurve, drawn_by, resin_curves
from pneutouch.units import KPA

TEMPLATES = Path(__file__).parent / "templates"

_UNDATED = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC)
"""Creation time in the PDF of an undated sheet: the clock must not change the bytes."""

_LEAST_SPAN = 22 * KPA
"""The sensitivity plot reaches at least the paper's highest driving pressure."""


def datasheet(sheet: Sheet, sensor: Sensor, viewer: str) -> dict[str, bytes]:
    """``datasheet.html`` and ``datasheet.pdf``; ``viewer`` is the page of the 3D view."""
    highest = max(sheet.prediction.states[-1].driving_pressure, _LEAST_SPAN)
    resins = resin_curves(sensor, sheet.resins, highest, sheet.prediction.model, sheet.prediction.closure)
    figures = _figures(sheet, resins, sensor)
    content = {**sheet.content(), "figures": sorted(figures)}
    content["captions"] |= CAPTIONS
    content["captions"]["sensitivity"] = (
        f"Sensitivity over driving pressure for each resin in this geometry, this design picked out; {drawn_by(resins)}."
    )
    bodies = tuple(cut_open(solid.mesh(sheet.scene.mesh_tolerance / 6)) for solid in sheet.assembly.solids)
    return {
        "datasheet.html": _html(content, figures, viewer).encode(),
        "datasheet.pdf": _pdf(content, figures, picture(bodies), sheet.scene.design.document.date),
    }


def _figures(sheet: Sheet, resins: dict[str, ResinCurve], sensor: Sensor) -> dict[str, str]:
    """The figures as SVG by name; those without data are left out."""
    prediction, chosen = sheet.prediction, sheet.scene.membrane_material.title
    found = {
        "drawing": section_drawing(sheet.assembly),
        "inflation": curves.inflation(sensor, prediction),
        "sensitivity": curves.sensitivities(resins, chosen, sheet.published()),
        "response": curves.response(prediction),
        "indentation": curves.indentation(prediction),
    }
    known = ends(prediction, sheet.uncertainty)
    if known:
        found["shares"] = share_bars(shares(known))
    if sheet.tradeoff is not None:
        found["tradeoff"] = tradeoff_chart(sheet.tradeoff, curves.SIZE)
    if sheet.tuning is not None:
        found["tuning"] = tuning_chart(sheet.tuning, curves.SIZE)
    if prediction.states[0].shapes:
        found["shapes"] = curves.shapes(prediction)
    return found | graded_figures(sheet.scene, sensor, prediction)


def _html(content: dict[str, Any], figures: dict[str, str], viewer: str) -> str:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    fonts = {
        name: base64.b64encode((FONTS / f"Inter-{name}.otf").read_bytes()).decode() for name in ("Regular", "SemiBold")
    }
    safe = {name: Markup(text) for name, text in figures.items()}  # our own SVG
    return environment.get_template("datasheet.html.j2").render(sheet=content, figures=safe, viewer=viewer, fonts=fonts)


def _pdf(content: dict[str, Any], figures: dict[str, str], image: bytes, date: datetime.date | None) -> bytes:
    """Set the PDF with Typst, a compiler in one wheel: no system packages, no system fonts."""
    import typst

    created = datetime.datetime(date.year, date.month, date.day, tzinfo=datetime.UTC) if date else _UNDATED
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "datasheet.typ").write_bytes((TEMPLATES / "datasheet.typ").read_bytes())
        (root / "sheet.json").write_text(json.dumps(content), encoding="utf-8")
        (root / "picture.png").write_bytes(image)
        for name, text in figures.items():
            (root / f"{name}.svg").write_text(text, encoding="utf-8")
        return bytes(
            typst.compile(
                root / "datasheet.typ", root=root, font_paths=[FONTS], ignore_system_fonts=True, timestamp=created
            )
        )
