"""A fitted material as text for people."""

from typing import Any

from pneutouch.cli.table import table_text


def fit_text(document: dict[str, Any]) -> str:
    """The law, the modulus, and how far each law is off."""
    law = document["law"]
    rows = [
        [
            "->" if fit["label"] == law["label"] else "",
            fit["label"],
            f"{fit['misfit_percent']:.1f} %",
            ", ".join(
                f"{value:.4g} ± {error:.1g}"
                for value, error in zip(fit["constants"], fit["uncertainties"], strict=True)
            ),
            fit["refused"] or "",
        ]
        for fit in document["fits"]
    ]
    head = ["", "law", "misfit", "constants (MPa; Ogden: mu, alpha), k = 2", ""]
    specimens = [
        f"{one['data']}: {one['points']} points, slack {one['slack_percent']:.2g} %, shear modulus "
        f"{one['shear_modulus_MPa']:.4g} MPa"
        for one in document["specimens"]
    ]
    lines = [
        f"{document['material']}: {law['label']}, within {law['misfit_percent']:.2g} % up to a stretch of "
        f"{document['largest_stretch']:.3g}; shear modulus at small strain "
        f"{document['shear_modulus_small_strain_MPa']:.4g} MPa",
        f"neo-Hookean over the same stretches: {document['shear_modulus_MPa']:.4g} MPa",
        *specimens,
    ]
    return "\n\n".join(["\n".join(lines), table_text(head, rows)])
