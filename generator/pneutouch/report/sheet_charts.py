"""The charts of a datasheet: a function each, which returns its plot with a caption, or None without data."""

from dataclasses import replace

from pneutouch.evaluation.sheet_data import SensitivityCurve, SheetData
from pneutouch.report import curves
from pneutouch.report.blocks import Plot
from pneutouch.report.chart import PlotLine, drawn_svg
from pneutouch.report.prose import front_error
from pneutouch.report.style import FAINT
from pneutouch.report.tradeoff import tradeoff_panel, tuning_panel
from pneutouch.units import KPA, ML


def sensitivity(sheet: SheetData) -> Plot:
    """Sensitivity over driving pressure in every resin, this design emphasized."""
    chosen = sheet.scene.membrane_material.title
    panel = curves.resin_sensitivities(sheet.resin_curves, sheet.prediction, chosen, sheet.published_kPa_per_N)
    words = "Sensitivity over driving pressure for each resin in this geometry, this design picked out; "
    return Plot(drawn_svg(panel), f"{words}{drawn_by(sheet.resin_curves)}.")


def drawn_by(curves: dict[str, SensitivityCurve]) -> str:
    """Words on the models that computed the curves, and on which of the resins by the solid."""
    models = sorted({curve.model for curve in curves.values()})
    if not models:
        return "no curve of a resin was computed"
    if len(models) == 1:
        return f"drawn by the {models[0]}"
    solid = ", ".join(title for title, curve in curves.items() if curve.model == "solid")
    looked_up = next(model for model in models if model != "solid")
    return f"drawn by the {looked_up}, {solid} by the solid"


def inflation(sheet: SheetData) -> Plot:
    """Driving pressure over inner apex height."""
    words = "Inflation: driving pressure over apex height; dashed beyond the limit point."
    return Plot(drawn_svg(curves.inflation(sheet.prediction)), words)


def response(sheet: SheetData) -> Plot:
    """Pressure rise over contact force, with the lines whose slope is the sensitivity."""
    panel, fits = curves.rises(_presses(sheet)), []
    for f in (state.figures for state in sheet.prediction.states if state.figures is not None):
        fit_kPa = [f.intercept_kPa + f.sensitivity * force for force in f.force_range]
        fits.append(PlotLine(f.force_range, fit_kPa, tone=FAINT, width=0.8, over=1))
    words = "Response: pressure rise over contact force at each driving pressure, with the fitted lines."
    return Plot(drawn_svg(replace(panel, lines=(*panel.lines, *fits))), words)


def indentation(sheet: SheetData) -> Plot:
    """Contact force over indentation."""
    words = "Contact force over indentation at each driving pressure."
    return Plot(drawn_svg(curves.forces(_presses(sheet))), words)


def _presses(sheet: SheetData) -> list[curves.Press]:
    states = sheet.prediction.states
    return [curves.predicted_press(s, curves.state_look(k, s.driving_pressure / KPA)) for k, s in enumerate(states)]


def tuning(sheet: SheetData) -> Plot | None:
    """Sensitivity of this design over the driving pressure, with its interval; None outside the atlas."""
    if sheet.tuning is None:
        return None
    # The solid's ratio makes the atlas's plate without friction any other contact.
    ratio = " times the solid's ratio of this contact to a plate without friction" if sheet.other_contact else ""
    words = (
        "Tuning: sensitivity of this design from no driving pressure to its rated one (its highest stated one where "
        f"that is above), by the atlas{ratio}, with its k = 2 interval (grey); circles: the predicted states."
        + (
            " Squares: states by injected gas or height, on to beyond the limit point."
            if sheet.prediction.filled
            else ""
        )
    )
    return Plot(drawn_svg(tuning_panel(sheet.tuning)), words)


def tradeoff(sheet: SheetData) -> Plot | None:
    """Greatest force range at each sensitivity, a line for each resin; None outside the atlas."""
    chart, note = sheet.tradeoff, sheet.assembly.dead_volume_note
    if chart is None:
        return None
    model = "by the atlas; no line crosses a limit"
    if chart.errors is not None:
        model = (
            "under this design's contact, by the atlas corrected by the solid at five to nine places of each line, "
            f"{front_error(chart.errors)}; limits as under a plate without friction"
        )
    words = (
        f"Trade-off at {chart.driving_pressure_kPa:g} kPa: the greatest force range that goes with each sensitivity, "
        "one line for each resin of this printer with the sensitivities it reaches, wall and radius free to 60 mm, "
        f"{sheet.prediction.dead_volume / ML:.3g} mL dead volume{f' ({note})' if note else ''}, {model}."
    )
    return Plot(drawn_svg(tradeoff_panel(chart)), words)


def no_tradeoff(sheet: SheetData) -> str:
    """Reason why trade-off and tuning are not drawn; empty where they are."""
    if sheet.tradeoff is not None:
        return ""
    resin, why = sheet.scene.membrane_material, "the prediction has no figures at the highest driving pressure"
    if sheet.prediction.states[-1].figures is not None:
        why = "the atlas does not answer for the sensor"
    if resin.law is not None:
        why = "the atlas has no fitted laws"
    why = next((one.unknown for one in sheet.uncertainty if one.unknown is not None), why)
    return f"Trade-off and tuning charts are not drawn: {'the atlas has no graded membranes' if resin.along else why}."
