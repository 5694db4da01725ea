"""The text of docs/background/texture.md from measured numbers."""

from __future__ import annotations

from typing import Any

from benchmarks.texture_check_text import check, ratios
from benchmarks.texture_claim_text import claim, gains


def page(data: dict[str, Any]) -> str:
    """The whole page."""
    return "\n".join(
        [
            *_answer(data),
            *_model(data),
            *_scan(data),
            *claim(data),
            *_sweeps(data),
            *_advice(data),
            *_separate(data),
            *check(data),
            *_cannot(),
        ]
    )


def _answer(data: dict[str, Any]) -> list[str]:
    least, most = gains(data)
    return [
        "# Texture: which state shows which pattern",
        "",
        "Which driving pressure shows a texture best? By finite elements the stiff state (22 kPa) shows every pattern of the paper's specimen "
        f"{least:.1f} to {most:.1f} times better than the soft state (0 kPa), because its contact patch is smaller. "
        "That the soft state is better at one of the two frequencies, as the paper states, is not reproduced. "
        f"The reduced model that `scan` uses gives {ratios(data, 6.0, True)} times the amplitudes of the finite elements at a pitch of 6 mm under this "
        f"patch, and {ratios(data, 3.0, True)} times at 3 mm.",
        "",
        "![Pressure less its mean, and scalogram, at 0 and at 22 kPa](texture-scan.svg)",
        "",
        "*`pneutouch scan texture-specimen --design paper-dome`: pressure less its mean over the path, and its wavelet scalogram, at 0 and at 22 kPa.*",
        "",
        "The specimen is that of the paper's Figure 9 ([specimens.md](../howto/specimens.md)). `make texture-page` writes this page.",
        "",
    ]


def _model(data: dict[str, Any]) -> list[str]:
    bend = [pattern["bending_length_mm"] for pattern in data["scan"]["patterns"]]
    rho = [state["contact_radius_mm"] for state in data["scan"]["states"]]
    return [
        "## The reduced model",
        "",
        "The dome (stiffness k) and the specimen (compliance c) are springs in series. The sensor is lowered to the preload F and held at "
        "that height. Where the specimen yields less, the dome is pressed more:",
        "",
        "$$",
        r"dp = -\frac{dp}{d\delta} \, \frac{F \, dc}{1 + k c}",
        "$$",
        "",
        "k, dp/d(delta) and the radius rho of the contact patch come from the atlas or the solid. The bars are of Vero, 4,500 times stiffer than the Agilus30 around "
        "them, and taken as fixed: over a bar only the cover is indented, over a gap the whole layer. (A bar spreads the load over "
        f"{min(bend):.1f} mm at the surface to {max(bend):.1f} mm where it is buried, and the patches are {2 * min(rho):.1f} and {2 * max(rho):.1f} mm across: only surface "
        "bars under the larger patch bend.) Each harmonic of the profile of the bars, of wave number q, is multiplied by",
        "",
        "- the patch filter 2 J1(q rho)/(q rho): a uniform disc does not detect a pattern at q rho = 3.83;",
        "- the share of a pressure wave on the surface that reaches a plate at the depth of the bars;",
        "- the mean compliance with bars over that without.",
        "",
        "At constant force only the height would change, not the pressure. The paper presses to 0.5 N and does not state which was held constant.",
        "",
    ]


def _scan(data: dict[str, Any]) -> list[str]:
    states = [
        f"| {state['label']} | {state['contact_radius_mm']:.2f} | {state['stiffness_N_per_mm']:.3f} | "
        f"{state['pressure_slope_kPa_per_mm']:.3f} | {state['specimen_compliance_mm_per_N']:.4f} |"
        for state in data["scan"]["states"]
    ]
    return [
        "## The specimen under the paper's sensor",
        "",
        "| state | patch radius rho, mm | k, N/mm | dp/d(delta), kPa/mm | mean c, mm/N |",
        "|---|---|---|---|---|",
        *states,
        "",
        "| state | pattern | true Hz | detected Hz | model Pa | measured Pa | over noise | p | detected | sinking um | relief um |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
        *_lines(data),
        "",
        "*Measured* is read from the scalogram of the simulated signal; patterns 1 and 2 have one pitch, one half of the path each and one spectral line. "
        "*Over noise*: the noise floor comes from the same record, with few independent segments, so a line five times above it can "
        "still be chance. *Sinking*: amplitude by which the specimen yields at 0.5 N. *Relief*: amplitude of a surface wave of the same pitch with the same effect; "
        "a printed layer is 27 um.",
        "",
        "The amplitudes are at most a third of one step of the recorder (0.0153 kPa). They are detected because the assumed noise of 0.015 kPa a sample "
        "at 10 kHz leaves about 0.1 Pa in a voice. Drift and hum of a real rig come in addition.",
        "",
    ]


def _lines(data: dict[str, Any]) -> list[str]:
    """A row for each pattern in each state."""
    return [
        f"| {state['label']} | {pattern['name']} | {pattern['true_frequency_Hz']:.3f} | {pattern['detected_frequency_Hz']:.3f} | "
        f"{1e3 * pattern['model_amplitude_kPa']:.2f} | {1e3 * pattern['amplitude_kPa']:.2f} | {pattern['detection_figure']:.1f} | "
        f"{pattern['p_value']:.3f} | {'yes' if pattern['detected'] else 'no'} | {pattern['sinking_amplitude_um']:.2f} | {pattern['relief_equivalent_um']:.0f} |"
        for state in data["scan"]["states"]
        for pattern in state["patterns"]
    ]


def _sweeps(data: dict[str, Any]) -> list[str]:
    noise = data["sweeps"]["noise"]
    return [
        "## Over driving pressure, depth, pitch and preload",
        "",
        "![Pressure amplitude over driving pressure, depth, pitch and preload](texture.svg)",
        "",
        "*One row of bars, bar as wide as gap, 0.5 N unless given, by the reduced model. The amplitude is the root mean square over patches 15 % smaller, as predicted and "
        f"15 % larger, since a real patch has no sharp edge. Dotted: white noise at 1.33 Hz ({noise[0]:.2f} Pa; {noise[1]:.2f} Pa at 0.67 Hz).*",
        "",
        *_trends(data),
    ]


def _trends(data: dict[str, Any]) -> list[str]:
    sweeps = data["sweeps"]
    rows = sweeps["pressure"]["y"]
    rises = ", ".join(f"{row[-1] / row[0]:.1f}" for row in rows)
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
        f"- From 0 to 22 kPa the three patterns of the first panel gain {rises} times: the patch is smaller at the same force.",
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
        "`texture.separate.recommend(pattern, sensor, matrix, highest)` gives the driving pressure with the greatest amplitude. For the paper's sensor at "
        "0.5 N, up to 22 kPa:",
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
        f"{found['candidates']:,} candidates (resin, radius, wall, driving pressure up to the dome's rated pressure; the rest is the design's). *Contrast* is the ratio by which the first "
        "driving pressure favours the surface pattern more than the second. Amplitudes are those of surface / buried pattern. Each state must "
        "show its pattern three times above white noise; the mean over three patches, as above, keeps domes out that are only at a zero.",
        "",
        "| | resin | R0 mm | t0 mm | 1st kPa | Pa | 2nd kPa | Pa | contrast |",
        "|---|---|---|---|---|---|---|---|---|",
        *rows,
        "",
        "The best domes are of stiff resins that withstand up to 90 kPa, where the driving pressure changes the patch most. Part of the contrast comes from "
        "side lobes of the short pitch, where the model is two to five times too high: the list selects domes for a test.",
        "",
    ]


def _cannot() -> list[str]:
    return [
        "## What is left out",
        "",
        "- **Surface.** Relief, friction, adhesion and inertia.",
        "- **Relaxation.** A bar passes in 0.4 s. Agilus30 at that rate is several times stiffer than the relaxed modulus used, and c is lower by the same factor.",
        "- **Load.** The pressure under the dome is taken as uniform. It is least so without driving pressure.",
        "- **Specimen.** The sides of the block and bars that touch the floor. `scan` refuses layers other than bars.",
        "- **Noise** of the pressure sensor and the recorder is assumed; `--noise` sets it.",
        "",
    ]
