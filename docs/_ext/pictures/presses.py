"""Charts of presses, drawn from the stored measurements: friction, Table S1 and its protocol, sway and the atlas."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from stored_pages import stored

from pictures.outcomes import draw_outcomes
from pneutouch.arrays import Array
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, legend_above, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Rows = list[dict[str, Any]]

FRICTIONS = ("0", "0.3", "0.6", "1", "grip")
LOOP_FRICTIONS = ("0.1", *FRICTIONS[1:])
_PLACES = {"grip": 1.4}
"""Where grip stands on the axis of coefficients."""

_WIDTH = 0.6
"""Of the five frictions of one resin, in resins."""

_MARKS = ("o", "v", "^", "s", "P")

_KEYS = {"0": "default", "0.3": "friction 0.3", "0.6": "friction 0.6", "1": "friction 1.0", "grip": "friction grip"}
"""Assumptions of the stored cells by coefficient."""

OUTCOMES: dict[str, dict[str, Any]] = {
    "sway first": {"marker": "s", "color": INK, "ms": 5},
    "lobes first": {"marker": "^", "color": INK, "ms": 5.5},
    "jump as a body of revolution first": {"marker": "x", "color": INK, "ms": 5},
    "axisymmetric to 0.75 R0": {"marker": "o", "color": MUTED, "mfc": "white", "ms": 5},
    "no such state": {"marker": "_", "color": MUTED, "ms": 5},
}


def friction() -> str:
    """Change of the sensitivity, and the width of the loop, over the coefficient."""
    data = stored("friction")
    with figure(178, 78) as drawn:
        left, right = drawn.subplots(1, 2)
        resins = list(dict.fromkeys(row["resin"] for row in data["sensitivity"]))
        colours = dict(zip(resins, (ACCENT, INK, MUTED) * 2, strict=False))
        for row in data["sensitivity"]:
            values = np.array(row["sensitivity_kPa_per_N"], float)
            kept = row["driving_pressure_kPa"] == 0
            look = {"color": colours[row["resin"]], "ls": LINES[0 if kept else 1], "ms": 3.5, "lw": 1.0}
            marker = MARKERS[resins.index(row["resin"])]
            left.plot(
                _places(FRICTIONS), 100 * (values / values[0] - 1), marker=marker, mfc=None if kept else "white", **look
            )
        for row in data["loops"]:
            widths = [shares[0] for shares in row["loop_percent"]]
            look = {"color": colours[row["resin"]], "marker": MARKERS[resins.index(row["resin"])], "ms": 3.5, "lw": 1.0}
            right.plot(_places(LOOP_FRICTIONS), widths, label=row["resin"], **look)
        for ax in (left, right):
            ax.set_xticks(_places(FRICTIONS), FRICTIONS)
            ax.set_xlabel("coefficient of friction  (-)")
        left.set_ylabel("change of the sensitivity  (%)")
        right.set(ylabel="width of the loop over full scale  (%)", ylim=(0, None))
        drawn.legend(*right.get_legend_handles_labels(), loc="outside lower center", ncols=6, fontsize=6.5)
        return svg(drawn)


def _places(frictions: tuple[str, ...]) -> list[float]:
    return [_PLACES.get(friction) or float(friction) for friction in frictions]


def table_s1() -> str:
    """Every cell of Table S1 by friction, with the span of all single changes; a panel for each driving pressure."""
    rows = stored("table-s1")["cells"]
    pressures = sorted({row["driving_pressure_kPa"] for row in rows})
    with figure(175.0, 80.0) as drawn:
        panels = drawn.subplots(1, len(pressures), sharey=True)
        for ax, pressure in zip(panels, pressures, strict=True):
            _cells_panel(ax, [row for row in rows if row["driving_pressure_kPa"] == pressure], pressure)
        panels[0].set_ylabel("sensitivity  (kPa/N)")
        legend_above(panels[0], columns=len(FRICTIONS) + 2)
        return svg(drawn)


def _cells_panel(ax: Axes, rows: Rows, pressure: float) -> None:
    for k, row in enumerate(rows):
        values = np.array([value for value, *_ in row["cells"].values()])
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        ax.bar(
            k,
            high - low,
            bottom=low,
            width=0.85,
            fc=FAINT,
            ec="none",
            alpha=0.7,
            zorder=1,
            label=_once(k, "one change"),
        )
        for friction, mark, place in zip(FRICTIONS, _MARKS, np.linspace(-0.5, 0.5, len(FRICTIONS)), strict=True):
            label = friction if friction == "grip" else f"friction {friction}"
            here = (k + _WIDTH * place, row["cells"][_KEYS[friction]][0])
            ax.plot(*here, mark, color=INK, mfc="white", mew=0.7, ms=3.6, ls="none", zorder=3, label=_once(k, label))
        ax.plot(
            k, row["measured_kPa_per_N"], "D", color=ACCENT, ms=4.5, ls="none", zorder=2, label=_once(k, "measured")
        )
    ax.set_xticks(range(len(rows)), [row["material"].removesuffix("-DM") for row in rows], rotation=40, ha="right")
    ax.set(title=f"{pressure:g} kPa", xlabel="resin", ylim=(0, None))


def _once(k: int, label: str) -> str | None:
    return label if k == 0 else None


def protocol() -> str:
    """Table S1 and its ratios beside those predicted for each resin from the other six; priors and posteriors."""
    found = stored("protocol")["summary"]
    with figure(178.0, 150.0) as drawn:
        axes = drawn.subplot_mosaic([[0, 1, 2], [3, 3, 3]], height_ratios=(1.0, 1.6))
        titles = ("S at 0 kPa  (kPa/N)", "S at 22 kPa  (kPa/N)", "S(22) / S(0)")
        for k, title in enumerate(titles):
            _predicted_panel(axes[k], found, k)
            axes[k].set(title=title, ylim=(0.0 if k < 2 else 0.5, None))
        _unknowns_panel(axes[3], found["unknowns"])
        labels = [axes[k].get_legend_handles_labels() for k in (0, 3)]
        handles, texts = ([*one, *other] for one, other in zip(*labels, strict=True))
        drawn.legend(handles, texts, loc="outside upper center", ncols=5)
        return svg(drawn)


def _predicted_panel(ax: Axes, found: dict[str, Any], k: int) -> None:
    measured = np.array(found["measured"])[:, k]
    low, middle, high = (np.array(found["left_out"][key])[:, k] for key in ("low", "middle", "high"))
    errors = np.array(found["default"]["cells"])
    off = errors[:, k] if k < 2 else np.array(found["default"]["ratios"])
    at = np.arange(measured.size)
    ax.bar(at, high - low, bottom=low, width=0.6, fc=FAINT, ec="none", label="predicted from the others, 90 %")
    ax.plot(at, middle, "_", color=INK, ms=8, ls="none")
    ax.plot(at, measured * (1.0 + off), "o", color=INK, mfc="white", mew=0.7, ms=3.8, ls="none", label="default")
    ax.plot(at, measured, "D", color=ACCENT, ms=4.2, ls="none", label="measured")
    ax.set_xticks(at, [title.removesuffix("-DM") for title in found["resins"]], rotation=40, ha="right")


def _unknowns_panel(ax: Axes, rows: Rows) -> None:
    """Intervals of 90 % as shares of the prior's; ends of the prior as text."""
    for k, row in enumerate(rows):
        prior, posterior = (np.array(row[key]) for key in ("prior", "posterior"))
        if row["logarithmic"]:
            prior, posterior = np.log(prior), np.log(posterior)
        low, middle, high = (posterior - prior[0]) / (prior[2] - prior[0])
        ax.plot([0.0, 1.0], [-k, -k], color=FAINT, lw=5.0, solid_capstyle="butt", label=_once(k, "prior, 90 %"))
        ax.plot([low, high], [-k, -k], color=ACCENT, lw=1.8, label=_once(k, "posterior, 90 %"))
        ax.plot(middle, -k, "o", color=ACCENT, ms=3.8, ls="none")
        for place, value, side in ((-0.06, row["prior"][0], "right"), (1.06, row["prior"][2], "left")):
            ax.text(place, -k, f"{value:.3g}", ha=side, va="center", fontsize=6.5, color=MUTED)
    ax.set_yticks([-k for k in range(len(rows))], [row["name"] for row in rows], fontsize=6.5)
    ax.set(xlim=(-0.2, 1.2), xticks=[], ylim=(0.3 - len(rows), 0.7))


def sway() -> str:
    """Resins down, dead volumes across; numbers are depths over R0."""
    rows = stored("sway")["map"]
    resins, gases, walls = (list(dict.fromkeys(row[key] for row in rows)) for key in ("resin", "gas", "wall_ratio"))
    with figure(178, 120) as drawn:
        drawn.get_layout_engine().set(rect=(0, 0, 1, 0.915))  # type: ignore[union-attr]
        axes = drawn.subplots(len(resins), len(gases), sharex=True, sharey=True)
        for i, resin in enumerate(resins):
            for k, gas in enumerate(gases):
                ax = axes[i, k]
                here = [row for row in rows if (row["resin"], row["gas"]) == (resin, gas)]
                draw_outcomes(ax, here, OUTCOMES, walls)
                for row in here:
                    if row["outcome"] in list(OUTCOMES)[:3]:
                        place = (row["wall_ratio"], row["limit_fraction"])
                        text = f"{row['depth_ratio']:.2f}"
                        ax.annotate(text, place, (0, 5), textcoords="offset points", ha="center", fontsize=5.5)
                ax.set(xlim=(0.026, 0.42), ylim=(-0.06, 0.92))
                if i == 0:
                    ax.set_title(gas, fontsize=7.5)
                if k == 0:
                    ax.set_ylabel(f"{resin}\np / limit  (-)", fontsize=7)
                if i == len(resins) - 1:
                    ax.set_xlabel("wall / R0  (-)")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="upper center", ncols=3)
        return svg(drawn)


def atlas() -> str:
    """Greatest error in force in each cell of two maps, darker for more."""
    from matplotlib.colors import BoundaryNorm, ListedColormap

    data = stored("atlas")
    wall, error = np.array(data["wall"]), 100 * np.abs(np.array(data["force"]))
    edges = np.geomspace(*data["summary"]["recipe"]["walls"], 13)
    bounds = [0.0, 0.1, 0.2, 0.5, max(1.0, float(error.max()))]
    norm, shades = BoundaryNorm(bounds, 4), ListedColormap(["#F1F4F6", "#B9C3CB", "#6C7A86", INK])
    with figure(178, 78) as drawn:
        axes = drawn.subplots(1, 2)
        for ax, key, steps, label in zip(
            axes,
            ("share", "depth"),
            (np.linspace(0.0, 0.97, 11), np.linspace(0.2, 0.75, 12)),
            ("driving pressure / limit  (-)", "depth / R0  (-)"),
            strict=True,
        ):
            mesh = ax.pcolormesh(
                edges, steps, greatest(wall, np.array(data[key]), error, edges, steps), norm=norm, cmap=shades
            )
            ax.set(xscale="log", xlabel="wall / R0  (-)", ylabel=label)
            ax.set_xticks([0.06, 0.1, 0.15, 0.2, 0.3], ["0.06", "0.1", "0.15", "0.2", "0.3"])
            ax.minorticks_off()
        bar = drawn.colorbar(mesh, ax=axes, ticks=bounds, spacing="uniform")
        bar.set_label("greatest error in force, of full scale  (%)")
        bar.ax.set_yticklabels([f"{bound:g}" for bound in (*bounds[:-1], round(bounds[-1], 1))])
        return svg(drawn)


def greatest(x: Array, y: Array, error: Array, x_edges: Array, y_edges: Array) -> Array:
    """The greatest error in each cell (rows: y), NaN where there is none."""
    i = np.clip(np.searchsorted(x_edges, x, side="right") - 1, 0, x_edges.size - 2)
    k = np.clip(np.searchsorted(y_edges, y, side="right") - 1, 0, y_edges.size - 2)
    found = np.full((y_edges.size - 1, x_edges.size - 1), -1.0)
    np.maximum.at(found, (k, i), error)
    return np.where(found < 0.0, np.nan, found)


CHARTS: dict[str, Callable[[], str]] = {
    "friction": friction,
    "table-s1": table_s1,
    "protocol": protocol,
    "sway": sway,
    "atlas": atlas,
}
