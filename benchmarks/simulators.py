"""The exported model pressed in MuJoCo beside the prediction: ``python -m benchmarks.simulators``.

Writes docs/background/simulators.json and the chart docs/howto/simulators.svg.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl
import mujoco
import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

from benchmarks.mujoco_press import press
from pneutouch.evaluation import evaluate
from pneutouch.workflows.simulator import make_simulator, write_simulator
from pneutouch.workflows.simulator.run import press_tables

DOCS = Path(__file__).resolve().parents[1] / "docs"
DESIGN = "paper-dome"


def main() -> None:
    """Press, draw and write."""
    evaluation = evaluate(DESIGN, model="atlas")
    tables = press_tables(evaluation, steps=320)
    with tempfile.TemporaryDirectory() as made:
        folder = write_simulator(make_simulator(evaluation, "mujoco"), Path(made))
        figure, rows = _compared(folder, tables)
    mpl.rcParams["svg.hashsalt"] = "pneutouch"
    figure.savefig(DOCS / "howto" / "simulators.svg", metadata={"Date": None})
    found = {"mujoco": mujoco.__version__, "design": DESIGN, "rows": rows}
    (DOCS / "background" / "simulators.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def _compared(folder: Path, tables) -> tuple[Figure, list[dict[str, Any]]]:
    """The chart, and the greatest differences in percent by driving pressure."""
    figure = Figure(figsize=(9, 5.5), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True, height_ratios=(2, 1))
    rows = []
    for k, table in enumerate(tables):
        depth = 1e3 * table.indentation
        travels = np.linspace(0.02, 1.0, 21) * depth[-1]
        pressed = press(folder, table.driving_pressure_kPa, travels)
        columns = (
            (table.force, pressed.force_N),
            (table.pressure_kPa - table.driving_pressure_kPa, pressed.pressure_kPa - table.driving_pressure_kPa),
        )
        grey, mark, worst = f"{0.2 * k:.1f}", "osD^"[k % 4], []
        for (top, bottom), (curve, points) in zip(axes.T, columns, strict=True):
            top.plot(depth, curve, color=grey, lw=1)
            label = f"{table.driving_pressure_kPa:g} kPa"
            top.plot(travels, points, mark, color=grey, mfc="none", ms=4, label=label)
            off = 100 * (points / PchipInterpolator(depth, curve)(travels) - 1)
            bottom.plot(travels, off, mark, ls="-", color=grey, mfc="none", ms=3, lw=0.7)
            worst.append(float(np.abs(off).max()))
        rows.append({"driving_pressure_kPa": table.driving_pressure_kPa, "force": worst[0], "rise": worst[1]})
    for (top, bottom), name in zip(axes.T, ("force on the plate, N", "pressure rise, kPa"), strict=True):
        top.set_ylabel(name)
        bottom.set(xlabel="plate travel, mm", ylabel="MuJoCo off by, %", ylim=(-1.1, 1.1))
        bottom.axhline(0, color="0.7", lw=0.5)
    axes[0, 0].legend(title="MuJoCo; lines: prediction", frameon=False)
    return figure, rows


if __name__ == "__main__":
    main()
