"""The section of docs/background/texture.md that compares the reduced model with finite elements."""

from __future__ import annotations

from typing import Any


def check(data: dict[str, Any]) -> list[str]:
    """The section on the reduced model against finite elements."""
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


def plane(data: dict[str, Any]) -> list[str]:
    """The paragraph on plane strain."""
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


def speed(data: dict[str, Any]) -> list[str]:
    """The paragraph on processor time."""
    speed = data["speed"]
    return [
        f"**Speed.** The finite elements (cells of 0.5 mm, eight places) take {_round(speed['fe_over_reduced'])} times the processor time of the reduced "
        f"model on the whole path. Sliding over the 60 mm block at 10 kHz and the scalogram, without the dome's loading curve and the detection, take {speed['scan_with_spectrum_s']:.2f} s.",
        "",
    ]


def _round(value: float) -> str:
    return f"{float(f'{value:.1g}'):,.0f}"
