"""Shares of the sources of uncertainty in the variance of a sensitivity, as bars."""

from pneutouch.report.style import ACCENT, BOLD, INK, MUTED, figure, svg

_MOST = 5
"""Sources drawn; the rest is added up in one bar."""

_WIDTH = 105.0
"""Width of the chart in mm: readable on a narrow screen."""

_THICK = 0.4
OTHERS = "all others"


def ranked(shares: list[dict[str, float]]) -> dict[str, list[float]]:
    """Shares of each state by source, greatest mean first; small ones added up as `OTHERS`. Each state sums to 1."""
    names = {name for local in shares for name in local}
    order = sorted(names, key=lambda name: (-sum(local.get(name, 0.0) for local in shares), name))
    rows_of = {name: [local.get(name, 0.0) for local in shares] for name in order[:_MOST]}
    if order[_MOST:]:
        rows_of[OTHERS] = [sum(local.get(name, 0.0) for name in order[_MOST:]) for local in shares]
    return rows_of


def share_bars(shares: dict[str, dict[str, float]]) -> str:
    """Bars of the variance shares (source to share) at one or two driving pressures, by label, as SVG."""
    rows = ranked(list(shares.values()))
    fills = (ACCENT, "white")
    with figure(_WIDTH, 11 + 3.9 * len(rows) * max(1.4, len(shares))) as drawn:
        ax = drawn.add_subplot()
        for row, values in enumerate(rows.values()):
            for k, (value, label) in enumerate(zip(values, shares, strict=True)):
                height = row + (k - 0.5 * (len(shares) - 1)) * _THICK
                ax.barh(height, 100 * value, _THICK, lw=0.6, color=fills[k], ec=INK)
                text = f"{100 * value:.0f} %" if value >= 0.005 else "< 1 %"
                style = {"color": INK, **BOLD} if row == 0 else {"color": MUTED}
                text_of = f"{text}  at {label}" if row == 0 else text
                ax.annotate(
                    text_of,
                    (100 * value, height),
                    xytext=(3, -0.3),
                    textcoords="offset points",
                    va="center",
                    fontsize=6.5,
                    **style,
                )
        ax.set_yticks(range(len(rows)), list(rows))
        ax.invert_yaxis()
        ax.grid(False, axis="y")
        ax.tick_params(axis="y", length=0)
        ax.set(xlabel="share of the variance of the sensitivity  (%)", xlim=(0, 100))
        return svg(drawn)
