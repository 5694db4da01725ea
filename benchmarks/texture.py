"""The scan model and finite elements on Figure 9 of the paper: ``python -m benchmarks.texture`` (a few minutes).

Writes docs/background/texture.json; with ``stored`` it reduces the stored numbers anew.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from benchmarks.store import LIBRARY, store, stored, timed
from benchmarks.strip import AGILUS, Row, Strip, harmonic
from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.results.record import plain
from pneutouch.spec.options import ScanOptions
from pneutouch.texture.scalogram import scalogram
from pneutouch.texture.separate import BarPattern, amplitudes, noise_amplitude, recommend
from pneutouch.texture.sliding import scan
from pneutouch.texture.substrate import BarRow, MatrixLayer, Substrate, amplitude
from pneutouch.units import KPA
from pneutouch.workflows.scan import run_scan, separating
from pneutouch.workflows.scanned import scanned

CELL, LENGTH, HEIGHT = 0.5, 24.0, 8.0
DEPTHS, KINDS = (0.0, 1.0, 2.0, 3.0), {3.0: (1.5, 1.0), 6.0: (3.0, 1.5)}
SURFACE = Row(3.0, 1.5, 1.0, 0.0, 0.75)
PLACES = 3.0 + 0.75 * np.arange(8)
"""Over one buried pitch, from the middle of a buried bar, which is the middle of a gap of the surface pattern."""
_DIGITS = 5


def measure() -> dict[str, Any]:
    """All numbers of the page."""
    run = run_scan("texture-specimen", "paper-dome", library=LIBRARY)
    radii = [seen.touch.contact_radius for seen in run.seen if seen.touch is not None]
    return {
        "scan": plain(scanned(run)),
        "single": single(radii),
        "both": both(radii),
        "plane": plane(radii),
        "speed": speed(run),
        "sweeps": sweeps(run),
        "advice": advice(run),
        "separate": plain(separating("texture-specimen", "paper-dome", "3@0,6@2", ScanOptions(), library=LIBRARY)),
    }


def _bars(row: Row, length: float = LENGTH) -> BarRow:
    first = np.arange(row.first, length, row.pitch)
    return BarRow(
        f"{row.pitch:g}@{row.depth:g}",
        row.pitch,
        row.width,
        row.height,
        row.depth,
        np.stack([first, first + row.width], 1),
    )


def single(radii: list[float]) -> list[dict[str, float]]:
    """One row of bars under a disc: amplitude of the compliance by finite elements and by the reduced model, mm/N."""
    found = []
    for pitch, (width, height) in KINDS.items():
        for depth in DEPTHS:
            row = Row(pitch, width, height, depth)
            at = width / 2 + pitch * np.arange(8) / 8
            for radius in radii:
                coarse, fe = (
                    Strip(LENGTH, HEIGHT, cell, (row,)).disc_compliance(at, radius) for cell in (CELL, CELL / 2)
                )
                ours = -float(amplitude(MatrixLayer(HEIGHT, *AGILUS), _bars(row), np.array(radius)))
                found.append(
                    {
                        "pitch": pitch,
                        "depth": depth,
                        "radius": radius,
                        "fe": harmonic(fe),
                        "reduced": ours,
                        "coarse": harmonic(coarse),
                        "fe_mean": float(fe.mean()),
                    }
                )
    return found


def both(radii: list[float]) -> list[dict[str, float]]:
    """The shipped specimen's two halves, amplitudes at 3 and 6 mm by finite elements and by the reduced model, mm/N."""
    found = []
    for depth in (2.0, 4.0):
        rows = (SURFACE, Row(6.0, 3.0, 1.5, depth, 1.5))
        for radius in radii:
            fe = Strip(LENGTH, HEIGHT, CELL / 2, rows).disc_compliance(PLACES, radius)
            bars = tuple(map(_bars, rows))
            ground = Substrate(MatrixLayer(HEIGHT, *AGILUS), bars, LENGTH, radius)
            found.append(
                {
                    "depth": depth,
                    "radius": radius,
                    "fe_3": harmonic(fe, 2),
                    "fe_6": harmonic(fe),
                    "fe_mean": float(fe.mean()),
                    "reduced_3": ground.amplitude(bars[0]),
                    "reduced_6": -ground.amplitude(bars[1]),
                    "reduced_mean": float(ground.compliance(2048).mean()),
                }
            )
    return found


def plane(radii: list[float]) -> list[dict[str, float]]:
    """Plane strain, a patch as wide as the disc: amplitudes in cells of 0.25 and 0.125 mm, mm/(N/mm)."""
    found = []
    for pitch, (width, height) in KINDS.items():
        for depth in DEPTHS:
            row, at = Row(pitch, width, height, depth), width / 2 + pitch * np.arange(8) / 8
            for radius in radii:
                fe = [harmonic(Strip(LENGTH, HEIGHT, c, (row,)).strip_compliance(at, radius)) for c in (0.25, 0.125)]
                found.append({"pitch": pitch, "depth": depth, "radius": radius, "fe": fe[1], "coarse": fe[0]})
    return found


def speed(run: Any) -> dict[str, float]:
    """Processor time of the finite elements over the reduced model's for one state of one specimen; and a scan's in s."""
    state = run.seen[0]
    rows = (SURFACE, Row(6.0, 3.0, 1.5, 2.0, 1.5))
    radius, matrix = state.touch.contact_radius, MatrixLayer(HEIGHT, *AGILUS)
    _, fe = timed(lambda: Strip(LENGTH, HEIGHT, CELL, rows).disc_compliance(PLACES, radius))
    bars = tuple(map(_bars, rows))
    _, tenfold = timed(lambda: [Substrate(matrix, bars, LENGTH, radius).compliance(2048) for _ in range(10)])
    _, scanned = timed(lambda: scalogram(scan(state.touch, state.substrate, run.path).signal, 0.3, 3.0))
    return {"fe_over_reduced": 10 * fe / tenfold, "scan_with_spectrum_s": scanned}


def sweeps(run: Any) -> dict[str, Any]:
    """Amplitudes in Pa, blurred as in `recommend`: over driving pressure, depth, pitch and preload."""
    matrix, sensor = run.matrix, run.sensor
    pressures = np.linspace(0.0, 22.0, 23) * KPA
    ends = batch_of(sensor, np.array([0.0, 22.0]) * KPA)
    depths, pitches, preloads = np.linspace(0, 6, 25), np.linspace(2, 12, 41), np.linspace(0.1, 1.0, 19)

    def pascals(found: Array) -> list[Any]:
        pascal = np.round(found / KPA * 1e3, _DIGITS).tolist()
        return [[None if np.isnan(value) else value for value in row] for row in pascal]

    kinds = [BarPattern(3.0, 0.0), BarPattern(6.0, 2.0), BarPattern(6.0, 4.0)]
    return {
        "pressure": {
            "x": (pressures / KPA).tolist(),
            "y": pascals(amplitudes(batch_of(sensor, pressures), 0.5, matrix, kinds).T),
        },
        "depth": {
            "x": depths.tolist(),
            "y": pascals(
                np.concatenate(
                    [amplitudes(ends, 0.5, matrix, [BarPattern(p, float(d)) for d in depths]) for p in (3.0, 6.0)]
                )
            ),
        },
        "pitch": {
            "x": pitches.tolist(),
            "y": pascals(
                np.concatenate(
                    [amplitudes(ends, 0.5, matrix, [BarPattern(float(p), d) for p in pitches]) for d in (0.0, 2.0)]
                )
            ),
        },
        "preload": {
            "x": preloads.tolist(),
            "y": pascals(np.stack([amplitudes(ends, float(f), matrix, kinds[:2]).T.ravel() for f in preloads], axis=1)),
        },
        "noise": [noise_amplitude(4 / 3) / KPA * 1e3, noise_amplitude(4 / 6) / KPA * 1e3],
    }


def advice(run: Any) -> list[dict[str, float]]:
    """The recommended driving pressure of a few patterns, up to 22 kPa."""
    found = []
    limit = float(respond(batch_of(run.sensor, [0.0]), run.sensor.protocol.steps).limit_pressure[0])
    for pitch, depth in ((3.0, 0.0), (6.0, 0.0), (6.0, 2.0), (6.0, 4.0), (10.0, 2.0), (15.0, 4.0), (30.0, 2.0)):
        best = recommend(BarPattern(pitch, depth), run.sensor, run.matrix, min(22 * KPA, 0.8 * limit))
        found.append(
            {
                "pitch": pitch,
                "depth": depth,
                "kPa": best.driving_pressure / KPA,
                "Pa": 1e3 * best.amplitude / KPA,
                "Pa_at_0": 1e3 * best.unpressurised / KPA,
            }
        )
    return found


def pascals(data: dict[str, Any]) -> dict[str, dict[str, list[float]]]:
    """By pattern of the specimen: amplitudes in Pa, soft and stiff, by finite elements and by the reduced model."""
    states, scan = data["scan"]["states"], data["scan"]
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
            * scan["preload_N"]
            * abs(at[depth, radius][key])
            / (1 + state["stiffness_N_per_mm"] * at[depth, radius]["fe_mean"])
            for state, radius in zip(states, radii, strict=True)
        ]
        reduced = [1e3 * state["patterns"][number]["model_amplitude_kPa"] for state in states]
        found[name] = {"fe": fe, "reduced": reduced}
    return found


def ratios(data: dict[str, Any]) -> dict[str, dict[str, list[float]]]:
    """By pitch and patch: least and greatest amplitude of the reduced model over that of the finite elements."""
    found: dict[str, dict[str, list[float]]] = {}
    radii = [row["radius"] for row in data["single"]]
    for pitch in KINDS:
        for name, radius in (("small", min(radii)), ("large", max(radii))):
            rows = [row for row in data["single"] if (row["pitch"], row["radius"]) == (pitch, radius)]
            over = [row["reduced"] / row["fe"] for row in rows]
            found.setdefault(f"{pitch:g}", {})[name] = [min(over), max(over)]
    return found


def softer(sweeps: dict[str, Any]) -> dict[str, int]:
    """How many depths, pitches and preloads are drawn, and at how many the soft state shows more than the stiff one."""
    pairs = [
        (soft, stiff)
        for name in ("depth", "pitch", "preload")
        for k in (0, 2)
        for soft, stiff in zip(sweeps[name]["y"][k], sweeps[name]["y"][k + 1], strict=True)
        if soft is not None and stiff is not None
    ]
    return {"drawn": len(pairs), "better": sum(soft > stiff for soft, stiff in pairs)}


def reduced(data: dict[str, Any]) -> dict[str, Any]:
    """What the page states."""
    found, sweeps = pascals(data), data["sweeps"]
    gains = [amplitude["fe"][1] / amplitude["fe"][0] for amplitude in found.values()]
    return {
        "pascals": found,
        "gains": [min(gains), max(gains)],
        "ratios": ratios(data),
        "soft": softer(sweeps),
        "rise": [row[-1] / row[0] for row in sweeps["pressure"]["y"]],
        "preload": [row[-1] / row[0] for row in sweeps["preload"]["y"]],
        "plane_change": max(abs(row["coarse"] / row["fe"] - 1) for row in data["plane"]),
    }


def main(*words: str) -> None:
    data = stored("texture") if "stored" in words else measure()
    data["summary"] = reduced(data)
    store("texture", data)


if __name__ == "__main__":
    main(*sys.argv[1:])
