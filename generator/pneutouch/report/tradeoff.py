"""Panels of the greatest force range over sensitivity, and of the sensitivity over the driving pressure."""

from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import TradeOff, TuningChart
from pneutouch.report.chart import Note, Panel, PlotLine
from pneutouch.report.curves import published_points, sensitivities
from pneutouch.report.style import ACCENT, FAINT, INK, LINES

_ALIKE = 0.07
"""Relative distance from the end of the gauge's range within which a front is one with it."""
_EVENED = 61
"""Number of a front's points, a tenth of them, of whose distances the median counts."""


def tradeoff_panel(tradeoff: TradeOff) -> Panel:
    """Greatest force range over sensitivity, both logarithmic; without a target, where the gauge ends the range of
    every resin and all fronts are one line, the sensitivities that each resin reaches in rows."""
    short = [1.0 - front.sensitivity * front.force / tradeoff.gauge_kPa for front in tradeoff.known]
    across = f"sensitivity at {tradeoff.driving_pressure_kPa:g} kPa  (kPa/N)"
    across += f"\n{tradeoff.caption}" if tradeoff.caption else ""
    target = tradeoff.window_kPa_per_N or tradeoff.force
    if short and not target and np.median(np.concatenate(short)) < _ALIKE:
        across += "\nnumbers: greatest force range at the ends,"
        across += f"\nin between {tradeoff.gauge_kPa:g} kPa / sensitivity"
        return replace(_reached(tradeoff, short), x=across)
    chosen = tradeoff.spots[0].resin if tradeoff.spots else ""
    xlim, ylim = _limits(tradeoff)
    # The cavity pressure reaches the end of the pressure sensor's range: no design is beyond.
    label = f"end of the gauge's range: force × sensitivity = {tradeoff.gauge_kPa:g} kPa"
    edge = [tradeoff.gauge_kPa / x for x in xlim]
    lines, notes = [PlotLine(xlim, edge, label, tone=FAINT, width=5, over=2)], []
    window = tradeoff.window_kPa_per_N or (xlim if tradeoff.force is not None else None)
    if window is not None:
        least, (low, high) = tradeoff.force or ylim[0], window
        frame = (low, low, high, high), (ylim[1], least, least, ylim[1])
        floor, top = (least, least), (ylim[1], ylim[1])
        lines += [PlotLine(window, low=floor, high=top, dashes=""), PlotLine(*frame, width=0.6, over=1)]
        notes.append(Note("target", ((low * high) ** 0.5, least), (0.0, -1.0), bold=True))
    for k, spot in enumerate(tradeoff.spots):
        at = spot.figures.sensitivity, spot.figures.reach
        lines.append(PlotLine(at[:1], at[1:], dashes="", marker="o", size=4.5, filled=k == 0, over=6 + (k == 0)))
        notes.append(Note(spot.label, at, (-1.0, -1.0), bold=k == 0))
    for k, front in enumerate(tradeoff.known):
        s, title = front.sensitivity, front.resin.material.title
        picked = title == chosen
        tone, width, dashes = (ACCENT, 2.0, LINES[0]) if picked else (INK, 0.8, LINES[k % 5])
        end = f"{title}  {s[0]:.2g} to {s[-1]:.2g}"
        lines.append(PlotLine(s, front.force, "", end, tone, dashes, width, picked=picked, over=3 + picked))
        lines.append(PlotLine(s[:1], front.force[:1], tone=tone, dashes="", marker="o", size=2.2, filled=True, over=4))
    return Panel(across, "greatest force range  (N)", tuple(lines), tuple(notes), xlim=xlim, ylim=ylim, log="xy")


def _reached(tradeoff: TradeOff, short: list[Array]) -> Panel:
    """Sensitivities that each resin reaches, with the force range at both ends; thin where another limit than the
    gauge ends it, by shares ``short`` (n,) of its range."""
    order = sorted(range(len(short)), key=lambda k: -tradeoff.known[k].sensitivity[0])
    titles, lines, notes = [tradeoff.known[k].resin.material.title for k in order], [], []
    for k, (front, missing) in enumerate((tradeoff.known[each], short[each]) for each in order):
        s, row = front.sensitivity, np.full(front.sensitivity.size, float(k))
        tone = ACCENT if tradeoff.spots and titles[k] == tradeoff.spots[0].resin else INK
        # A front that runs along the limit of `_ALIKE` would change its width from point to point.
        near = np.lib.stride_tricks.sliding_window_view(np.pad(missing, _EVENED // 2, mode="edge"), _EVENED)
        whole = np.where(np.median(near, axis=-1) < _ALIKE, row, np.nan)
        lines.append(PlotLine(s, whole, tone=tone, width=3.5))
        lines.append(PlotLine(s, row, tone=tone, width=0.7))
        notes += [Note(f"{front.force[e]:.3g} N", (float(s[e]), k), (-1.0 - 2.0 * e, 0.0)) for e in (0, -1)]
    for k, spot in enumerate(spot for spot in tradeoff.spots if spot.resin in titles):
        at = spot.figures.sensitivity, float(titles.index(spot.resin))
        lines.append(PlotLine(at[:1], at[1:], dashes="", marker="o", size=4.5, filled=k == 0, over=6 + (k == 0)))
        notes.append(Note(spot.label, at, (0.0, 1.0), bold=k == 0))
    if max(missing.max() for missing in short) >= _ALIKE:
        lines.append(PlotLine(label="thin: less, another limit ends the range", width=0.7))
    reached = np.concatenate([front.sensitivity for front in tradeoff.known])
    xlim = reached.min() / 3.0, 3.0 * reached.max()
    return Panel("", "", tuple(lines), tuple(notes), xlim=xlim, log="x", rows=tuple(titles))


def _limits(tradeoff: TradeOff) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits that hold the fronts, the designs and the window, with a margin."""
    x = [float(value) for front in tradeoff.known for value in front.sensitivity]
    y = [float(value) for front in tradeoff.known for value in front.force]
    x += [spot.figures.sensitivity for spot in tradeoff.spots] + list(tradeoff.window_kPa_per_N or ())
    y += [spot.figures.reach for spot in tradeoff.spots] + ([] if tradeoff.force is None else [tradeoff.force])
    low, high = min(y, default=0.1) / 1.4, max(y, default=10.0) * 1.4
    return (min(x, default=0.1) / 1.3, max(x, default=10.0) * 1.3), (low, high)


def tuning_panel(tuning: TuningChart) -> Panel:
    """Panel of sensitivity over driving pressure, with its k = 2 interval where that is known."""
    chosen, working_kPa_per_N, high_kPa_per_N = tuning.chosen, tuning.working_kPa_per_N, tuning.high_kPa_per_N
    at_kPa = chosen.driving_pressure_kPa
    lines = [
        PlotLine(one.driving_pressure_kPa, one.sensitivity, "", one.label, width=0.7, dashes=LINES[1 + k % 4])
        for k, one in enumerate(tuning.others)
    ]
    picked = PlotLine(at_kPa, chosen.sensitivity, end=chosen.label if tuning.others else "", tone=ACCENT)
    lines.append(replace(picked, width=2.0, picked=True, over=4, low=tuning.low_kPa_per_N, high=high_kPa_per_N))
    lines += [
        PlotLine((at, at), (0, value), width=0.6, dashes=LINES[4], over=2) for at, value in working_kPa_per_N.items()
    ]
    lines.append(
        PlotLine(list(working_kPa_per_N), list(working_kPa_per_N.values()), dashes="", marker="o", size=4.5, over=5)
    )
    if tuning.filled_kPa_per_N:
        x, y = zip(*tuning.filled_kPa_per_N, strict=True)
        lines.append(
            PlotLine(x, y, "by injected gas or height", width=1.0, dashes=LINES[2], marker="s", size=4.0, over=4)
        )
    lines += published_points(dict(tuning.published_kPa_per_N))
    last_kPa, value = list(working_kPa_per_N.items())[-1]
    side = -1.0 if last_kPa > 0.5 * max(float(at_kPa[-1]), *working_kPa_per_N) else 1.0
    notes = [Note(f"{value:.2f} kPa/N\nat {last_kPa:g} kPa", (last_kPa, 0.3 * value), (side, 0.0))]
    if high_kPa_per_N is not None:
        middle = len(high_kPa_per_N) // 2
        notes.append(Note("k = 2", (float(at_kPa[middle]), float(high_kPa_per_N[middle])), (1.0, 1.0)))
    return sensitivities(lines, notes, tuning.caption)
