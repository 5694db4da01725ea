"""Charts of mixes and of the hard resins: curves of modulus over fraction, and sensitivity over published moduli."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.mixing import PRESSURES_KPA, RESINS, MixingCurves, curves, sensitivities
from release.tables.mixing_laws import THRESHOLD, hashin_shtrikman_low, percolation
from stored_pages import stored

from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.report.style import ACCENT, BOLD, FAINT, INK, LINES, MARKERS, MUTED, figure, halo, plain_ticks, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOT = Path(__file__).resolve().parents[3]
_COUNT = 401
_WIDEST = 0.7
"""Greatest fraction shown: the softest curve ends at 0.668."""

_LOOKS: dict[str, dict[str, Any]] = {
    "fraction": {"color": ACCENT, "lw": 2.2, "ls": "-"},
    "fraction_low": {"color": INK, "lw": 1.3, "ls": LINES[1]},
    "fraction_high": {"color": INK, "lw": 1.3, "ls": LINES[3]},
}


def mixing() -> str:
    """Shear modulus over fraction by every curve of the pair, with two limits of structure."""
    chart = curves(Library((ROOT,)))
    used = next(iter(chart.laws.values()))
    with figure(178, 105) as drawn:
        ax = drawn.add_subplot()
        _limits(ax, float(used.modulus[0]), chart.stiff)
        _curves(ax, chart)
        ax.set(yscale="log", xlim=(0, _WIDEST), ylim=(0.12, 40))
        ax.set(xlabel=f"volume fraction of {used.curve.stiff} in {used.curve.soft}  (-)", ylabel="shear modulus  (MPa)")
        plain_ticks(ax.yaxis)
        _points(ax, used, chart.names)
        return svg(drawn)


def _text(**more: Any) -> dict[str, Any]:
    return {"fontsize": 7, "color": INK, "path_effects": halo(), "zorder": 6, **more}


def _limits(ax: Axes, soft: float, stiff: float) -> None:
    """The softest isotropic mix, and droplets that touch: neither is data."""
    f = np.linspace(0.0, _WIDEST, _COUNT)
    look: dict[str, Any] = {"color": MUTED, "lw": 0.8, "ls": LINES[2], "zorder": 2}
    ax.plot(f, hashin_shtrikman_low(f, soft, stiff), **look)
    ax.text(0.5, 0.42, "softest isotropic mix: separate droplets", rotation=6, **_text(color=MUTED))
    beyond = f[f > THRESHOLD - 0.004]
    ax.plot(beyond, percolation(beyond, soft, stiff), **look)
    ax.text(THRESHOLD + 0.012, 31, f"glassy droplets that touch beyond {100 * THRESHOLD:g} %", **_text(color=MUTED))


def _curves(ax: Axes, chart: MixingCurves) -> None:
    used = next(iter(chart.laws.values()))
    names = used.curve.curves
    assert names is not None
    top = used.curve.points[-1].high
    along: Array = np.unique([*np.linspace(0.0, top, _COUNT), used.curve.common_top])
    low, high = (_band(used, along, side) for side in ("high", "low"))
    ax.fill_between(along, low, high, fc=FAINT, alpha=0.6, ec="none", zorder=1)
    for name, law in chart.laws.items():
        f = np.linspace(0.0, float(law.fraction[-1]), _COUNT)
        ax.plot(f, law.modulus_at(f), zorder=4, **_LOOKS[names.by_name[name]])
        at = (float(law.fraction[-1]), float(law.modulus[-1]))
        words = f"{name}\n(in use)" if law is used else name
        ax.annotate(words, at, xytext=(0, 6), textcoords="offset points", ha="center", va="bottom", **_text(**BOLD))


def _band(law: ResolvedMixingCurve, along: Array, side: str) -> Array:
    ends = [getattr(point, side) for point in law.curve.points]
    return np.asarray(np.exp(np.interp(along, ends, np.log(law.modulus))))


def _points(ax: Axes, law: ResolvedMixingCurve, names: tuple[str, ...]) -> None:
    """The catalogue's resins on the curve in use, each with its range from curve to curve."""
    for name, point, mu in zip(names, law.curve.points, law.modulus, strict=True):
        ax.plot([point.low, point.high], [mu, mu], color=INK, lw=0.6, zorder=3)
        ax.text(point.high + 0.012, float(mu), name, va="center", **_text())
    ax.plot(law.fraction, law.modulus, "o", color=INK, mfc="white", ms=4.2, zorder=5, clip_on=False)


def hard_resins() -> str:
    """Sensitivity over modulus for each resin, with the published moduli and the measured sensitivity."""
    library, found, moduli = Library((ROOT,)), stored("mixing")["hard_resins"], np.geomspace(2.0, 13.0, 40)
    curves = sensitivities(list(moduli), library)
    with figure(165, 78) as drawn:
        for ax, name in zip(drawn.subplots(1, 2, sharey=True), RESINS, strict=True):
            measured = library.load("materials", name).measured
            known = (measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal)
            for k, pressure in enumerate(PRESSURES_KPA):
                ax.plot(moduli, curves[:, k], color=FAINT, ls=LINES[k], lw=1.2, label=f"model, {pressure:g} kPa")
                ax.axhline(known[k], color=MUTED, ls=LINES[k], lw=0.9, label=f"measured, {pressure:g} kPa")
            for marker, row in zip(MARKERS, (row for row in found if row["resin"] == name), strict=False):
                _mark(ax, row, marker)
            ax.set(xscale="log", xlim=(2.0, 13.0), ylim=(0.0, 1.15), xlabel="shear modulus  (MPa)", title=name)
            ax.set_xticks([2, 3, 4, 6, 8, 12], ["2", "3", "4", "6", "8", "12"])
            ax.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
        drawn.axes[0].set_ylabel("sensitivity  (kPa/N)")
        handles, labels = drawn.axes[0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=6.5)
        return svg(drawn)


def _mark(ax: Axes, row: dict[str, Any], marker: str) -> None:
    """One published modulus: on both curves, named by its source."""
    ends, values = row["ends_MPa"], np.array(row["kPa_per_N"])
    used = row["origin"].startswith("**")
    for k in (0, 1):
        look = {"color": ACCENT if used else INK, "mfc": (ACCENT if used else INK) if k == 0 else "white"}
        label = row["name"] if k == 0 else None
        ax.plot(ends, values[:, k], marker=marker, ms=6 if used else 4, lw=0.9, ls=LINES[k], label=label, **look)


CHARTS: dict[str, Callable[[], str]] = {"mixing": mixing, "hard-resins": hard_resins}
