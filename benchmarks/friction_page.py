"""Write docs/background/friction.md, every number computed: ``make friction-page`` (a few minutes)."""

from __future__ import annotations

import time
from pathlib import Path
from unittest import mock

import numpy as np

from benchmarks.friction_cost import costs, summary
from pneutouch.catalogue import Library
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.solid.friction_loop import friction_loop
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent
from pneutouch.mechanics.solid.inflate import FreeState, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.units import KPA

ROOT = Path(__file__).resolve().parents[1]
RESINS = ("TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985")
FRICTIONS = (0.0, 0.3, 0.6, 1.0, np.inf)
RADIUS, WALL, DEPTH, PRESSURES = 9.25, 1.5, 0.75 * 9.25, (0.0, 22 * KPA)
LOOP_DEPTH = 0.5 * RADIUS
BEFORE_EVENTS = 0.6 * RADIUS
"""Depth before which no press of the tables of steps and of time jumps."""

Scene = tuple[SolidModel, FreeState]


def scene(modulus: float, pressure: float) -> Scene:
    """The paper's dome in a modulus (MPa) at a driving pressure (MPa)."""
    solid = SolidModel(dome(RADIUS, WALL), neo_hookean(modulus), base=RigidBase())
    return solid, state_at(solid, pressure)


def press(one: Scene, friction: float, depth: float = DEPTH, steps: int = 14) -> IndentationPath:
    """A press without the end of the gauge's range."""
    return indent(*one, PressSettings(depth, steps, friction=friction, gauge_range=np.inf))


def label(friction: float) -> str:
    """A coefficient as the tables show it."""
    return "grip" if np.isinf(friction) else f"{friction:g}"


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    rule = "| --- |" + " ---: |" * (len(head) - 1)
    return ["| " + " | ".join(head) + " |", rule, *("| " + " | ".join(row) + " |" for row in rows), ""]


def _sensitivities(moduli: dict[str, float]) -> list[str]:
    rows = []
    for name, modulus in moduli.items():
        row = [name]
        for pressure in PRESSURES:
            one = scene(modulus, pressure)
            found = [press(one, friction).figures() for friction in FRICTIONS]
            row += ["-" if figure is None else f"{figure.sensitivity_kPa_per_N:.3f}" for figure in found]
        rows.append(row)
    return _table(["resin", *(f"{p / KPA:g} kPa, {label(f)}" for p in PRESSURES for f in FRICTIONS)], rows)


def _loops(moduli: dict[str, float], measured: dict[str, float]) -> list[str]:
    rows = []
    for name, modulus in moduli.items():
        one, row = scene(modulus, 0.0), [name]
        for friction in (0.1, 0.3, 0.6, 1.0, np.inf):
            loop = friction_loop(*one, PressSettings(LOOP_DEPTH, 14, friction=friction))
            width, area = loop.hysteresis()
            row.append(" / ".join(f"{abs(100 * share):.1f}" for share in (width, area, loop.lost_share)))
        rows.append([*row, f"{measured[name]:g}"])
    return _table(["resin", "0.1", "0.3", "0.6", "1", "grip", "measured"], rows)


def _steps() -> list[str]:
    rows = []
    for modulus, pressure, friction in ((0.17, 0.0, 1.0), (0.91, 0.0, 0.6), (0.91, 0.0, np.inf), (4.0, 22 * KPA, 1.0)):
        one = scene(modulus, pressure)
        row = [f"{modulus:g} MPa, {pressure / KPA:g} kPa, {label(friction)}"]
        for steps in (14, 28, 56, 112):
            row.append(_slope(press(one, friction, BEFORE_EVENTS, steps), steps // 14))
        with mock.patch("pneutouch.mechanics.solid.friction_path.TANGENTIAL", 1.0):
            row.append(_slope(press(one, friction, BEFORE_EVENTS), 1))
        rows.append(row)
    return _table(
        ["modulus, pressure, friction", "14 steps", "28", "56", "112", "14, springs ten times as stiff"], rows
    )


def _slope(run: IndentationPath, every: int) -> str:
    """Sensitivity over the 15 depths that all numbers of steps share."""
    d, f, p = (run.column(name)[::every] for name in ("indentation", "force", "rise"))
    found = figures(d, f, p / KPA)
    assert found is not None
    return f"{found.sensitivity_kPa_per_N:.4f}"


def _times() -> list[str]:
    rows, ratios = [], []
    for modulus, pressure in ((0.17, 0.0), (0.17, 22 * KPA), (0.91, 0.0), (0.91, 22 * KPA), (4.0, 22 * KPA)):
        one = scene(modulus, pressure)
        without, *others = (min(_seconds(one, friction) for _ in range(2)) for friction in FRICTIONS)
        ratios += [other / without for other in others]
        rows.append([f"{modulus:g} MPa, {pressure / KPA:g} kPa", *(f"{other / without:.1f}" for other in others)])
    mean = f"The mean of all {len(ratios)} is {np.mean(ratios):.2f}, the largest {max(ratios):.1f}."
    return [*_table(["press", *map(label, FRICTIONS[1:])], rows), mean, "", summary(list(costs())), ""]


def _seconds(one: Scene, friction: float) -> float:
    begun = time.process_time()
    press(one, friction, BEFORE_EVENTS)
    return time.process_time() - begun


def page(library: Library) -> str:
    """The whole page."""
    materials = {name: library.load("materials", name) for name in RESINS}
    moduli = {name: material_sensor(material).wall.shear_modulus for name, material in materials.items()}
    measured = {name: material.measured.hysteresis_percent.nominal for name, material in materials.items()}
    return "\n".join(
        [
            *TEXT["what"],
            *_sensitivities(moduli),
            *TEXT["loop"],
            *_loops(moduli, measured),
            *TEXT["steps"],
            *_steps(),
            *TEXT["ends"],
            *TEXT["time"],
            *_times(),
            *TEXT["reference"],
        ]
    )


def main() -> None:
    (ROOT / "docs" / "background" / "friction.md").write_text(page(Library.default()), encoding="utf-8")


TEXT = {
    "what": [
        "# Friction between wall and plate",
        "",
        "`make friction-page` computes this page. The sensor is the paper's, without dead volume; its wall may lie down on the "
        "base plane, which is the default and has no friction.",
        "",
        "`predict` takes a coefficient: `pneutouch predict paper-dome --set contact.friction=0.6`. The default is 0, as in "
        "the paper's finite elements; `inf` is a surface that grips. Friction is solved by the solid, off the axis by "
        "`harmonic` with two directions along the surface ([off-axis.md](off-axis.md#how-it-is-solved)).",
        "",
        "The law is Coulomb's. A stiff spring along the object's surface holds each point of the wall where it first touched. "
        "Where the traction of the spring would pass the coefficient times the normal traction, the point slips. Each "
        "accepted state stores where its points stick, and every step starts from there.",
        "",
        "## Sensitivity",
        "",
        f"S in kPa/N over {DEPTH:.2f} mm or to the first event that ends the curve, by driving pressure and friction. The "
        "end of the gauge's range does not count here.",
        "",
    ],
    "loop": [
        "## The loop that friction alone makes",
        "",
        f"The plate goes {LOOP_DEPTH:.2f} mm down at 0 kPa and up again. Each cell has three shares in percent: the greatest "
        "difference of the pressure rise between loading and unloading, over full scale; the area of the loop of pressure "
        "rise over force, over the area below its loading; the work that the plate does not get back, over the work that it "
        "put in. Measured is the normalised hysteresis of the paper's Table S1, for which the paper gives no formula. The "
        "resin's relaxation is not in this loop; [viscous.md](viscous.md#friction-and-other-objects) has both together.",
        "",
    ],
    "steps": [
        "## Steps and springs",
        "",
        f"S in kPa/N over {BEFORE_EVENTS:.2f} mm, from the same 15 depths each. The springs have a tenth of the contact's "
        "stiffness.",
        "",
    ],
    "ends": [
        "## Ends",
        "",
        "A point that friction holds until it is let go releases the wall around it at once, as a crack that opens by "
        "that point: the wall gives up half the traction times its path. The balance of energy counts this as "
        "dissipated. A jump loses far more than that. A path also ends where it turns back: the speed of the wall over "
        "that of the object grows with the inverse root of the distance that is left. Such an end is a `snap` or "
        "`clamp_fold`, too. Where no equilibrium is found at one height and a sound one a little further, the path goes "
        "on. `lost` remains where the solver goes no further and the path does not turn back; then there is no statement "
        "on a jump. [contact.md](contact.md#random-presses) compares the ends of random presses with those on a finer "
        "mesh.",
        "",
    ],
    "time": [
        "## Time",
        "",
        "Processor time of a press with friction over the same press without, least of two each, in one run "
        "(`python -m benchmarks.friction_cost` has the random ones alone).",
        "",
        "Each Newton step settles in a linear model which points touch, stick and slide. A round that leads to another "
        "status of the points is followed only as far as the work of the residual falls. What four rounds do not settle "
        "is settled one point after another, and where the model is not definite or does not settle, the largest "
        "tractions are held. The wall before the contact is eliminated once a "
        "step. The first step of a solve keeps the slip of the state before, a full step that halves the residual is "
        "taken without a search, and a step that fails or is not sound is bisected, its end tried again from half way.",
        "",
    ],
    "reference": [
        "## CalculiX",
        "",
        "`tests/mechanics/solid/test_calculix_friction.py` presses the sensor in FLX9960 with CalculiX 2.20 on the same "
        "cells, with the solid's pressure over the depth, at coefficients 0 and 0.6, where nearly all points slip: the "
        "forces from 1.2 to 2.4 mm agree within 1 %. "
        "[validation.md](validation.md#calculix-friction-in-three-dimensions) has the same press by half a dome in three "
        "dimensions. "
        "CalculiX counts the slip of a point from the beginning of its computation, not from where the point first "
        "touches, so that a surface that grips pulls the points that touch later back to their radii at rest: a "
        "coefficient of 10 gives a force 8 to 13 % higher, and so does this solid, within 2 %, where its points rest at "
        "those radii. A plate that grips is therefore pressed without CalculiX's friction: each node that touches keeps "
        "the radius that CalculiX found for it. On 96 x 2 cells the forces from 0.6 to 2.4 mm then agree within 1 %, as "
        "they do where nodes slip. "
        "Without CalculiX, `tests/mechanics/solid/test_grip.py` compares grip with points that are held one by one where "
        "they first touched, and a disc that is gripped with one that is bonded.",
        "",
    ],
}
"""The prose of the page by section."""


if __name__ == "__main__":
    main()
