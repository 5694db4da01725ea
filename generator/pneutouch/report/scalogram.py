"""The scan chart: each state's pressure signal above, its scalogram below, as the paper's figure 9."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.report.style import ACCENT, BOLD, INK, LINES, MUTED, figure, label_ends, plain_ticks, svg
from pneutouch.texture.scalogram import Scalogram
from pneutouch.texture.signal import Signal
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.colors import Colormap

SIZE = (180.0, 96.0)
"""Width and height in mm: the text width of A4."""

_COLUMNS = 500
"""Greatest number of times drawn for each state, which bounds the file's size."""

_DPI = 250


@dataclass(frozen=True, slots=True)
class ScannedState:
    """One state of the sensor: its label, the pressure signal and the signal's scalogram."""

    label: str
    signal: Signal
    scalogram: Scalogram


def scalogram_chart(states: Sequence[ScannedState], expected: Mapping[str, float]) -> str:
    """SVG of states side by side, colours on one scale; ``expected`` maps labels to frequencies in Hz.
    The part that the ends of the record affect (cone of influence) is hatched. Each scalogram is one PNG in the SVG.
    """
    top = max(_loudest(state.scalogram) for state in states)
    with figure(*SIZE) as drawn:
        drawn.set_dpi(_DPI)
        axes = drawn.subplots(2, len(states), squeeze=False, sharex="col", sharey="row", height_ratios=(1, 2.1))
        for (above, below), state in zip(axes.T, states, strict=True):
            time, pressure = _outline(state.signal)
            above.plot(time, pressure / KPA, color=INK, lw=0.6)
            above.set_title(state.label, fontsize=7.5, **BOLD)
            mesh = _draw_scalogram(below, state.scalogram, top)
            for frequency in expected.values():
                below.axhline(frequency, color=INK, lw=0.7, ls=LINES[1])
            below.set_xlabel("time  (s)")
        axes[0, 0].set_ylabel("pressure  (kPa)")
        axes[1, 0].set_ylabel("frequency  (Hz)")
        plain_ticks(axes[1, 0].yaxis)
        right = axes[1, -1]
        end = float(right.get_xlim()[1])
        look = {"fontsize": 6.5, "color": INK}
        label_ends(right, [(end, f, f"{text}\n{f:.3g} Hz", look) for text, f in expected.items()])
        drawn.colorbar(mesh, ax=list(axes[1]), label="amplitude  (kPa)", fraction=0.05, pad=0.02, aspect=22)
        return svg(drawn)


def _loudest(scalogram: Scalogram) -> float:
    """Greatest amplitude outside the cone of influence, kPa; of all where the cone covers everything."""
    inside = scalogram.amplitude[scalogram.inside]
    return float((inside if inside.size else scalogram.amplitude).max()) / KPA or 1.0


def _outline(given: Signal) -> tuple[Array, Array]:
    """Times and pressures; of many samples the least and the greatest value in each of `_COLUMNS` parts."""
    count = len(given.pressure)
    if count <= 2 * _COLUMNS:
        return given.time, given.pressure
    starts = np.linspace(0, count, _COLUMNS, endpoint=False).astype(int)
    ends = np.stack([np.minimum.reduceat(given.pressure, starts), np.maximum.reduceat(given.pressure, starts)], axis=1)
    return np.repeat(given.time[starts], 2), ends.ravel()


def _draw_scalogram(ax: "Axes", scalogram: Scalogram, top: float) -> "QuadMesh":
    """Amplitudes in kPa over time and frequency, the cone of influence hatched."""
    kept = np.unique(np.linspace(0, len(scalogram.time) - 1, _COLUMNS).round().astype(int))
    time, frequency = scalogram.time[kept], scalogram.frequency
    amplitude_kPa = scalogram.amplitude[:, kept] / KPA
    mesh = ax.pcolormesh(
        time, frequency, amplitude_kPa, cmap=_colours(), vmin=0, vmax=top, shading="gouraud", rasterized=True
    )
    # The e-folding time is inverse to the frequency: at one time, voices below its inverse are reached.
    distance = np.minimum(time - time[0], time[-1] - time)
    at_one = float(scalogram.wavelet.e_folding(np.float64(1.0)))
    edge = np.clip(at_one / np.maximum(distance, 1e-9), frequency[0], frequency[-1])
    look: dict[str, Any] = {"facecolor": (1, 1, 1, 0.55), "edgecolor": MUTED, "lw": 0, "hatch": "////"}
    ax.fill_between(time, frequency[0], edge, **look)
    ax.plot(time, edge, color=MUTED, lw=0.7)
    ax.set(yscale="log", ylim=(frequency[0], frequency[-1]), xlim=(time[0], time[-1]))
    ax.grid(False)
    return mesh


def _colours() -> "Colormap":
    """Colour map from white to ink, evenly darker, so that it reads in grayscale as in colour."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("pneutouch", ["#FFFFFF", "#A9CBE0", ACCENT, INK])
