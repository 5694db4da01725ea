"""The datasheet: one HTML page and one PDF from the same content and the same figures."""

from __future__ import annotations

from pneutouch.evaluation.variants import ResinCurve, drawn_by, resin_curves
from pneutouch.export.scene import cut_open
from pneutouch.mechanics import Sensor
from pneutouch.report import curves, pages, relaxation
from pneutouch.report.certainty import ends, shares
from pneutouch.report.drawing import section_drawing
from pneutouch.report.graded_sheet import CAPTIONS, graded_figures
from pneutouch.report.picture import picture
from pneutouch.report.shares import share_bars
from pneutouch.report.sheet import Datasheet
from pneutouch.report.tradeoff import tradeoff_chart
from pneutouch.report.tuning import tuning_chart
from pneutouch.units import KPA

_LEAST_SPAN = 22 * KPA
"""The sensitivity plot reaches at least the paper's highest driving pressure."""


def datasheet(sheet: Datasheet, sensor: Sensor, viewer: str) -> dict[str, bytes]:
    """``datasheet.html`` and ``datasheet.pdf``; ``viewer`` is the page of the 3D view."""
    highest = max(sheet.prediction.states[-1].driving_pressure, _LEAST_SPAN)
    resins = resin_curves(sensor, sheet.resins, highest, sheet.prediction.model, sheet.prediction.closure)
    material = sheet.scene.membrane_material
    runs = relaxation.runs_of(sheet.prediction, material, sensor)
    ageing = relaxation.ageing_line(sheet.prediction, material, sensor)
    figures = _figures(sheet, resins, sensor)
    if not isinstance(runs, str):
        figures["held"] = relaxation.held_chart(runs, curves.SIZE)
        figures["loop"] = relaxation.loop_chart(runs, curves.SIZE)
    content = {**sheet.content(), "viscous": relaxation.section(runs, ageing), "figures": sorted(figures)}
    content["captions"] |= CAPTIONS
    content["captions"]["sensitivity"] = (
        f"Sensitivity over driving pressure for each resin in this geometry, this design picked out; {drawn_by(resins)}."
    )
    bodies = tuple(cut_open(solid.mesh(sheet.scene.mesh_tolerance / 6)) for solid in sheet.assembly.solids)
    return {
        "datasheet.html": pages.html("datasheet.html.j2", content, figures, viewer=viewer).encode(),
        "datasheet.pdf": pages.pdf(
            "datasheet.typ", content, figures, sheet.scene.design.document.date, {"picture.png": picture(bodies)}
        ),
    }


def _figures(sheet: Datasheet, resins: dict[str, ResinCurve], sensor: Sensor) -> dict[str, str]:
    """The figures as SVG by name; those without data are left out."""
    prediction, chosen = sheet.prediction, sheet.scene.membrane_material.title
    found = {
        "drawing": section_drawing(sheet.assembly),
        "inflation": curves.inflation(sensor, prediction),
        "sensitivity": curves.sensitivities(resins, chosen, sheet.published_kPa_per_N),
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
