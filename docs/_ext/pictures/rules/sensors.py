"""Designs with one parameter changed, for the rules on the membrane and on the sensor's working."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pictures.rules.case import LIBRARY, Case, Pair, assembled, evaluated, item_of, of_rule, of_sensor, window
from pneutouch.catalogue import load_scene
from pneutouch.evaluation.evaluate import PredictionOptions, evaluate_scene
from pneutouch.mechanics.prediction import DeformedShape
from pneutouch.report.section import draw_section, leader, polar
from pneutouch.report.style import ACCENT, INK, LINES, MUTED, plain_ticks
from pneutouch.spec.grade import MixingCurve, MixingPoint
from pneutouch.spec.material import Material
from pneutouch.spec.read import parse_changes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def walls() -> Pair:
    """The paper's dome, and one with a wall that its printer does not make."""
    return _walled(1.5), _walled(0.45)


def _walled(wall: float) -> Case:
    assembly = assembled("paper-dome", f"membrane.wall_thickness_mm={wall:g}")

    def draw(ax: Axes) -> None:
        draw_section(ax, assembly)
        radius = assembly.layout.inner_radius + 0.5 * wall
        leader(ax, polar(radius, 45), (14.0, 11.0), f"wall {wall:g}", "left")
        window(ax, -26, 26, -15, 13)

    return Case(f"wall of {wall:g} mm", of_rule("walls", item_of(assembly, "membrane")), draw)


def layers() -> Pair:
    """A wall of whole layers and one that ends between two."""
    return _layered(1.52), _layered(1.5)


def _layered(wall: float) -> Case:
    evaluation = evaluated("paper-dome", f"membrane.wall_thickness_mm={wall:g}", model="membrane")
    assembly = evaluation.assembly
    _, mode = assembly.machine("membrane")
    step = 1e-3 * mode.layer_um
    inner = assembly.layout.inner_radius
    count = wall / step

    def draw(ax: Axes) -> None:
        draw_section(ax, assembly)
        ends = inner + step * np.arange(np.floor(count) - 4, np.ceil(count) + 2)
        for k, end in enumerate(ends):
            ax.axhline(end, color=MUTED, lw=0.4)
            ax.text(
                0.078, end + 0.1 * step, f"layer {np.floor(count) - 3 + k:.0f}", va="bottom", ha="right", fontsize=6
            )
        ax.axhline(inner + wall, color=INK, lw=1.6)
        window(ax, -0.08, 0.08, float(ends[0]), float(ends[-1] + step))
        ax.set_aspect("auto")

    return Case(f"wall of {wall:g} mm, {count:.4g} layers", of_sensor("layers", evaluation), draw)


def driving() -> Pair:
    """The paper's dome inflated within its rated pressure and near its limit point."""
    return _driven(12.0), _driven(38.0)


def _driven(pressure_kPa: float) -> Case:
    evaluation = evaluated("paper-dome", f"pneumatics.driving_pressures_kPa=[0,{pressure_kPa:g}]", _NO_WAVES)
    state = evaluation.prediction.states[-1]

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        _draw_shape(ax, [shape for shape in state.shapes if not shape.indentation][-1])
        ax.axhline(0, color=MUTED, lw=0.4)

    return Case(f"inflated by {pressure_kPa:g} kPa", of_sensor("driving", evaluation), draw)


def _draw_shape(ax: Axes, shape: DeformedShape) -> None:
    """The deformed wall on both sides of the axis."""
    from matplotlib.collections import PolyCollection

    for side in (1.0, -1.0):
        cells = list(shape.cells * np.array([side, 1.0]))
        ax.add_collection(PolyCollection(cells, facecolors=ACCENT, edgecolors="face", lw=0.2, alpha=0.55))


_REST = "pneumatics.driving_pressures_kPa=[0]"
_NO_WAVES = "indentation.checked_waves=0"
_CLAMPED = ("connector.seat=clamped-flange-M2", "contact.base=false", _REST, _NO_WAVES)


def freedom() -> Pair:
    """A wide soft dome pressed little, and as deep as it meets its clamping ring."""
    return _pressed(5.0), _pressed(11.25)


def _pressed(depth: float) -> Case:
    evaluation = evaluated("soft-pad", *_CLAMPED, f"indentation.depth_mm={depth:g}")
    shape = evaluation.prediction.states[0].shapes[-1]

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        _draw_shape(ax, shape)
        ax.plot([-19, 19], [float(shape.cells[..., 1].max())] * 2, color=INK, lw=1.6)
        window(ax, -26, 26, -4, 18)

    return Case(f"pressed by {depth:g} mm", of_sensor("freedom", evaluation), draw)


def mixing_curve() -> Pair:
    """A mix that every curve of its pair covers, and one that is stiffer than one of them."""
    return _mixed(0.1), _mixed(0.3)


def _mixed(fraction: float) -> Case:
    mix = f"membrane.material={{from='TangoPlus', to='VeroClear', fraction={fraction:g}}}"
    evaluation = evaluated("graded-dome", mix, _REST, model="atlas")
    (pair,) = LIBRARY.all("mixing", MixingCurve).values()

    def draw(ax: Axes) -> None:
        ax.axis("on")
        ax.set_aspect("auto")
        for (name, key), dashes in zip(pair.curves.by_name.items(), LINES, strict=False):
            moduli = [_modulus(point) for point in pair.points]
            ax.plot(pair.through(key), moduli, color=INK, lw=1.1, ls=dashes, label=name)
        ax.axvline(fraction, color=ACCENT, lw=1.6)
        ax.set(yscale="log", xlabel="fraction of the stiff resin  (-)", ylabel="shear modulus  (MPa)", xlim=(0, 0.7))
        plain_ticks(ax.yaxis)
        ax.legend(loc="lower right")

    return Case(f"fraction {fraction:g} of VeroClear", of_sensor("mixing curve", evaluation), draw)


def _modulus(point: MixingPoint) -> float:
    """Shear modulus of a point, MPa: measured, or that of its material."""
    if point.shear_modulus_MPa is not None:
        return point.shear_modulus_MPa
    return LIBRARY.all("materials", Material)[point.material].shear_modulus_MPa.nominal


def glue() -> Pair:
    """A cast flange around a ring, which is glued rigid on rigid, and one that is glued itself, with epoxy."""
    return (
        _glued("cast around a ring, epoxy", "epoxy between\nplastic and plastic", "cast-ring"),
        _glued("silicone glued with epoxy", "epoxy between\nsilicone and plastic", "glued-flange"),
    )


def _glued(label: str, text: str, seat: str) -> Case:
    changes = (f"connector.seat={seat}", "connector.glue=epoxy", _REST)
    evaluation = evaluated("cast-dome", *changes, model="membrane")

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        layout = evaluation.assembly.layout
        edge = layout.held_radius
        leader(ax, (edge, 0.5 * layout.plate_high), (edge + 1.0, 4.0), text, "left")
        window(ax, 6, layout.plate_radius + 6, -6, 6)

    return Case(label, of_sensor("glue", evaluation), draw)


def inserts() -> Pair:
    """Heat-set inserts in a connector of filament, and in one of a photopolymer."""
    return _inserted("ABS", "abs-filament"), _inserted("VeroClear", "objet260-connex")


def _inserted(material: str, profile: str) -> Case:
    made = (f"connector.material={material}", f"print.connector_profile={profile}")
    seat = ("connector.seat=clamped-flange-M2-insert", _REST)
    evaluation = evaluated("paper-dome", *made, *seat, model="membrane")

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        layout, hole = evaluation.assembly.layout, evaluation.assembly.solid("connector").bores[-1]
        spot = (layout.screw_circle, 0.5 * (hole.low + hole.high))
        leader(ax, spot, (layout.plate_radius + 1.5, 6.0), f"insert\nin {material}", "left")
        window(ax, 4, layout.plate_radius + 8, -12, 9)

    return Case(f"inserts in {material}", of_sensor("inserts", evaluation), draw)


def gland() -> Pair:
    """An O-ring in its groove, and one in a groove that is too shallow."""
    return _sealed(6.3), _sealed(6.8)


def _sealed(floor: float) -> Case:
    scene = load_scene("paper-dome", parse_changes(["connector.port=o-ring-9", _REST]), LIBRARY)
    scene = replace(scene, port=scene.port.model_copy(update={"groove_diameter": floor}))
    evaluation = evaluate_scene(scene, dict, PredictionOptions(model="membrane"))

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        low = evaluation.assembly.layout.under
        leader(ax, (0.5 * floor, low - 4.4), (8.0, low - 5.0), f"groove Ø{floor:g}", "left")
        window(ax, -12, 16, low - 10, low + 5)

    return Case(f"groove Ø{floor:g}", of_sensor("gland", evaluation), draw)


EXHIBITS = {
    "walls": walls,
    "layers": layers,
    "driving": driving,
    "freedom": freedom,
    "mixing curve": mixing_curve,
    "glue": glue,
    "inserts": inserts,
    "gland": gland,
}
