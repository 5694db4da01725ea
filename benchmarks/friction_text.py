"""Text, tables and chart of docs/background/friction.md from the stored numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg

FRICTIONS = (0.0, 0.3, 0.6, 1.0, np.inf)
LOOP_FRICTIONS = (0.1, 0.3, 0.6, 1.0, np.inf)
STEPS = (14, 28, 56, 112)
RADIUS, DEPTH = 9.25, 0.75 * 9.25
LOOP_DEPTH = 0.5 * RADIUS
BEFORE_EVENTS = 0.6 * RADIUS
"""Depth before which no press of the tables of steps and of time jumps."""

GRIP_AT = 1.4
"""Where grip stands on the axis of coefficients."""


def label(friction: float) -> str:
    """A coefficient as the tables show it."""
    return "grip" if np.isinf(friction) else f"{friction:g}"


def page(data: dict[str, Any]) -> str:
    """The whole page."""
    return "\n".join(
        [
            *_answer(data),
            *METHOD,
            *_sensitivity(data["sensitivity"]),
            *_loop(data["loops"]),
            *_steps(data["steps"]),
            *_times(data["times"]),
            *CALCULIX,
            *ENDS,
            *LIMITS,
        ]
    )


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    rule = "| --- |" + " ---: |" * (len(head) - 1)
    return ["| " + " | ".join(head) + " |", rule, *("| " + " | ".join(row) + " |" for row in rows), ""]


def _change(data: dict[str, Any], resin: str, pressure_kPa: float) -> float:
    """Sensitivity on a plate that grips over that without friction, less 1."""
    values = next(
        row["sensitivity_kPa_per_N"]
        for row in data["sensitivity"]
        if (row["resin"], row["driving_pressure_kPa"]) == (resin, pressure_kPa)
    )
    return float(values[-1] / values[0] - 1)


def _answer(data: dict[str, Any]) -> list[str]:
    widest = max(shares[0] for row in data["loops"] for shares in row["loop_percent"])
    return [
        "# Friction between wall and plate",
        "",
        "What does friction between the wall and the plate change? It lowers the sensitivity of stiff resins: for FLX9985 at 0 kPa by "
        f"{-100 * _change(data, 'FLX9985', 0):.0f} % on a plate that grips. For TangoPlus the change is {100 * _change(data, 'TangoPlus', 0):+.1f} % at 0 kPa and "
        f"{100 * _change(data, 'TangoPlus', 22):+.1f} % at 22 kPa. Friction alone also separates loading from unloading, by up to {widest:g} % of full "
        f"scale. A press with friction takes {data['times']['mean']:.1f} times the processor time of one without. Forces agree with CalculiX "
        "within 1 %.",
        "",
        "![Change of the sensitivity and width of the loop of loading and unloading over the coefficient of friction, for six resins](friction.svg)",
        "",
        "Left: change of the sensitivity by friction at 0 kPa (solid lines) and 22 kPa (dashed). Right: greatest difference of the pressure rise "
        "between loading and unloading at 0 kPa, over full scale, by friction alone.",
        "",
    ]


METHOD = [
    "## Method",
    "",
    "The law is Coulomb's. A stiff spring along the object's surface, with a tenth of the contact's stiffness, holds each point of the wall "
    "where it first touched. The point slips where the traction of the spring would exceed the coefficient times the normal traction. Each "
    "accepted state stores where its points stick, and every step starts from there.",
    "",
    "Each Newton step determines in a linear model which points touch, stick and slide: in up to four rounds, then one point after another. "
    "Where that model is not definite or does not settle, the largest tractions are held. A step that fails is bisected.",
    "",
    "A design states the coefficient as `contact.friction`; 0, the default, is that of the paper's finite elements, and `inf` is a surface that "
    "grips. `solid` answers central contact, `harmonic` contact off the axis ([off-axis.md](off-axis.md#how-it-is-solved)). All numbers below are "
    "of the paper's sensor without dead volume, its wall free to lie down on the base plane.",
    "",
]


def _sensitivity(rows: list[dict[str, Any]]) -> list[str]:
    pressures = list(dict.fromkeys(row["driving_pressure_kPa"] for row in rows))
    lines = [
        [resin, *(_cell(value) for row in rows if row["resin"] == resin for value in row["sensitivity_kPa_per_N"])]
        for resin in dict.fromkeys(row["resin"] for row in rows)
    ]
    return [
        "## Sensitivity",
        "",
        f"S in kPa/N over {DEPTH:.2f} mm, or to the first event that ends the curve, by driving pressure and friction. The end of the "
        "gauge's range is not among these events here.",
        "",
        *_table(["resin", *(f"{p:g} kPa, {label(f)}" for p in pressures for f in FRICTIONS)], lines),
    ]


def _cell(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _loop(rows: list[dict[str, Any]]) -> list[str]:
    lines = [
        [
            row["resin"],
            *(" / ".join(f"{share:.1f}" for share in shares) for shares in row["loop_percent"]),
            f"{row['measured_percent']:g}",
        ]
        for row in rows
    ]
    return [
        "## The loop that friction alone makes",
        "",
        f"The plate goes {LOOP_DEPTH:.2f} mm down at 0 kPa and up again. Each cell has three shares in percent:",
        "",
        "1. the greatest difference of the pressure rise between loading and unloading, over full scale;",
        "2. the area of the loop of pressure rise over force, over the area below its loading;",
        "3. the work that the plate does not get back, over the work that it put in.",
        "",
        "The last column is the normalised hysteresis of the paper's Table S1, for which the paper gives no formula. It contains the relaxation "
        "of the resin, the loop here does not; [viscous.md](viscous.md#friction-and-other-objects) has both together.",
        "",
        *_table(["resin", *map(label, LOOP_FRICTIONS), "measured"], lines),
    ]


def _steps(rows: list[dict[str, Any]]) -> list[str]:
    lines = [[row["press"], *(f"{value:.4f}" for value in row["sensitivity_kPa_per_N"])] for row in rows]
    head = ["modulus, pressure, friction", f"{STEPS[0]} steps", *map(str, STEPS[1:])]
    return [
        "## Steps and springs",
        "",
        f"S in kPa/N over {BEFORE_EVENTS:.2f} mm, fitted to the same 15 depths, by the number of steps and with stiffer springs.",
        "",
        *_table([*head, f"{STEPS[0]}, springs ten times as stiff"], lines),
    ]


def _times(times: dict[str, Any]) -> list[str]:
    lines = [[row["press"], *(f"{ratio:.1f}" for ratio in row["ratios"])] for row in times["presses"]]
    some = times["random"]
    return [
        "## Time",
        "",
        "Processor time of a press with friction over that of the same press without, least of two each, in one run.",
        "",
        *_table(["press", *map(label, FRICTIONS[1:])], lines),
        f"The mean of all {4 * len(lines)} is {times['mean']:.2f}, the greatest {times['greatest']:.1f}. In {some['count']} random presses (the paper's "
        "radius, walls of 0.05 to 0.4 of it, moduli of 0.17 to 4 MPa, driving pressures to 0.9 of the limit, coefficients of 0.05 to 1.5 and grip, "
        f"depth 0.6 R0) the mean is {some['mean']:.2f} and the greatest {some['greatest']:.1f}; {some['above_two']} take more than twice as long, "
        f"{some['above_two_thin']} of them with walls below 0.1 R0. In those walls points between the centre and the edge of the contact carry next to "
        "no load and come and go. `python -m benchmarks.friction_cost` prints the random presses.",
        "",
    ]


CALCULIX = [
    "## CalculiX",
    "",
    "CalculiX 2.20 presses the sensor in FLX9960 on the same cells, with the solid's pressure over the depth. At coefficients of 0 and 0.6, "
    "where nearly all points slip, the forces from 1.2 to 2.4 mm agree within 1 % (`tests/mechanics/solid/test_calculix_friction.py`). Half a dome in "
    "three dimensions agrees as well ([validation.md](validation.md#calculix-friction-in-three-dimensions)).",
    "",
    "CalculiX counts the slip of a point from the beginning of its computation, not from where the point first touches. A surface that grips "
    "then pulls points that touch later back to their radii at rest: with a coefficient of 10 the force is 8 to 13 % higher. This solid gives "
    "the same within 2 % where its points rest at those radii. Grip is therefore compared without CalculiX's friction: each node that touches is "
    "held at the radius that CalculiX found for it. On 96 x 2 cells the forces from 0.6 to 2.4 mm then agree within 1 %. "
    "`tests/mechanics/solid/test_grip.py` compares grip with points that are held one by one, and a gripped disc with a bonded one.",
    "",
]

ENDS = [
    "## Ends",
    "",
    "A point that friction releases frees the wall around it at once, like a crack that opens by that point: the wall gives up half the "
    "traction times its path. The balance of energy counts this as dissipated. A jump loses far more and ends the press as `snap` or "
    "`clamp_fold`. So does a path that turns back: there the speed of the wall over that of the object grows with the inverse root of the "
    "remaining distance. `lost` means that the solver goes no further and the path does not turn back; it states nothing on a jump. "
    "[contact.md](contact.md#random-presses) compares the ends of random presses with those on a finer mesh.",
    "",
]

LIMITS = [
    "## Limits",
    "",
    "- The friction of a real plate is not measured. A design that states none is computed without friction; a stated coefficient is taken as "
    "uncertain by a factor of 2 ([contact.md](contact.md#the-interval)).",
    "- The coefficient is constant: rate, pressure and adhesion do not enter. The base under the wall has no friction.",
    "",
    "`make friction-page` writes this page from `friction.json`.",
    "",
]


def draw(data: dict[str, Any]) -> str:
    """Change of the sensitivity, and the width of the loop, over the coefficient."""
    with figure(178, 78) as drawn:
        left, right = drawn.subplots(1, 2)
        resins = list(dict.fromkeys(row["resin"] for row in data["sensitivity"]))
        colours = dict(zip(resins, (ACCENT, INK, MUTED) * 2, strict=False))
        for row in data["sensitivity"]:
            values = np.array(row["sensitivity_kPa_per_N"], float)
            kept = row["driving_pressure_kPa"] == 0
            look = {"color": colours[row["resin"]], "ls": LINES[0 if kept else 1], "ms": 3.5, "lw": 1.0}
            marker = MARKERS[resins.index(row["resin"])]
            left.plot(
                _places(FRICTIONS), 100 * (values / values[0] - 1), marker=marker, mfc=None if kept else "white", **look
            )
        for row in data["loops"]:
            widths = [shares[0] for shares in row["loop_percent"]]
            look = {"color": colours[row["resin"]], "marker": MARKERS[resins.index(row["resin"])], "ms": 3.5, "lw": 1.0}
            right.plot(_places(LOOP_FRICTIONS), widths, label=row["resin"], **look)
        for ax in (left, right):
            ax.set_xticks(_places(FRICTIONS), list(map(label, FRICTIONS)))
            ax.set_xlabel("coefficient of friction  (-)")
        left.set_ylabel("change of the sensitivity  (%)")
        right.set(ylabel="width of the loop over full scale  (%)", ylim=(0, None))
        drawn.legend(*right.get_legend_handles_labels(), loc="outside lower center", ncols=6, fontsize=6.5)
        return svg(drawn)


def _places(frictions: tuple[float, ...]) -> list[float]:
    return [GRIP_AT if np.isinf(friction) else friction for friction in frictions]
