"""The datasheet: one HTML page and one PDF from the same content and the same figures."""

import base64

from pneutouch.evaluation.sheet_data import ContactChart, SheetData
from pneutouch.export.scene import view_data
from pneutouch.report import curves, pages
from pneutouch.report.anywhere import contact_figures
from pneutouch.report.certainty import ends, share_bars, shares
from pneutouch.report.drawing import section_drawing
from pneutouch.report.graded import CAPTIONS, graded_figures
from pneutouch.report.mould import CAPTION as MOULD_CAPTION
from pneutouch.report.mould import mould_rows, mould_section
from pneutouch.report.pictures import caption, picture, pressed_figure, shown
from pneutouch.report.sheet import content_of
from pneutouch.report.tradeoff import tradeoff_chart, tuning_chart

_PIXELS = (900, 640)
"""Width and height of the picture."""


def datasheet(sheet: SheetData) -> dict[str, bytes]:
    """``datasheet.html``, with the 3D view and, where that cannot be drawn, a picture; and ``datasheet.pdf``."""
    figures = _figures(sheet)
    viscous = curves.section(sheet.viscous, curves.ageing_line(sheet))
    content = {**content_of(sheet), "viscous": viscous}
    content["captions"] |= CAPTIONS
    content["captions"]["sensitivity"] = (
        "Sensitivity over driving pressure for each resin in this geometry, this design picked out; "
        f"{curves.drawn_by(sheet.resin_curves)}."
    )
    bodies = shown(sheet.assembly, _PIXELS[0])
    images = {"picture.png": picture(bodies, *_PIXELS)}
    more = {"view": view_data(bodies), "picture": _base64(images["picture.png"]), "pressed_view": ""}
    if sheet.pressed is not None:
        drawn = pressed_figure(sheet.pressed)
        figures["pressure-scale"] = drawn.scale
        images["pressed.png"] = drawn.image
        more |= {"pressed_view": drawn.data, "pressed_picture": _base64(drawn.image)}
        content["captions"]["pressed"] = caption(sheet.pressed)
    mould = sheet.assembly.mould
    content["mould"] = [] if mould is None else mould_rows(mould)
    if mould is not None:
        figures["mould"], content["captions"]["mould"] = mould_section(mould), MOULD_CAPTION
    content["figures"] = sorted(figures)
    return {
        "datasheet.html": pages.html("datasheet.html.j2", content, figures, **more).encode(),
        "datasheet.pdf": pages.pdf("datasheet.typ", content, figures, sheet.scene.design.document.date, images),
    }


def _base64(image: bytes) -> str:
    return base64.b64encode(image).decode()


def _figures(sheet: SheetData) -> dict[str, str]:
    """The figures as SVG by name; those without data are left out."""
    prediction, chosen = sheet.prediction, sheet.scene.membrane_material.title
    figures = {
        **section_drawing(sheet.assembly, sheet.object_section),
        "inflation": curves.inflation(prediction),
        "sensitivity": curves.sensitivities(sheet.resin_curves, prediction, chosen, sheet.published_kPa_per_N),
        "response": curves.response(prediction),
        "indentation": curves.indentation(prediction),
    }
    covered = ends(prediction, sheet.uncertainty)
    if covered:
        figures["shares"] = share_bars(shares(covered))
    if sheet.tradeoff is not None:
        figures["tradeoff"] = tradeoff_chart(sheet.tradeoff, curves.SIZE)
    if sheet.tuning is not None:
        figures["tuning"] = tuning_chart(sheet.tuning, curves.SIZE)
    if prediction.states[0].shapes:
        figures |= {f"shape-{k + 1}": text for k, text in enumerate(curves.shapes(prediction))}
    if isinstance(sheet.contact, ContactChart):
        figures |= contact_figures(sheet.contact)
    if sheet.viscous_curves is not None:
        figures["held"] = curves.held_chart(sheet.viscous_curves, curves.SIZE)
        figures["loop"] = curves.loop_chart(sheet.viscous_curves, curves.SIZE)
    return figures | graded_figures(sheet)
