"""The chart of docs/background/contact.md: the dome under four objects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.evaluation import evaluate
from pneutouch.report.style import FAINT, INK, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from pneutouch.mechanics.prediction import SensorState

COMMON: dict[str, Any] = {
    "pneumatics.driving_pressures_kPa": [0],
    "indentation.depth_mm": 4,
    "indentation.checked_waves": 0,
}
OBJECTS: dict[str, dict[str, Any]] = {
    "plate": {},
    "ball of 5 mm radius": {"object": "ball", "ball_radius_mm": 5},
    "cone of 60°": {"object": "cone", "cone_half_angle_deg": 60, "cone_tip_radius_mm": 1},
    "ring of 4 mm radius": {"object": "ring", "ring_radius_mm": 4, "ring_section_radius_mm": 1},
}


def pressed(contact: dict[str, Any]) -> SensorState:
    """The paper's sensor without driving pressure under an object."""
    changes = {**COMMON, **{f"contact.{key}": value for key, value in contact.items()}}
    return evaluate("paper-dome", changes).prediction.states[0]


def chart() -> str:
    """Half sections side by side, shaded by stretch."""
    from matplotlib.cm import ScalarMappable

    states = {name: pressed(contact) for name, contact in OBJECTS.items()}
    colours = ScalarMappable(cmap="cividis_r")
    colours.set_clim(1.0, max(float(state.shapes[-1].stretch.max()) for state in states.values()))
    with figure(178, 58) as drawn:
        drawn.set_layout_engine("compressed")
        axes = drawn.subplots(1, len(states), sharey=True)
        for ax, (name, state) in zip(axes, states.items(), strict=True):
            _half(ax, state, colours)
            ax.set_title(f"{name}\n{state.force[-1]:.2f} N", fontsize=7)
        axes[0].set_ylabel("height  (mm)")
        drawn.colorbar(colours, ax=list(axes), label="greatest stretch  (-)", shrink=0.9)
        return svg(drawn)


def _half(ax: Axes, state: SensorState, colours: Any) -> None:
    from matplotlib.collections import PolyCollection

    shape = state.shapes[-1]
    ax.add_collection(PolyCollection(list(state.shapes[0].cells), facecolors="none", edgecolors=FAINT, lw=0.3))
    look = {"cmap": colours.cmap, "norm": colours.norm, "edgecolors": "face", "lw": 0.2}
    ax.add_collection(PolyCollection(list(shape.cells), array=shape.stretch, **look))
    if shape.body is not None:
        ax.plot(*shape.body.T, color=INK, lw=1.6)
    else:
        ax.axhline(float(shape.cells[..., 1].max()), color=INK, lw=1.6)
    ax.axhline(0, color=INK, lw=0.6)
    ax.grid(False)
    ax.set(aspect="equal", xlabel="radius  (mm)", xlim=(0, 12.5), ylim=(-0.5, 14))
