"""Speed against accuracy on the page: the chart, the table, the targets and where the time goes."""

from __future__ import annotations

import statistics
from typing import Any

from benchmarks.models import AT_ONCE, ATLAS, MODEL_METHODS
from benchmarks.pages.speed_chart import CUT, DEFAULT, SENSITIVITY_TARGET, of, sizes
from benchmarks.peers import OURS, WITHIN, cheapest
from benchmarks.speed_accuracy import METHODS

SECONDS_TARGET, FELUPE_TARGET, CALCULIX_TARGET = 0.25, 1 / 5, 1 / 3


def section(data: dict[str, Any], peers: dict[str, Any]) -> list[str]:
    """The whole section; its times belong to the machine and the run that wrote them."""
    truths = [scene["reference"] for scene in data["scenes"]]
    reference = {
        key: [t[key] for t in truths if t[key] is not None]
        for key in ("sensitivity_error", "force_error", "limit_error")
    }
    meshes = ", ".join(f"{arc} x {through}" for arc, through in data["refinements"])
    return [
        "## Speed against accuracy",
        "",
        f"{len(truths)} scenes differ in wall ratio (0.05 to 0.4), law, driving pressure, dead volume and depth (`benchmarks/scenes.py`).",
        "",
        "- **Work timed:** from the mesh to the driving pressure (study 1), then the press in 14 steps (study 2).",
        f"- **Reference:** extrapolated from three meshes of nine-node cells, {meshes} along and across the wall. Its error, the size of the "
        f"extrapolation, is in sensitivity {_both(reference['sensitivity_error'])}, in force {_both(reference['force_error'])}, in limit pressure "
        f"{_both(reference['limit_error'])} (median / worst scene).",
        "- **Range:** force and sensitivity are compared from first contact to the first event that ends the range of the reference, on any "
        "of its meshes, or of the method.",
        "- **Errors:** median / worst scene. That of the force is the greatest difference over the greatest force.",
        f"- **Scenes cut:** the method's range ends before {CUT:.0%} of the reference's.",
        "",
        *table(data),
        *_model_words(data),
        *_default_words(data),
        *scene_table(data),
        *_target_section(data, peers),
        *_peer_section(peers),
        *_share_section(data["profile_shares"]),
    ]


def _both(errors: list[float]) -> str:
    return f"{statistics.median(errors):.3%} / {max(errors):.2%}"


def _default_words(data: dict[str, Any]) -> list[str]:
    worst = {m: max(sizes(of(data["rows"], m), "sensitivity_error")) for m in METHODS}
    cut = {m: sum(row["range_share"] < CUT for row in of(data["rows"], m)) for m in METHODS}
    base = statistics.median(row["processor_s"] for row in of(data["rows"], DEFAULT))
    dear = statistics.median(row["processor_s"] for row in of(data["rows"], "solid 36 x 2")) / base
    return [
        "### The default mesh",
        "",
        "The default has 24 to 48 cells along the arc (three to the bending length sqrt(R0 t0)). It has one cell across the wall up to "
        "t0/R0 = 0.055, else two. It is the cheapest mesh on the Pareto front that keeps every scene within 1 %:",
        "",
        f"- With one cell across, the worst scene, a thick wall, is off by {worst['solid 24 x 1']:.1%}.",
        f"- With fewer than 24 along, the edge of the contact is so coarse that the wall appears to leave the plate ({cut['solid 8 x 1']}, "
        f"{cut['solid 12 x 1']} and {cut['solid 16 x 1']} scenes cut at 8, 12 and 16).",
        f"- 36 x 2 costs {dear:.1f} times as much, and its worst scene is at {worst['solid 36 x 2']:.2%}, against {worst[DEFAULT]:.2%}.",
        "",
    ]


def _model_words(data: dict[str, Any]) -> list[str]:
    """What the atlas leaves to the solid, scene by scene, and what ``auto`` took."""
    atlas, auto = ({row["scene"]: row for row in data["rows"] if row["method"] == m} for m in MODEL_METHODS)
    solid = {row["scene"]: row for row in of(data["rows"], DEFAULT)}
    lines = []
    for scene in (s["scene"] for s in data["scenes"]):
        row, took, plain = atlas[scene], auto[scene], solid[scene]
        cell = f"none: {row['no_answer']}" if "no_answer" in row else f"{row['sensitivity_error']:+.2%}"
        lines.append(
            f"| {scene} | {cell} | {took['model']} | {took['sensitivity_error']:+.2%} | "
            f"{took['processor_s'] / plain['processor_s']:.3f} |"
        )
    inside = [row for row in atlas.values() if "no_answer" not in row]
    base = statistics.median(row["processor_s"] for row in solid.values())
    return [
        "### The atlas and the choice of `auto`",
        "",
        f"The [atlas](atlas.md) covers {len(inside)} of {len(atlas)} scenes. For one sensor a call, warm, it is {_atlas_ratio(data):.0f} times as fast as the default solid "
        f"(median); {AT_ONCE:,} sensors in one call cost {base / data['atlas_at_once_s']:,.0f} times less each. It has the errors of the solid, from which it is "
        "made. `auto` takes the cheapest model whose stated error meets its tolerance: the solid where the atlas does not cover a scene, or where "
        "the press ends by buckling or at the break strain, which the solid locates more exactly.",
        "",
        "| scene | atlas's error in sensitivity | auto took | its error | its time / default |",
        "|---|---|---|---|---|",
        *lines,
        "",
    ]


def atlas_words(data: dict[str, Any]) -> str:
    """What the atlas costs, in a sentence."""
    return f"The atlas has the same figures {_atlas_ratio(data):.0f} times as fast."


def _atlas_ratio(data: dict[str, Any]) -> float:
    """Processor time of the default over that of the atlas, for one sensor a call: median of the scenes that it covers."""
    default = {row["scene"]: row["processor_s"] for row in of(data["rows"], DEFAULT)}
    return statistics.median(default[row["scene"]] / row["processor_s"] for row in of(data["rows"], ATLAS))


def peer_words(peers: dict[str, Any]) -> str:
    """Times of inflation over those of other programs, in a sentence; empty where none was measured."""
    parts = []
    for program in ("FElupe", "CalculiX"):
        found = [_ratio(peers["rows"], program, key) for key in ("solve_s", "whole_s")]
        if None not in found:
            parts.append(f"{found[0]:.2f} of {program}'s time ({found[1]:.2f} with start and imports)")
    return f"Inflation at equal error takes {' and '.join(parts)}." if parts else ""


def _ratio(rows: list[dict[str, Any]], program: str, key: str) -> float | None:
    """Time of the cheapest run of pneutouch within the error over that of a program; None where either has no such run."""
    here, there = cheapest(rows, OURS, key), cheapest(rows, program, key)
    return None if here is None or there is None else here[key] / there[key]


def _target_section(data: dict[str, Any], peers: dict[str, Any]) -> list[str]:
    return ["### Targets", "", *verdicts(data, peers), ""]


def _peer_section(peers: dict[str, Any]) -> list[str]:
    rows = peers["rows"]
    base = cheapest(rows, OURS, "solve_s")
    if base is None or len({row["program"] for row in rows}) < 2:
        return ["### Other programs", "", *[f"- {name}: {why}." for name, why in peers["missing"].items()], ""]
    lines = [
        f"| {r['program']} | {r['cells_along']} x {r['cells_across']} | {r['steps']} | {r['limit_error']:+.3%} | "
        f"{r['solve_s'] / base['solve_s']:.1f} | {r['whole_s'] / base['solve_s']:.1f} |"
        for r in rows
    ]
    return [
        "### Other programs",
        "",
        "The paper's sensor in TangoPlus, nu 0.49, inflated to and through its limit point, on one thread, each program on the meshes that suit "
        "it best. Processor times are over the cheapest pneutouch solve within 0.5 %, median of three processes: the solve with its mesh, and the whole "
        "process with start, imports and files.",
        "",
        "- **FElupe** has no cavity. The apex height is prescribed and the pressure is one more unknown (a border around its matrices, added here). "
        "The least number of steps with which its Newton iteration converges, from a guess along the last step, was determined beforehand and not timed.",
        "- **CalculiX** has no arc length. Its pressure rises until no increment of 0.2 % converges, so that its error does not shrink with its mesh.",
        "",
        "| program | cells | steps | limit pressure | solve | whole process |",
        "|---|---|---|---|---|---|",
        *lines,
        "",
        f"{_same_mesh(rows)}",
        "",
    ]


def _same_mesh(rows: list[dict[str, Any]]) -> str:
    mine = {(r["cells_along"], r["cells_across"]): r for r in rows if r["program"] == OURS}
    parts = [
        f"{r['program']} {mine[key]['solve_s'] / r['solve_s']:.2f}"
        for r in rows
        if r["program"] != OURS and (key := (r["cells_along"], r["cells_across"])) == (24, 2) and key in mine
    ]
    return (
        "On the same mesh, 24 x 2, the solve of pneutouch takes this fraction of their time: "
        + ", ".join(parts)
        + ". The rest of the gain at 0.5 % comes from the element, whose coarsest meshes are within 0.5 %. Most of a whole process is the start of Python, "
        "NumPy and SciPy, which a running program needs once; CalculiX is compiled and has no such start."
    )


def _share_section(shares: dict[str, float]) -> list[str]:
    return [
        "### Where the time goes",
        "",
        "The default on all scenes under the profiler, which overestimates the cost of small functions. The time of locating a jump is also "
        "contained in the other rows.",
        "",
        "| part | share |",
        "|---|---|",
        *(f"| {part} | {share:.0%} |" for part, share in shares.items()),
        "",
    ]


def table(data: dict[str, Any]) -> list[str]:
    """Median and worst over the scenes, and the cost over that of the default."""
    base = statistics.median(row["processor_s"] for row in of(data["rows"], DEFAULT))
    lines = []
    for method in METHODS:
        rows = of(data["rows"], method)
        cost = statistics.median(row["processor_s"] for row in rows) / base
        cells = []
        for key in ("apex_error", "limit_error", "force_error", "sensitivity_error"):
            errors = sizes(rows, key)
            cells.append(f"{statistics.median(errors):.2%} / {max(errors):.2%}")
        cut = sum(row["range_share"] < CUT for row in rows)
        lines.append(f"| {method} | {cost:.3g} | {' | '.join(cells)} | {cut} | {len(rows)} |")
    return [
        "| method (cells along x across) | time / default | apex height | limit pressure | force | sensitivity | scenes cut | covered |",
        "|---|---|---|---|---|---|---|---|",
        *lines,
        "",
    ]


def scene_table(data: dict[str, Any]) -> list[str]:
    """The default on every scene, with the reference and its error."""
    mine = {row["scene"]: row for row in of(data["rows"], DEFAULT)}
    lines = []
    for scene in data["scenes"]:
        row, truth = mine[scene["scene"]], scene["reference"]
        lines.append(
            f"| {scene['scene']} | {truth['sensitivity_kPa_per_N']:.4f} ± {truth['sensitivity_error']:.2%} | "
            f"{row['sensitivity_error']:+.2%} | {row['force_error']:.2%} | {row['compared_to_mm']:.2f} | "
            f"{truth['ends']} | {row['own_sensitivity_kPa_per_N']:.4f} to {row['range_end_mm']:.2f}, {row['ends']} |"
        )
    return [
        "| scene | reference kPa/N | default's error | force | compared to mm | reference ends with | default over its full range |",
        "|---|---|---|---|---|---|---|",
        *lines,
        "",
    ]


def verdicts(data: dict[str, Any], peers: dict[str, Any]) -> list[str]:
    """Each target and whether it holds, in words and figures."""
    rows = of(data["rows"], DEFAULT)
    missed = [r for r in rows if abs(r["sensitivity_error"]) > SENSITIVITY_TARGET]
    worst = max(rows, key=lambda r: abs(r["sensitivity_error"]))
    times = [r["processor_s"] for r in rows]
    slow = [r["scene"] for r in rows if r["processor_s"] > SECONDS_TARGET]
    out = [
        f"- Sensitivity at the default resolution within {SENSITIVITY_TARGET:.0%} of the reference in every scene: "
        + (f"**not met** in {', '.join(r['scene'] for r in missed)}" if missed else "**met**")
        + f"; the worst is {worst['scene']}, {worst['sensitivity_error']:+.2%}.",
        f"- Studies 1 and 2 at the default resolution in at most {SECONDS_TARGET} s, median over the scenes: "
        f"**{'met' if statistics.median(times) <= SECONDS_TARGET else 'not met'}**, {statistics.median(times):.3f} s here, "
        f"greatest {max(times):.3f} s" + (f"; above the target: {', '.join(slow)}." if slow else "."),
    ]
    for program, target in (("FElupe", FELUPE_TARGET), ("CalculiX", CALCULIX_TARGET)):
        absent = [why for name, why in peers["missing"].items() if name.startswith(program)]
        out.append(f"- {program}: not measured, {absent[0]}." if absent else _against(peers["rows"], program, target))
    return out


def _against(rows: list[dict[str, Any]], program: str, target: float) -> str:
    parts = []
    for key, words in (("solve_s", "solve only"), ("whole_s", "whole process")):
        ours, theirs = cheapest(rows, OURS, key), cheapest(rows, program, key)
        if ours is None or theirs is None:
            parts.append(f"{words} **no run of {'pneutouch' if ours is None else program} within {WITHIN:.1%}**")
            continue
        share = ours[key] / theirs[key]
        mesh = f"{theirs['program']} {theirs['cells_along']} x {theirs['cells_across']}"
        parts.append(
            f"{words} {share:.2f} of its time (**{'met' if share <= target else 'not met'}**; pneutouch "
            f"{ours['cells_along']} x {ours['cells_across']} at {ours['limit_error']:+.2%}, {mesh} at {theirs['limit_error']:+.2%})"
        )
    return f"- Inflation sweep at {WITHIN:.1%} of the limit pressure, against {program} (target {target:.2f}): {'; '.join(parts)}."
