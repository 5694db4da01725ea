"""
How does a program read newtons from the gauge?
===============================================

``export_reader`` writes the pressure-to-force model as C, Python and JSON. This example writes it into a temporary
folder, imports the Python module, tares it at two driving pressures and reads forces.
"""

import importlib.util
import json
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("paper-dome")
with tempfile.TemporaryDirectory() as folder:
    written = design.export_reader(folder)
    spec = importlib.util.spec_from_file_location("reader", written / "paper_dome_reader.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    table = json.loads((written / "reader.json").read_text(encoding="utf-8"))

reader = module.ForceReader(table)
noise_kPa = np.random.default_rng(0).normal(0, 0.002, 200)
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for driving_kPa, grey in ((0.0, "0.3"), (12.0, "0.65")):
    reader.tare([float(value) for value in driving_kPa + noise_kPa])
    rises = np.linspace(1, 30, 30)
    readings = [reader.read(float(driving_kPa + rise)) for rise in rises]
    force, twice = (
        np.array(values) for values in zip(*((r.force_N, 2 * r.uncertainty_N) for r in readings), strict=True)
    )
    axes.fill_between(rises, force - twice, force + twice, color=grey, alpha=0.4, lw=0)
    axes.plot(rises, force, color=grey, ls="-" if driving_kPa == 0 else "--", label=f"{driving_kPa:g} kPa")
    print(f"Tared at {driving_kPa:g} kPa, a rise of {rises[9]:.0f} kPa is {force[9]:.2f} N ± {twice[9]:.2f} N (k = 2).")
axes.set(xlabel="pressure rise (kPa)", ylabel="contact force (N)", xlim=(0, None), ylim=(0, None))
axes.legend(title="driving pressure; bands: k = 2")
