"""No label of a chart lies over a curve, a marker or another label; the design is picked out on its own curve."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from pneutouch.evaluation.sheet import sheet_data
from pneutouch.report import curves
from pneutouch.report.chart import drawn_svg
from pneutouch.report.datasheet import described
from pneutouch.report.style import ACCENT, figure, label_ends, note, svg
from tests.report.overlaps import overlaps

SHIPPED = (
    "agilus-dome",
    "cast-dome",
    "fingertip-dome",
    "graded-dome",
    "long-tube",
    "paper-dome",
    "small-cell",
    "soft-pad",
    "stiff-dome",
)
EVERYDAY = ("paper-dome",)
DESIGNS = [pytest.param(name, marks=() if name in EVERYDAY else pytest.mark.slow) for name in SHIPPED]


def test_every_shipped_design_is_looked_at(root):
    assert sorted(path.stem for path in (root / "designs").glob("*.toml")) == list(SHIPPED)


@pytest.fixture(scope="module")
def sheet_of(evaluated):
    return cache(lambda name: sheet_data(evaluated(name), "0"))


@pytest.mark.slow
@pytest.mark.parametrize("name", DESIGNS)
def test_no_label_lies_over_a_curve_or_another_label(name, sheet_of):
    sheet = sheet_of(name)
    with overlaps() as (found, labels):
        described(sheet)
    assert found == []
    # Few driving pressures have fewer labels.
    assert sum(labels) > (150 if len(sheet.prediction.states) > 2 else 120)


def test_the_check_finds_a_label_over_a_curve_and_over_another():
    """The check itself: without it a label is where it was put."""
    with overlaps() as (found, _), figure(80, 60) as drawn:
        ax = drawn.add_subplot()
        ax.plot([0, 1], [0, 1])
        ax.text(0.5, 0.5, "on the line", ha="center", va="center")
        ax.text(0.52, 0.5, "on the label", ha="center", va="center")
        svg(drawn)
    assert len(found) == 3


def test_labels_are_moved_off_a_curve_and_apart():
    with overlaps() as (found, labels), figure(86, 62) as drawn:
        ax = drawn.add_subplot()
        x = np.linspace(0, 1, 50)
        for k in range(5):
            ax.plot(x, x + 0.02 * k)
        ax.set(xlim=(0, 1), ylim=(0, 1.2))
        label_ends(ax, [(1.0, 1.0 + 0.02 * k, f"curve {k}", {"fontsize": 6.5}) for k in range(5)])
        note(ax, "one point", (0.5, 0.5))
        note(ax, "the same point", (0.5, 0.5))
        svg(drawn)
    assert found == []
    assert labels[0] > 7


@pytest.fixture
def picked(monkeypatch):
    """The thick curve of each chart saved, (n, 2), and the points on it."""
    seen = []
    original = Figure.savefig

    def record(self, *words, **options):
        lines = [line for line in self.axes[0].lines if to_hex(line.get_color()) == ACCENT.lower()]
        seen.append([np.asarray(line.get_xydata()) for line in sorted(lines, key=lambda line: line.get_linewidth())])
        return original(self, *words, **options)

    monkeypatch.setattr(Figure, "savefig", record)
    return seen


@pytest.mark.slow
@pytest.mark.parametrize("name", DESIGNS)
def test_the_design_is_picked_out_on_its_own_curve(name, sheet_of, picked):
    """A graded design too, whose resin is none of the chart's."""
    sheet = sheet_of(name)
    title = sheet.scene.membrane_material.title
    drawn_svg(curves.resin_sensitivities(sheet.resin_curves, sheet.prediction, title, {}))
    ((points, curve),) = picked
    own = [(1e3 * s.driving_pressure, s.figures.sensitivity) for s in sheet.prediction.states if s.figures]
    np.testing.assert_allclose(points, own)
    np.testing.assert_allclose(np.interp(points[:, 0], *curve.T), points[:, 1], rtol=0.03)
