"""A higher law against the neo-Hookean one up to the limit point, as in the paper's figure 3(b)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from benchmarks.scenes import MOONEY_RIVLIN_AGILUS30, OGDEN_AGILUS30, PAPER
from pneutouch.mechanics.laws import Hyperelastic, hyperelastic, neo_hookean
from pneutouch.mechanics.solid.inflate import Inflation, inflate
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.report.style import ACCENT, INK, LINES, MUTED, figure, svg

NU = 0.49
_CHAIN_MU, _CHAIN_LIMIT = 0.273, 9.26
"""Equilibrium network of a Bergstroem-Boyce fit to Agilus30 (same repository): eight chains, MPa and limiting stretch."""


def eight_chains(mu: float, limit: float) -> tuple[float, float, float]:
    """Yeoh constants of the first three terms of the eight-chain (Arruda-Boyce) energy."""
    second, third = 1 / (20 * limit**2), 11 / (1050 * limit**4)
    return mu * (0.5 + 6 * second + 27 * third), mu * (second + 9 * third), mu * third


LAWS: dict[str, Hyperelastic] = {
    "neo-Hookean": neo_hookean(1.0, NU),
    "eight chains as Yeoh (Agilus30, long-term)": hyperelastic("yeoh", eight_chains(_CHAIN_MU, _CHAIN_LIMIT), NU),
    "Ogden, one term (Agilus30, instantaneous)": hyperelastic(*OGDEN_AGILUS30, NU),
    "Mooney-Rivlin (Agilus30, instantaneous)": hyperelastic(*MOONEY_RIVLIN_AGILUS30, NU),
}


@dataclass(frozen=True)
class Curve:
    """An inflation of the paper's dome: p R0/(mu t0) over h/R0, and its limit point where there is one."""

    height: np.ndarray
    pressure: np.ndarray
    limit: tuple[float, float] | None


def curves() -> dict[str, Curve]:
    """Each law's inflation, normalised by its own small-strain modulus."""
    found = {}
    for name, law in LAWS.items():
        run: Inflation = inflate(
            SolidModel(dome(PAPER.dome.inner_radius, PAPER.dome.wall_thickness), law), past_limit=1.5, largest=8.0
        )
        scale = PAPER.dome.inner_radius / (law.mu * PAPER.dome.wall_thickness)
        limit = (
            None if run.limit is None else (run.limit.inner_apex / PAPER.dome.inner_radius, run.limit.pressure * scale)
        )
        volume = np.linspace(run.volume[0], run.volume[-1], 200)
        height = PchipInterpolator(run.volume, [s.inner_apex for s in run.states])(volume) / PAPER.dome.inner_radius
        pressure = CubicHermiteSpline(run.volume, run.pressure, [s.stiffness for s in run.states])(volume)
        found[name] = Curve(height, pressure * scale, limit)
    return found


def draw(found: dict[str, Curve]) -> str:
    """The curves."""
    with figure(165, 72) as drawn:
        ax = drawn.add_subplot()
        for k, (name, curve) in enumerate(found.items()):
            colour = (ACCENT, INK, INK, MUTED)[k]
            ax.plot(curve.height, curve.pressure, color=colour, ls=LINES[k], lw=1.5, label=name)
            if curve.limit:
                ax.plot(*curve.limit, "D", color=colour, ms=4)
        ax.set(
            xlabel="inner apex height / R0  (-)", ylabel="pressure x R0 / (mu t0)  (-)", xlim=(1.0, 2.4), ylim=(0, 3.2)
        )
        ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=6.5)
        return svg(drawn)


def section(found: dict[str, Curve]) -> list[str]:
    """The comparison on the page."""
    plain = found["neo-Hookean"]
    assert plain.limit is not None
    rows = []
    for name, curve in found.items():
        rising = plain.height <= plain.limit[0]
        there = np.interp(plain.height[rising], curve.height, curve.pressure)
        differ = np.max(np.abs(there - plain.pressure[rising])) / plain.limit[1]
        point = "none" if curve.limit is None else f"{curve.limit[1]:.4f} at {curve.limit[0]:.4f}"
        rows.append(f"| {name} | {point} | {differ:.1%} |")
    return [
        "## Neo-Hookean against other laws",
        "",
        "The paper compares its neo-Hookean wall with an Ogden law (Figure 3b) and finds almost no difference below the limit point. It does not "
        "publish the constants. The comparison here uses sets of Agilus30 from the repository alexdummer/dogbone-experiments (CU Boulder, data "
        "unreviewed), each normalised by its own small-strain modulus, so that only the shape counts:",
        "",
        "- the long-term network of a Bergstroem-Boyce fit: eight chains, mu 0.273 MPa, limiting stretch 9.26, its first three terms as a "
        "Yeoh law;",
        "- an instantaneous Ogden set, mu 1.423 MPa, alpha -3.68 in the 2 mu/alpha^2 convention (fit to 37 % strain, R2 0.60);",
        "- an instantaneous Mooney-Rivlin set, C1 0.248, C2 0.984 MPa.",
        "",
        "![Inflation of the paper's dome by four laws: dimensionless pressure over apex height](laws.svg)",
        "",
        "| law | limit point, p R0/(mu t0) at h/R0 | greatest difference below the neo-Hookean limit, of its pressure |",
        "|---|---|---|",
        *rows,
        "",
        "The long-term network confirms the paper's result. The two instantaneous sets stiffen the dome well below the limit point and remove it. "
        "The dome passes 37 % strain near h/R0 = 1.28; beyond that the Ogden curve is an extrapolation. A law fitted to small strains must not be used for "
        "the limit point.",
        "",
    ]
