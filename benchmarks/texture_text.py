"""The text of docs/texture.md from measured numbers."""

from __future__ import annotations

from typing import Any


def page(data: dict[str, Any]) -> str:
    """The whole page."""
    return "\n".join(
        [
            *_what(data),
            *_scan(data),
            *_check(data),
            *_plane(data),
            *_speed(data),
            *_sweeps(data),
            *_claim(data),
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


def _check(data: dict[str, Any]) -> list[str]:
    rows = [
        f"| {row['pitch']:g} | {row['depth']:g} | {row['radius']:.2f} | {1e3 * row['fe']:+.3f} | {100 * abs(row['coarse'] / row['fe'] - 1):.0f} % | "
        f"{1e3 * row['reduced']:+.3f} | {row['reduced'] / row['fe']:.2f} |"
        for row in data["single"]
    ]
    both = [
        f"| {row['depth']:g} | {row['radius']:.2f} | {1e3 * row['fe_3']:+.2f} | {1e3 * row['reduced_3']:+.2f} | {1e3 * row['fe_6']:+.2f} | "
        f"{1e3 * row['reduced_6']:+.2f} | {abs(row['fe_3'] / row['fe_6']):.2f} | {abs(row['reduced_3'] / row['reduced_6']):.2f} |"
        for row in data["both"]
    ]
    return [
        "## The reduced model against finite elements",
        "",
        "![Amplitude of the compliance over depth by both](texture-check.svg)",
        "",
        "The reference is a strip of Agilus30 with bars of Vero, meshed in section and in Fourier waves along the bars, under a "
        "uniform disc. It contains nothing of the reduced model. Amplitude of c at the pitch in um/N, negative where c is least over a bar. "
        "*Cells* is the change from halving the cells from 0.5 to 0.25 mm; the remaining error is about as large: under 4 % where the amplitude is above "
        "0.03 um/N.",
        "",
        "| pitch mm | depth mm | patch mm | finite elements | cells | reduced | ratio |",
        "|---|---|---|---|---|---|---|",
        *rows,
        "",
        *_ratios(data),
        "The shipped specimen has both patterns, one over the other: amplitudes at 3 mm and 6 mm, and their ratio.",
        "",
        "| buried at mm | patch mm | 3 mm, FE | reduced | 6 mm, FE | reduced | surface/buried, FE | reduced |",
        "|---|---|---|---|---|---|---|---|",
        *both,
        "",
        *_verdict(data),
    ]


def _ratios(data: dict[str, Any]) -> list[str]:
    """Surface 3 mm pattern over buried 6 mm pattern, each alone."""
    at = {(row["pitch"], row["depth"], row["radius"]): row for row in data["single"]}
    radii = sorted({row["radius"] for row in data["single"]})
    plane = {(row["pitch"], row["depth"], row["radius"]): row["fe"] for row in data["plane"]}
    lines = []
    for radius in radii:
        for depth in (1.0, 2.0, 3.0):
            top, low = at[3.0, 0.0, radius], at[6.0, depth, radius]
            fe, ours = abs(top["fe"] / low["fe"]), abs(top["reduced"] / low["reduced"])
            flat = abs(plane[3.0, 0.0, radius] / plane[6.0, depth, radius])
            lines.append(
                f"| {depth:g} | {radius:.2f} | {fe:.2f} | {ours:.2f} | {100 * (ours / fe - 1):+.0f} % | {flat:.2f} |"
            )
    return [
        "Surface pattern (3 mm) over buried pattern (6 mm), each alone in the block:",
        "",
        "| buried at mm | patch mm | finite elements | reduced | error | plane strain |",
        "|---|---|---|---|---|---|",
        *lines,
        "",
    ]


def _plane(data: dict[str, Any]) -> list[str]:
    rows = data["plane"]
    change = max(abs(row["coarse"] / row["fe"] - 1) for row in rows)
    return [
        "**Plane strain is a different specimen.** The same strip under a patch infinite along the bars, which lets bars sink as a whole "
        f"(cells of 0.25 and 0.125 mm, {100 * change:.1f} % apart at most). There a bar is not fixed, and the pattern is strongest "
        f"{_strongest(rows)}. A reduced model made for plane strain would not apply "
        "here, and this one does not apply to plane strain.",
        "",
        "| pitch mm | depth mm | half width mm | amplitude um/(N/mm) |",
        "|---|---|---|---|",
        *(f"| {row['pitch']:g} | {row['depth']:g} | {row['radius']:.2f} | {1e3 * row['fe']:+.2f} |" for row in rows),
        "",
    ]


def _strongest(rows: list[dict[str, float]]) -> str:
    """At which depth each column of the plane strain table is greatest."""
    best: dict[tuple[float, float], dict[str, float]] = {}
    for row in rows:
        key = row["pitch"], row["radius"]
        if key not in best or abs(row["fe"]) > abs(best[key]["fe"]):
            best[key] = row
    said = [f"{row['depth']:g} mm deep at {pitch:g} mm under {radius:.2f} mm" for (pitch, radius), row in best.items()]
    return ", ".join(said)


def _speed(data: dict[str, Any]) -> list[str]:
    speed = data["speed"]
    return [
        f"**Speed.** The finite elements (cells of 0.5 mm, eight places) take {_round(speed['fe_over_reduced'])} times the processor time of the reduced "
        f"model on the whole path. Sliding over the 60 mm block at 10 kHz and the scalogram, without the dome's loading curve and the detection, take {speed['scan_with_spectrum_s']:.2f} s.",
        "",
    ]


def _round(value: float) -> str:
    return f"{float(f'{value:.1g}'):,.0f}"


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


def _verdict(data: dict[str, Any]) -> list[str]:
    def span(pitch: float, small: bool) -> str:
        radii = [row["radius"] for row in data["single"]]
        radius = min(radii) if small else max(radii)
        ratios = [
            row["reduced"] / row["fe"] for row in data["single"] if (row["pitch"], row["radius"]) == (pitch, radius)
        ]
        return f"{min(ratios):.2f} to {max(ratios):.2f}"

    return [
        f"Reduced over finite elements: pitch 6 mm under the small patch {span(6.0, True)}, under the large one {span(6.0, False)}; pitch 3 mm "
        f"{span(3.0, True)} and {span(3.0, False)}. At 3 mm it is too high because bars 1 mm high do sink with their neighbours. At 6 mm the large patch "
        "is close to the zero of its filter (rho = 0.61 pitches). There, and where almost nothing is left (3 mm, 2 mm deep and deeper), the model result is no "
        "more than 'small': it has the zero of the surface at every depth, while the load under a deep bar has no sharp edge. Where the surface pattern "
        "lies over the buried one, the buried one is shielded more than in the model.",
        "",
    ]


def _claim(data: dict[str, Any]) -> list[str]:
    found = _pascals(data)
    rows = [f"| {name} | {a:.2f} | {b:.2f} | {b / a:.1f} | {c:.2f} | {d:.2f} |" for name, (a, b, c, d) in found.items()]
    return [
        "## The paper's claim",
        "",
        "The caption of Figure 9 states that the soft state (0 kPa) shows the surface pattern, at the higher frequency, more sharply, and the stiff state "
        "(22 kPa) the buried one. The body text states that the soft state is better at the lower frequency. These contradict each other. (3 and 6 mm at "
        "4 mm/s are 1.33 and 0.67 Hz, not the 1.5 and 0.75 Hz of the caption.)",
        "",
        "| pattern, in the shipped specimen | soft Pa, FE | stiff Pa, FE | stiff/soft | soft Pa, reduced | stiff Pa, reduced |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        *_compared(found, data["scan"]["states"]),
        "- **What the model does not cover.** A soft state that is better at the surface needs an effect that grows with softness and acts at short "
        "distance: relief of the surface, into which an unpressurised wall sags; friction, which the paper lowers with lubricant "
        "but does not remove; bending of the wall over an edge. None of them is in the model, and a relief of some micrometres (table above) "
        "has as much effect as the whole compliance of the specimen. The paper states neither the depths nor the sections of its bars, nor amplitudes: "
        "its figure cannot be compared number by number.",
        "",
    ]


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
    gains = [row[1] / row[0] for row in found.values()]
    lean = {
        half: [found[f"surface (over {half})"][k] / found[buried][k] for k in (0, 1)]
        for half, buried in (("pattern 2", "pattern 2, 2 mm deep"), ("pattern 1", "pattern 1, 4 mm deep"))
    }
    two, one = lean["pattern 2"], lean["pattern 1"]
    nearer = [found["pattern 2, 2 mm deep"][k] / found["pattern 1, 4 mm deep"][k] for k in (0, 1)]
    return [
        f"- **The stiff state shows every pattern better**, by finite elements {min(gains):.1f} to {max(gains):.1f} times, for one reason: its patch is "
        "smaller. Neither statement, that the soft state is better at the lower frequency (body text) or at the higher (caption), is "
        "reproduced in terms of amplitudes.",
        f"- **Which of the two patterns is larger.** Surface over buried, soft and stiff: {two[0]:.2f} and {two[1]:.2f} over pattern 2, {one[0]:.2f} and {one[1]:.2f} "
        "over pattern 1. Over pattern 2 this is the order of the caption (soft: the surface a little larger; stiff: the buried one), over pattern 1 "
        "the reverse. The reduced model has the caption's order much more strongly over pattern 2, but only because its patch of 3.58 mm is close to the zero "
        "for 6 mm, where its error is greatest: this is no support.",
        f"- **Pattern 2 sharper than pattern 1** in the stiff state, since it is nearer: yes, {nearer[1]:.1f} times. In the soft state they are alike ({nearer[0]:.2f}).",
        f"- **What is detected, with the noise assumed here** (p up to 0.05, seed 0): {_found(states)}. With less noise both states would show both.",
    ]


def _found(states: list[dict[str, Any]]) -> str:
    """Which patterns each state shows."""
    said = []
    for state in states:
        names = [pattern["name"] for pattern in state["patterns"] if pattern["detected"]]
        said.append(f"at {state['label']} {', '.join(names) or 'none'}")
    return "; ".join(said)


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
