"""Charts of the paper's Figures 3(a) to (c), 5(a), 6(d) to (g) and 7(a), and of its claim on several sensitivities."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from stored_pages import stored

from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CLOSURES = {"variational": ("membrane", INK, LINES[0]), "printed": ("membrane, eq. 17 as printed", MUTED, LINES[1])}
_TONES = (ACCENT, INK, MUTED)


def paper_theory() -> str:
    """Inflation of the membrane in seven resins and by other laws, its peak, stiffness and sensitivity beyond it."""
    found = stored("claims")["figures"]
    with figure(178, 160) as drawn:
        axes = drawn.subplots(3, 2).ravel()
        _inflations(axes[0], found["3a"])
        _laws(axes[1])
        _peaks(axes[2], found["3c"])
        _through(axes[3], found, "5a", "tangent stiffness at 3 mm  (N/mm)", 1, "apex height outside  (mm)")
        _through(axes[4], found, "7a", "sensitivity  (kPa/N)", 0, "driving pressure  (kPa)")
        _through(axes[5], found, "7a", "sensitivity  (kPa/N)", 0, "driving pressure  (kPa)", printed=False)
        for ax, name in zip(axes, ("3(a)", "3(b)", "3(c)", "5(a)", "7(a)", "7(a), enlarged"), strict=True):
            ax.set_title(f"Figure {name}", fontsize=7.5, loc="left")
        return svg(drawn)


def _inflations(ax: Axes, curves: dict[str, Any]) -> None:
    ax.set_yscale("log")
    for k, (height, pressure) in enumerate(curves.values()):
        ax.plot(height, pressure, color=_TONES[k % 3], ls=LINES[k % len(LINES)], lw=1.0)
        top = int(np.argmax(pressure))
        ax.plot(height[top], pressure[top], "o", color=_TONES[k % 3], ms=2.5)
    _end_labels(ax, {title: (height[-1], np.log10(pressure[-1])) for title, (height, pressure) in curves.items()}, 0.13)
    ax.set(xlabel="apex height outside  (mm)", ylabel="driving pressure  (kPa)", ylim=(5, 2500))
    ax.set_xlim(10, 38)


def _end_labels(ax: Axes, ends: dict[str, tuple[float, float]], gap: float) -> None:
    """Names right of the ends of curves, at least ``gap`` apart; on a logarithmic axis the ends are logarithms."""
    last = -np.inf
    for title, (x, y) in sorted(ends.items(), key=lambda item: item[1][1]):
        last = max(y, last + gap)
        at = 10**last if ax.get_yscale() == "log" else last
        ax.annotate(title, (x, at), xytext=(4, 0), textcoords="offset points", fontsize=5.5, va="center")


def _laws(ax: Axes) -> None:
    for k, row in enumerate(stored("paper")["laws"]):
        ax.plot(row["height"], row["pressure"], color=_TONES[k % 3], ls=LINES[k % len(LINES)], lw=1.0, label=row["law"])
    ax.set(xlabel="apex height inside  (R0)", ylabel="driving pressure  (µ t0/R0)", xlim=(1, 2.4), ylim=(0, 4))
    ax.legend(fontsize=5.5, loc="upper right", bbox_to_anchor=(1.0, 0.39), framealpha=0.0)


def _peaks(ax: Axes, pair: list[list[float]]) -> None:
    ax.plot(*pair, color=INK, marker=MARKERS[0], ms=3, lw=1.0)
    ax.set(xlabel="inner radius  (mm)", ylabel="height of the peak inside  (mm)", xlim=(0, None), ylim=(0, None))


def _through(
    ax: Axes, found: dict[str, Any], key: str, up: str, column: int, across: str, *, printed: bool = True
) -> None:
    """A figure of TangoPlus through the limit point, over pressure (column 0) or height (1)."""
    for closure, (label, tone, dashes) in _CLOSURES.items():
        if closure == "printed" and not printed:
            continue
        rows = np.array(found[key][closure])
        ax.plot(rows[:, column], rows[:, 2], color=tone, ls=dashes, lw=1.0, label=label)
        _limit(ax, rows, column, tone)
    rows = np.array(found[f"{key} solid"])
    ax.plot(rows[:, column], rows[:, 2], color=ACCENT, marker=MARKERS[2], ms=2.5, mfc="white", lw=1.2, label="solid")
    _limit(ax, rows, column, ACCENT)
    ax.set(xlabel=across, ylabel=up, ylim=(0, None))
    ax.legend(fontsize=5.5)


def _limit(ax: Axes, rows: np.ndarray, column: int, tone: str) -> None:
    top = int(np.argmax(rows[:, 0]))
    ax.plot(rows[top, column], rows[top, 2], "o", color=tone, ms=3.5)


def paper_solid() -> str:
    """Pressure rise over force in three resins, and sensitivity over driving pressure in seven, by the solid."""
    found = stored("claims")["figures"]
    with figure(178, 118) as drawn:
        axes = drawn.subplots(2, 2).ravel()
        for ax, (title, curves), place in zip(axes, found["6"].items(), "def", strict=False):
            for k, (force, rise) in enumerate(curves):
                label = f"{found['6g'][title][0][k]:g} kPa"
                ax.plot(force, rise, color=_TONES[k % 3], ls=LINES[k % len(LINES)], lw=1.0, label=label)
            ax.set(xlabel="contact force  (N)", ylabel="pressure rise  (kPa)", xlim=(0, None), ylim=(0, None))
            ax.set_title(f"Figure 6({place}), {title}", fontsize=7.5, loc="left")
            ax.legend(fontsize=5.5)
        _sensitivities(axes[3], found)
        return svg(drawn)


def _sensitivities(ax: Axes, found: dict[str, Any]) -> None:
    for k, (title, (pressure, value)) in enumerate(found["6g"].items()):
        tone = _TONES[k % 3]
        ax.plot(pressure, value, color=tone, ls=LINES[k % len(LINES)], lw=1.0)
        ax.plot((0, 22), found["measured"][title], "D", color=tone, mfc="white", ms=3)
    _end_labels(ax, {title: (pressure[-1], value[-1]) for title, (pressure, value) in found["6g"].items()}, 0.13)
    ax.set(xlabel="driving pressure  (kPa)", ylabel="sensitivity  (kPa/N)", xlim=(-1, 31), ylim=(0, None))
    ax.set_title("Figure 6(g)", fontsize=7.5, loc="left")


_SETS = {"0": (MUTED, "-"), "12": (INK, "--"), "22": (MUTED, ":"), "0 + 22": (INK, "-"), "0 + 12 + 22": (ACCENT, "-")}
"""Tone and line of each set of driving pressures."""


def discrimination() -> str:
    """Objects and forces that readings at one, two and three driving pressures leave possible, and the mean region."""
    found = stored("discrimination")
    with figure(178, 70) as drawn:
        left, right = drawn.subplots(1, 2)
        for label, (tone, dashes) in _SETS.items():
            region = {key: np.array(value) for key, value in found["regions"][label].items() if key != "share"}
            across = np.concatenate([region["low"], region["high"][::-1], region["low"][:1]])
            up = np.concatenate([region["curvature"], region["curvature"][::-1], region["curvature"][:1]])
            left.plot(across, up, color=tone, ls=dashes, lw=1.0, label=f"{label} kPa")
        tightest = found["regions"]["0 + 12 + 22"]
        left.fill_betweenx(tightest["curvature"], tightest["low"], tightest["high"], color=ACCENT, alpha=0.5, lw=0)
        left.plot(1.3, 1 / 8, "+", color=INK, ms=7)
        left.set(xlabel="contact force  (N)", ylabel="curvature of the object  (1/mm)", ylim=(0, None))
        left.legend(fontsize=5.5)
        shares = [100 * plan["area_ratio"] for plan in found["plans"]]
        right.plot(range(1, len(shares) + 1), shares, color=INK, marker=MARKERS[0], ms=4, lw=1.0)
        for k, (share, plan) in enumerate(zip(shares, found["plans"], strict=True), start=1):
            words = ", ".join(f"{one:g}" for one in plan["driving_pressures_kPa"])
            place = {"xytext": (5, 5), "textcoords": "offset points", "fontsize": 6}
            right.annotate(f"{share:.0f} %: {words} kPa", (k, share), **place)
        right.set(xlabel="number of readings", ylabel="mean 95 % region  (% of the best single)")
        right.set(xlim=(0.8, len(shares) + 0.9), ylim=(0, 112), xticks=range(1, len(shares) + 1))
        return svg(drawn)


CHARTS: dict[str, Callable[[], str]] = {
    "paper-theory": paper_theory,
    "paper-solid": paper_solid,
    "discrimination": discrimination,
}
