"""Additions to a datasheet for a graded membrane: two pictures, and the constant mixes it is compared with."""

from pneutouch.evaluation.chart_data import ComparedMembrane
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.report.graded import grade_figures, graded_against_constant

CAPTIONS = {
    "grade-section": "Half sections of the wall: the stiff resin's share, laid droplet by droplet.",
    "grade-share": "Share of the stiff resin along the arc from the pole to the rim. The mixing curve behind it is "
    "assumed, see the sources.",
    "grade-modulus": "Modulus along the arc, and its mean.",
    "graded-sensitivity": "The graded membrane against constant ones of its size, all by the solid: as stiff "
    "throughout as at its softest, on average and at its stiffest. Sensitivity over driving pressure.",
    "graded-response": "The same membranes: response at the highest driving pressure.",
}


def graded_figures(sheet: SheetData) -> dict[str, str]:
    """The figures that `CAPTIONS` names as SVG for a graded membrane; nothing for any other."""
    if sheet.scene.membrane_material.along is None:
        return {}
    return {
        **grade_figures(sheet.scene.membrane_material, sheet.scene),
        **graded_against_constant(ComparedMembrane("graded", sheet.prediction.states), sheet.constants),
    }
