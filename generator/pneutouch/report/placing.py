"""Placement of the labels of a chart: right of the axes, as near to their curves as their heights allow, and inside
them where neither curve, marker nor other label is."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from pneutouch.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

AT_SIDE, NEAR = "_at_side", "_near"
"""Marks of an annotation, given by its `set_label`, by which `settle` moves it."""

_STEP = 1.2
"""Distance of the points at which a curve is tested, in points (pixels at 72 dots per inch)."""
_AWAY = (5.0, 8.0, 12.0, 17.0, 23.0, 30.0, 38.0, 47.0, 57.0, 68.0, 80.0, 93.0)
"""Distances of a label from its data point that are tried in turn, points."""
_TURNS = 24
_LEADER = 9.0
"""Distance, points, from which on a thin line is drawn from the label to its data point."""
_SPARE = 1.0
"""Free rim around a label, points."""

LabelBox = tuple[float, float, float, float]
"""Left, low, right and high edge in points."""


def settle(drawn: Figure) -> None:
    """Move the labels that are marked, after the layout is done; to be called at 72 dots per inch."""
    for ax in drawn.axes:
        _stack(ax, _marked(ax, AT_SIDE), 1.0, float(drawn.bbox.height) - 1.0)
    taken = [_box(text) for text in _fixed(drawn)]
    for ax in drawn.axes:
        curves = _curves(ax)
        for label in _marked(ax, NEAR):
            box, leader = _near(ax, label, curves, taken)
            taken.append(box)
            curves = np.concatenate([curves, leader])


def _marked(ax: Axes, mark: str) -> list[Annotation]:
    return [cast("Annotation", text) for text in ax.texts if text.get_label() == mark and text.get_visible()]


def _fixed(drawn: Figure) -> list[Any]:
    """Every text in the axes that `settle` has placed or leaves; legends and numbers of the axes stand outside."""
    texts = [text for ax in drawn.axes for text in ax.texts]
    return [text for text in texts if text.get_label() != NEAR and text.get_visible() and text.get_text().strip()]


def _box(text: Any) -> LabelBox:
    """Box of the letters only: the box of an annotation would include its line."""
    from matplotlib.text import Text

    box = Text.get_window_extent(text)
    return box.x0, box.y0, box.x1, box.y1


def _stack(ax: Axes, labels: list[Annotation], low: float, high: float) -> None:
    """Labels above one another between two heights, in the order of their points and as near to them as they fit."""
    if not labels:
        return
    boxes = [_box(label) for label in labels]
    heights = [box[3] - box[1] + 0.6 for box in boxes]
    points = [float(ax.transData.transform(label.xy)[1]) for label in labels]
    order = sorted(range(len(labels)), key=lambda k: (points[k], k))
    frame = ax.get_window_extent()
    for k, y in zip(order, _column([points[k] for k in order], [heights[k] for k in order], low, high), strict=True):
        labels[k].set_verticalalignment("center")
        labels[k].set_position((labels[k].get_position()[0], (y - frame.y0) / frame.height))


def _column(targets: list[float], heights: list[float], low: float, high: float) -> list[float]:
    """Middles of boxes, ascending, without overlap, as near to ``targets`` as possible within ``low`` and ``high``."""
    groups: list[tuple[float, list[int]]] = []
    offset = np.concatenate([[0.0], np.cumsum([0.5 * (a + b) for a, b in pairwise(heights)])])
    for k, y in enumerate(targets):
        start, members = y - float(offset[k]), [k]
        while groups and groups[-1][0] > start:
            before, others = groups.pop()
            start = (before * len(others) + start * len(members)) / (len(others) + len(members))
            members = others + members
        groups.append((start, members))
    middles = [start + float(offset[k]) for start, members in groups for k in members]
    rise = max(0.0, low + 0.5 * heights[0] - middles[0])
    fall = max(0.0, middles[-1] + rise + 0.5 * heights[-1] - high)
    return [y + rise - fall for y in middles]


def _curves(ax: Axes) -> Array:
    """Points on everything that is drawn as a line or a marker inside the axes, (n, 2), points."""
    frame = ax.get_window_extent().padded(2.0)
    points = [np.empty((0, 2))]
    for line in ax.lines:
        if not line.get_visible():
            continue
        xy = np.asarray(line.get_transform().transform(line.get_xydata()), float)
        xy = xy[np.isfinite(xy).all(axis=1)]
        if line.get_linestyle() not in ("None", "", " "):
            half = 0.5 * line.get_linewidth() if line.get_linewidth() > 2.5 else 0.0
            points += [_dense(xy + np.array((0.0, side))) for side in sorted({-half, half})]
        if line.get_marker() not in ("None", "", " ", None):
            points += [xy + 0.5 * line.get_markersize() * side for side in _RIM]
    for patch in ax.patches:
        points.append(_dense(np.asarray(patch.get_transform().transform_path(patch.get_path()).vertices, float)))
    every = np.concatenate(points)
    inside = (every >= frame.min).all(axis=1) & (every <= frame.max).all(axis=1)
    return np.asarray(every[inside])


_RIM = np.array([(0.0, 0.0), *((np.cos(turn), np.sin(turn)) for turn in np.arange(8) * np.pi / 4)])


def _dense(xy: Array) -> Array:
    """Points along the line through ``xy`` (n, 2), at most `_STEP` apart."""
    if len(xy) < 2:
        return xy
    leap = np.diff(xy, axis=0)
    count = (np.minimum(np.hypot(*leap.T), 1e4) / _STEP).astype(np.intp) + 2
    ends = np.cumsum(count)
    which = np.repeat(np.arange(count.size), count)
    share = (np.arange(ends[-1]) - (ends - count)[which]) / (count - 1)[which]
    return np.asarray(xy[which] + share[:, None] * leap[which])


def _near(ax: Axes, label: Annotation, curves: Array, taken: list[LabelBox]) -> tuple[LabelBox, Array]:
    """Move a label to the first free place around its point, or else to the one with the least penalty (`_blocked`).

    Returns its box, and points (n, 2) on the line that leads to it. Where it nowhere fits into the axes it stays.
    """
    left, low, right, high = _box(label)
    wide, tall = right - left, high - low
    x, y = (float(value) for value in ax.transData.transform(label.xy))
    frame = ax.get_window_extent()
    preferred = np.asarray(label.get_position(), float)
    first = float(np.arctan2(preferred[1], preferred[0]))
    best: tuple[float, LabelBox, float] | None = None
    for away in _AWAY:
        for k in range(_TURNS):
            angle = first + (-1) ** k * ((k + 1) // 2) * 2 * np.pi / _TURNS
            across, up = float(np.cos(angle)), float(np.sin(angle))
            # The box's rim, not its middle, is `away` from the point.
            middle = x + across * (away + 0.5 * wide * abs(across)), y + up * (away + 0.5 * tall)
            box = (middle[0] - 0.5 * wide, middle[1] - 0.5 * tall, middle[0] + 0.5 * wide, middle[1] + 0.5 * tall)
            if box[0] < frame.x0 + 1 or box[2] > frame.x1 or box[1] < frame.y0 + 1 or box[3] > frame.y1:
                continue
            blocked = _blocked(box, curves, taken) + 1000.0 * _crossed((x, y), box, away, taken)
            if best is None or blocked < best[0]:
                best = (blocked, box, away)
            if not blocked:
                break
        if best is not None and not best[0]:
            break
    if best is None:
        return (left, low, right, high), np.empty((0, 2))
    _, box, away = best
    label.set(ha="center", va="center", multialignment="center")
    label.set_position((0.5 * (box[0] + box[2]) - x, 0.5 * (box[1] + box[3]) - y))
    if label.arrow_patch is not None:
        label.arrow_patch.set_visible(away >= _LEADER)
    return box, _leader((x, y), box, away)


def _leader(point: tuple[float, float], box: LabelBox, away: float) -> Array:
    """Points on the line from a point to a label's box; none where the label is so near that it has no line."""
    if away < _LEADER:
        return np.empty((0, 2))
    start, middle = np.array(point), np.array((0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])))
    line = _dense(np.stack([start, middle]))
    outside = (line < box[:2]).any(axis=1) | (line > box[2:]).any(axis=1)
    return line[outside]


def _crossed(point: tuple[float, float], box: LabelBox, away: float, taken: list[LabelBox]) -> int:
    """Number of labels that the line from a point to a label's box would run over."""
    line = _leader(point, box, away)
    return sum(bool(((line > b[:2]) & (line < b[2:])).all(axis=1).any()) for b in taken)


def _blocked(box: LabelBox, curves: Array, taken: list[LabelBox]) -> float:
    """Penalty of a box: the number of curve points under it, and 1000 for each label that it overlaps."""
    left, low, right, high = box[0] - _SPARE, box[1] - _SPARE, box[2] + _SPARE, box[3] + _SPARE
    hit = (curves[:, 0] > left) & (curves[:, 0] < right) & (curves[:, 1] > low) & (curves[:, 1] < high)
    others = sum(left < b[2] and b[0] < right and low < b[3] and b[1] < high for b in taken)
    return float(hit.sum()) + 1000.0 * others
