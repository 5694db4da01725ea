"""What sensitivity costs in force range, resin by resin, and how far the driving pressure tunes the sensitivity."""

from __future__ import annotations

from pneutouch.evaluation.sheet_data import TradeOff, TuningChart
from pneutouch.report.chart import Line, Note, Panel
from pneutouch.report.curves import published_points, sensitivities
from pneutouch.report.style import ACCENT, FAINT, INK, LINES


def tradeoff_panel(tradeoff: TradeOff) -> Panel:
    """Greatest force range over sensitivity, both logarithmic."""
    chosen = tradeoff.spots[0].resin if tradeoff.spots else ""
    across = f"sensitivity at {tradeoff.driving_pressure_kPa:g} kPa  (kPa/N)"
    xlim, ylim = _limits(tradeoff)
    lines, notes = _gauge(tradeoff, xlim), []
    window = tradeoff.window_kPa_per_N or (xlim if tradeoff.force is not None else None)
    if window is not None:
        least, (low, high) = tradeoff.force or ylim[0], window
        frame = (low, low, high, high), (ylim[1], least, least, ylim[1])
        floor, top = (least, least), (ylim[1], ylim[1])
        lines += [Line(window, low=floor, high=top, dashes=""), Line(*frame, width=0.6, over=1)]
        notes.append(Note("target", ((low * high) ** 0.5, ylim[1]), (0.0, -1.0), bold=True))
    for k, (_, label, *at) in enumerate(tradeoff.spots):
        lines.append(Line(at[:1], at[1:], dashes="", marker="o", size=4.5, filled=k == 0, over=6 + (k == 0)))
        notes.append(Note(label, (at[0], at[1]), (-1.0, -1.0), bold=k == 0))
    for k, front in enumerate(tradeoff.known):
        s, title = front.sensitivity_kPa_per_N, front.resin.material.title
        picked = title == chosen
        tone, width, dashes = (ACCENT, 2.0, LINES[0]) if picked else (INK, 0.8, LINES[k % 5])
        end = f"{title}  {s[0]:.2g} to {s[-1]:.2g}"
        line = Line(s, front.force, "", end, tone, dashes, width, picked=picked, over=3 + picked)
        lines.append(line)
        lines.append(Line(s[:1], front.force[:1], tone=tone, dashes="", marker="o", size=2.2, filled=True, over=4))
    across += f"\n{tradeoff.caption}" if tradeoff.caption else ""
    return Panel(
        across, "greatest force range  (N)", tuple(lines), tuple(notes), xlim=xlim, ylim=ylim, log="xy", corner=True
    )


def _limits(tradeoff: TradeOff) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits that hold the fronts, the designs and the window, with a margin and with space for the labels."""
    x = [float(value) for front in tradeoff.known for value in front.sensitivity_kPa_per_N]
    y = [float(value) for front in tradeoff.known for value in front.force]
    x += [spot.sensitivity_kPa_per_N for spot in tradeoff.spots] + list(tradeoff.window_kPa_per_N or ())
    y += [spot.force for spot in tradeoff.spots] + ([] if tradeoff.force is None else [tradeoff.force])
    left, right = min(x, default=0.1) / 1.3, max(x, default=10.0) * 1.3
    low, high = min(y, default=0.1) / 1.4, max(y, default=10.0) * 1.4
    # The labels stand in the upper right corner, above the gauge's limit: it has to leave them the half of the height.
    limit = tradeoff.gauge_kPa / (left * right) ** 0.5
    return (left, right), (low, max(high, low * (limit / low) ** 2))


def _gauge(tradeoff: TradeOff, xlim: tuple[float, float]) -> list[Line]:
    """The line at which the cavity pressure reaches the end of the pressure sensor's range: no design is beyond."""
    label = f"end of the gauge's range: force × sensitivity = {tradeoff.gauge_kPa:g} kPa"
    edge = [tradeoff.gauge_kPa / x for x in xlim]
    return [Line(xlim, edge, label, tone=FAINT, width=5, over=2)]


def tuning_panel(tuning: TuningChart) -> Panel:
    """Sensitivity over driving pressure with its k = 2 interval, where that is known."""
    chosen, published = tuning.chosen, dict(tuning.published_kPa_per_N)
    end = chosen.label if tuning.others else ""
    x, y, low, high = (
        chosen.driving_pressure_kPa,
        chosen.sensitivity_kPa_per_N,
        tuning.low_kPa_per_N,
        tuning.high_kPa_per_N,
    )
    lines = [
        Line(
            other.driving_pressure_kPa, other.sensitivity_kPa_per_N, end=other.label, width=0.7, dashes=LINES[1 + k % 4]
        )
        for k, other in enumerate(tuning.others)
    ]
    lines.append(Line(x, y, end=end, tone=ACCENT, width=2.0, picked=True, over=4, low=low, high=high))
    for pressure, value in tuning.working_kPa_per_N.items():
        lines.append(Line((pressure, pressure), (0, value), width=0.6, dashes=LINES[4], over=2))
    working = list(tuning.working_kPa_per_N), list(tuning.working_kPa_per_N.values())
    lines += [Line(*working, dashes="", marker="o", size=4.5, over=5), *published_points(published)]
    last, value = working[0][-1], working[1][-1]
    right = max(float(x[-1]), *working[0])
    notes = [
        Note(f"{value:.2f} kPa/N\nat {last:g} kPa", (last, 0.3 * value), (-1.0 if last > 0.5 * right else 1.0, 0.0))
    ]
    if high is not None:
        middle = len(high) // 2
        notes.append(Note("k = 2", (float(x[middle]), float(high[middle])), (1.0, 1.0)))
    return sensitivities(lines, notes, tuning.caption)
