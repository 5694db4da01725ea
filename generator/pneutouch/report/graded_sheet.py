"""What a datasheet adds for a graded membrane: two pictures, and the constant mixes it is compared with."""

from pneutouch.evaluation.chart_data import ComparedMembrane
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.report.graded import grade_section, graded_against_constant

CAPTIONS = {
    "grade": "Graded membrane: the stiff resin's share of the wall, laid droplet by droplet; next to it share and "
    "modulus along the arc from the pole to the rim. The mixing curve behind it is assumed, see the sources.",
    "graded": "The graded membrane against constant ones of its size, all by the solid: as stiff throughout as at its "
    "softest, on average and at its stiffest. Left the sensitivity over the driving pressure, right the response at "
    "the highest.",
}


def graded_figures(sheet: SheetData) -> dict[str, str]:
    """Figures ``grade`` and ``graded`` as SVG for a graded membrane; nothing for any other."""
    if sheet.scene.membrane_material.along is None:
        return {}
    return {
        "grade": grade_section(sheet.scene.membrane_material, sheet.scene),
        "graded": graded_against_constant(ComparedMembrane("graded", sheet.prediction.states), sheet.constants),
    }
