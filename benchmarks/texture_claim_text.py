"""The section of docs/background/texture.md on the paper's claim."""

from __future__ import annotations

from typing import Any


def claim(data: dict[str, Any]) -> list[str]:
    """The section on the paper's claim."""
    found = _pascals(data)
    rows = [f"| {name} | {a:.2f} | {b:.2f} | {b / a:.1f} | {c:.2f} | {d:.2f} |" for name, (a, b, c, d) in found.items()]
    return [
        "## The paper's claim",
        "",
        "By the caption of Figure 9 the soft state shows the surface pattern, of the higher frequency, more sharply, and the stiff state "
        "the buried one. By the body text the soft state is better at the lower frequency. The two contradict each other. (3 and 6 mm at "
        "4 mm/s are 1.33 and 0.67 Hz, not the caption's 1.5 and 0.75 Hz.)",
        "",
        "| pattern, in the shipped specimen | soft Pa, FE | stiff Pa, FE | stiff/soft | soft Pa, reduced | stiff Pa, reduced |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        *_compared(found, data["scan"]["states"]),
        "- **What could favour the soft state** is not in the model: relief of the surface, into which an unpressurised wall sags (some micrometres have as much effect "
        "as the whole compliance); friction, which the paper lowers with lubricant but does not remove; bending of the wall over an edge.",
        "- **What cannot be compared.** The paper states neither depths nor sections of its bars, nor amplitudes.",
        "",
    ]


def gains(data: dict[str, Any]) -> tuple[float, float]:
    """Least and greatest amplitude of a pattern in the stiff state over that in the soft one, by finite elements."""
    found = [stiff / soft for soft, stiff, _, _ in _pascals(data).values()]
    return min(found), max(found)


def _pascals(data: dict[str, Any]) -> dict[str, tuple[float, float, float, float]]:
    """By pattern: soft and stiff amplitude by finite elements, by the reduced model, Pa."""
    states = data["scan"]["states"]
    at = {(row["depth"], row["radius"]): row for row in data["both"]}
    radii = sorted({radius for _, radius in at}, reverse=True)
    kinds = {
        "surface (over pattern 2)": (0, "fe_3", 2.0),
        "surface (over pattern 1)": (0, "fe_3", 4.0),
        "pattern 2, 2 mm deep": (2, "fe_6", 2.0),
        "pattern 1, 4 mm deep": (1, "fe_6", 4.0),
    }
    found = {}
    for name, (number, key, depth) in kinds.items():
        fe = [
            1e3
            * state["pressure_slope_kPa_per_mm"]
            * data["scan"]["preload_N"]
            * abs(at[depth, radius][key])
            / (1 + state["stiffness_N_per_mm"] * at[depth, radius]["fe_mean"])
            for state, radius in zip(states, radii, strict=True)
        ]
        ours = [1e3 * state["patterns"][number]["model_amplitude_kPa"] for state in states]
        found[name] = (fe[0], fe[1], ours[0], ours[1])
    return found


def _compared(found: dict[str, tuple[float, float, float, float]], states: list[dict[str, Any]]) -> list[str]:
    """The claim against the numbers; surface over buried in both halves."""
    lean = {
        half: [found[f"surface (over {half})"][k] / found[buried][k] for k in (0, 1)]
        for half, buried in (("pattern 2", "pattern 2, 2 mm deep"), ("pattern 1", "pattern 1, 4 mm deep"))
    }
    two, one = lean["pattern 2"], lean["pattern 1"]
    nearer = [found["pattern 2, 2 mm deep"][k] / found["pattern 1, 4 mm deep"][k] for k in (0, 1)]
    return [
        "- **The stiff state shows every pattern better**, because its patch is smaller. That the soft state is better at the lower frequency "
        "(body text) or at the higher (caption) is not reproduced.",
        f"- **Which of the two patterns is larger.** Surface over buried, soft and stiff: {two[0]:.2f} and {two[1]:.2f} over pattern 2, {one[0]:.2f} and {one[1]:.2f} "
        "over pattern 1. The first is the order of the caption, the second the reverse. The reduced model has the caption's order much more strongly over pattern 2, but only "
        "because its patch of 3.58 mm is close to the zero for 6 mm, where its error is greatest: this is no support.",
        f"- **Pattern 2 over pattern 1**, which is deeper: {nearer[1]:.1f} times in the stiff state, {nearer[0]:.2f} times in the soft one.",
        f"- **What is detected, with the noise assumed here** (p up to 0.05, seed 0): {_found(states)}. With less noise both states would show both.",
    ]


def _found(states: list[dict[str, Any]]) -> str:
    """Which patterns each state shows."""
    said = []
    for state in states:
        names = [pattern["name"] for pattern in state["patterns"] if pattern["detected"]]
        said.append(f"at {state['label']} {', '.join(names) or 'none'}")
    return "; ".join(said)
