"""Which labels of a saved figure lie over a curve or over one another, by the boxes that matplotlib reports."""

from __future__ import annotations

from contextlib import contextmanager
from itertools import combinations

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

_RIM = 0.4
"""Points by which boxes are made smaller: letters do not fill theirs."""


@contextmanager
def overlaps():
    """A list that fills with what overlaps in every figure saved meanwhile, and the number of labels looked at."""
    found: list[str] = []
    counted: list[int] = []
    original = Figure.savefig

    def record(self, *words, **options):
        original(self, *words, **options)
        before, self.dpi = self.dpi, 72
        # Legends find their places as they are drawn.
        self.draw_without_rendering()
        found.extend(_overlaps(self))
        counted.append(len(_labels(self)))
        self.dpi = before

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", record)
        yield found, counted


def _labels(drawn: Figure) -> list[Text]:
    """The texts that a figure shows: labels, legends, titles, and the numbers of the axes within their limits."""
    shown = []
    for ax in drawn.axes:
        shown += [*ax.texts, ax.title, ax.xaxis.label, ax.yaxis.label]
        if ax.axison:
            for axis in (ax.xaxis, ax.yaxis):
                low, high = sorted(axis.get_view_interval())
                shown += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        if ax.get_legend():
            shown += ax.get_legend().get_texts()
    for legend in drawn.legends:
        shown += legend.get_texts()
    return [text for text in shown if text.get_visible() and text.get_text().strip()]


def _box(text: Text) -> Bbox:
    # That of an annotation would hold its line as well.
    return Text.get_window_extent(text).padded(-_RIM)


def _overlaps(drawn: Figure) -> list[str]:
    labels = [(text, _box(text)) for text in _labels(drawn)]
    found = [f"{a.get_text()!r} over {b.get_text()!r}" for (a, p), (b, q) in combinations(labels, 2) if p.overlaps(q)]
    page = drawn.bbox.padded(0.5)
    found += [f"{text.get_text()!r} leaves the picture" for text, box in labels if not _inside(box, page)]
    for ax in drawn.axes:
        # In a technical drawing the numbers stand on their lines, on white.
        for line in ax.lines if ax.axison else ():
            if not line.get_visible():
                continue
            path = line.get_transform().transform_path(line.get_path())
            frame = ax.get_window_extent()
            for text, box in labels:
                if text.axes is not ax or text in (ax.title, ax.xaxis.label, ax.yaxis.label):
                    continue
                part = Bbox.intersection(box, frame)
                if part is None:
                    continue
                drawn_line = line.get_linestyle() not in ("None", "", " ")
                over = drawn_line and path.intersects_bbox(part, filled=False)
                marked = line.get_marker() not in ("None", "", " ", None) and part.count_contains(path.vertices)
                if over or marked:
                    found.append(f"{text.get_text()!r} over a curve of {ax.get_ylabel()!r}")
    return found


def _inside(box: Bbox, page: Bbox) -> bool:
    return box.x0 >= page.x0 and box.x1 <= page.x1 and box.y0 >= page.y0 and box.y1 <= page.y1
