"""The text of docs/background/texture.md from measured numbers."""

from __future__ import annotations

from typing import Any

from benchmarks.texture_check_text import check, plane, speed
from benchmarks.texture_claim_text import claim


def page(data: dict[str, Any]) -> str:
    """The whole page."""
    return "\n".join(
        [
            *_what(data),
            *_scan(data),
            *check(data),
            *plane(data),
            *speed(data),
            *_sweeps(data),
            *claim(data),
            *_advice(data),
            *_separate(data),
            *_cannot(),
        ]
    )


def _what(data: dict[str, Any]) -> list[str]:
    bend = [pattern["bending_length_mm"] for pattern in data["scan"]["patterns"]]
    rho = [state["contact_radius_mm"] for state in data["scan"]["states"]]
    return [
        "# Texture: which state shows which pattern",
        "",
        "`make texture-page` writes this page. `pneutouch scan texture-specimen --design paper-dome` slides the paper's sensor over the "
        "specimen of its Figure 9 in a reduced model. This page describes the model, its error, and its result for the "
        "paper's claim.",
        "",
        "## What modulates the pressure",
        "",
        "The dome (stiffness k) and the specimen (compliance c) are springs in series. The sensor is lowered to the preload F, then held "
        "at that height. Where the specimen yields less, the dome is pressed more:",
        "",
        "    dp = -dp/d(delta) F dc / (1 + k c)",
        "",
        "k, dp/d(delta) and the radius rho of the contact patch come from the atlas (or the solid), including Boyle's gas and dead volume. For c, bars "
        "of Vero in Agilus30 are 4,500 times stiffer than the matrix: a perturbation in the moduli is not applicable, and a bar is a "
        "beam that spreads the load of the patch over "
        f"{min(bend):.1f} (surface) to {max(bend):.1f} mm (buried) of its length, against patches {2 * min(rho):.1f} and {2 * max(rho):.1f} mm across: the buried bars "
        "hardly bend, the surface bars do under the larger patch. Bars are assumed to be fixed: over a bar only the cover "
        "is indented, over a gap the whole layer. Between the two the model uses the true bar profile, with each harmonic filtered by",
        "",
        "- the patch: 2 J1(k rho)/(k rho), so that a uniform disc does not detect a pattern at k rho = 3.83;",
        "- the cover: the part of a pressure wave on top that reaches a plate at the depth of the bars;",
        "- the field: mean compliance with bars over that without, of every row at the same position.",
        "",
        "At constant force the state of the dome does not change at all in this model: the pressure shows nothing, only the height of the sensor "
        "does. The paper presses to 0.5 N and then moves; it does not state which of the two was held constant. With a force controller it would have measured only the "
        "small effects that this model leaves out.",
        "",
    ]


def _scan(data: dict[str, Any]) -> list[str]:
    said = data["scan"]
    rows = [
        f"| {state['label']} | {pattern['name']} | {pattern['true_frequency_Hz']:.3f} | {pattern['detected_frequency_Hz']:.3f} | "
        f"{1e3 * pattern['model_amplitude_kPa']:.2f} | {1e3 * pattern['amplitude_kPa']:.2f} | {pattern['detection_figure']:.1f} | "
        f"{pattern['p_value']:.3f} | {'yes' if pattern['detected'] else 'no'} | {pattern['sinking_amplitude_um']:.2f} | {pattern['relief_equivalent_um']:.0f} |"
        for state in said["states"]
        for pattern in state["patterns"]
    ]
    states = [
        f"| {state['label']} | {state['contact_radius_mm']:.2f} | {state['stiffness_N_per_mm']:.3f} | "
        f"{state['pressure_slope_kPa_per_mm']:.3f} | {state['specimen_compliance_mm_per_N']:.4f} |"
        for state in said["states"]
    ]
    return [
        "## The shipped specimen under the paper's sensor",
        "",
        "![Pressure less its mean, and scalogram, at 0 and at 22 kPa](texture-scan.svg)",
        "",
        "| state | patch radius mm | k N/mm | dp/d(delta) kPa/mm | mean c mm/N |",
        "|---|---|---|---|---|",
        *states,
        "",
        "| state | pattern | true Hz | detected Hz | model Pa | measured Pa | over noise | p | detected | sinking um | relief um |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
        *rows,
        "",
        "Patterns 1 and 2 have the same pitch and one half of the path each; the spectral line is that of both. The noise floor is estimated from the same "
        "record, of which a few independent segments lie outside the cone of influence: a line five times above it can still be chance. *Sinking* is the "
        "amplitude by which the specimen yields under the patch and 0.5 N. *Relief* is the amplitude of a surface wave at the same pitch with "
        "the same effect on the patch: a few micrometres, where a printed layer is 27 um.",
        "",
        "Amplitudes are a few pascal, at most a third of one step of the recorder (0.0153 kPa). They are detected because noise of "
        "0.015 kPa a sample at 10 kHz, which is assumed, leaves about 0.1 Pa in a voice at these frequencies; drift and hum "
        "of a real rig come in addition.",
        "",
    ]


def _sweeps(data: dict[str, Any]) -> list[str]:
    noise = data["sweeps"]["noise"]
    return [
        "## Over driving pressure, depth, pitch and preload",
        "",
        "![Pressure amplitude over driving pressure, depth, pitch and preload](texture.svg)",
        "",
        "Single rows, bar as wide as gap, 0.5 N unless given. The amplitude is the root mean square over patches 15 % smaller, as predicted, and "
        "15 % larger, since a real patch has no sharp edge and no exact zero. The dotted line is the reading of white noise at "
        f"1.33 Hz ({noise[0]:.2f} Pa; {noise[1]:.2f} Pa at 0.67 Hz).",
        "",
        *_trends(data),
    ]


def _trends(data: dict[str, Any]) -> list[str]:
    sweeps = data["sweeps"]
    rows = sweeps["pressure"]["y"]
    gains = ", ".join(f"{row[-1] / row[0]:.1f}" for row in rows)
    pairs = [
        (soft, stiff, (name, x))
        for name in ("depth", "pitch", "preload")
        for k in (0, 2)
        for soft, stiff, x in zip(sweeps[name]["y"][k], sweeps[name]["y"][k + 1], sweeps[name]["x"], strict=True)
        if soft is not None and stiff is not None
    ]
    preload = ", ".join(f"{row[-1] / row[0]:.1f}" for row in sweeps["preload"]["y"])
    better = [(soft / stiff, where) for soft, stiff, where in pairs if soft > stiff]
    where = "at none of" if not better else f"at {len(better)} of"
    most = (
        "" if not better else f", by at most {max(better)[0]:.2f} times (at {max(better)[1][0]} {max(better)[1][1]:g})"
    )
    return [
        f"- From 0 to 22 kPa the three patterns of the first panel gain {gains} times: the patch is smaller at the same force.",
        f"- The soft state shows more than the stiff one {where} the {len(pairs)} depths, pitches and preloads drawn{most}.",
        "- Depth attenuates a short pitch more than a long one: 3 mm bars cannot be detected at 3 mm, 6 mm bars at 6 mm.",
        f"- More preload is more force on a larger patch. From {sweeps['preload']['x'][0]:g} to {sweeps['preload']['x'][-1]:g} N the four lines change by "
        f"{preload} times, with extremes in between.",
        "",
    ]


def _advice(data: dict[str, Any]) -> list[str]:
    rows = [
        f"| {row['pitch']:g} | {row['depth']:g} | {row['kPa']:.0f} | {row['Pa']:.2f} | {row['Pa_at_0']:.2f} |"
        for row in data["advice"]
    ]
    return [
        "## Which driving pressure",
        "",
        "`texture.separate.recommend(pattern, sensor, matrix, highest)` gives the pressure with the greatest amplitude; here for the paper's "
        "sensor at 0.5 N up to 22 kPa.",
        "",
        "| pitch mm | depth mm | driving pressure kPa | Pa there | Pa at 0 kPa |",
        "|---|---|---|---|---|",
        *rows,
        "",
    ]


def _separate(data: dict[str, Any]) -> list[str]:
    found = data["separate"]
    rows = [
        f"| {dome['rank']} | {dome['resin']} | {dome['inner_radius_mm']:.2f} | {dome['wall_thickness_mm']:.2f} | "
        + " | ".join(
            f"{state['driving_pressure_kPa']:.1f} | {1e3 * state['amplitudes_kPa'][0]:.2f} / {1e3 * state['amplitudes_kPa'][1]:.2f}"
            for state in dome["states"]
        )
        + f" | {dome['contrast']:.1f} |"
        for dome in found["domes"]
    ]
    return [
        "## Which dome distinguishes two patterns",
        "",
        "`pneutouch scan texture-specimen --design paper-dome --separate 3@0,6@2` searches "
        f"{found['candidates']:,} candidates (resin, radius, wall, driving pressure up to the dome's rated pressure; everything else from the design). *Contrast*: the ratio by which one "
        "driving pressure favours the surface pattern more than another. Amplitudes are those of the surface and the buried pattern in Pa; each state must "
        "show its pattern three times above white noise, and no dome is selected for being at a zero (the same 15 % as above).",
        "",
        "| | resin | R0 mm | t0 mm | 1st kPa | Pa | 2nd kPa | Pa | contrast |",
        "|---|---|---|---|---|---|---|---|---|",
        *rows,
        "",
        "The best domes are of stiff resins that withstand up to 90 kPa: there the driving pressure changes the patch most. Part of their contrast comes from "
        "the side lobes of the short pitch, where the model is two- to fivefold too high. The list is a selection for a test, not a result.",
        "",
    ]


def _cannot() -> list[str]:
    return [
        "## What is left out",
        "",
        "Not included: relief of the surface, friction, adhesion, inertia; relaxation of the resins (a bar passes in 0.4 s, and Agilus30 at that rate is several times "
        "stiffer than the relaxed modulus used: c is lower by the same factor); the non-uniform pressure under the dome, most of all without "
        "driving pressure; the sides of the block; bars that touch the floor; layers other than bars, which `scan` refuses. The noise of the pressure sensor and the "
        "recorder is assumed: `--noise` sets it.",
        "",
    ]
