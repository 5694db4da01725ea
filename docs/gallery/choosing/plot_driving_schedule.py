"""
Which driving pressure does each task need?
===========================================

One sensor is used for three tasks: feeling lightly, holding, and reading firm presses. ``driving_schedule`` solves
for the driving pressure of each, and states the gas to inject and how much the sealed pressure follows the
temperature.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("stiff-dome").replace(material="FLX9960")
tasks = [
    {"name": "feel", "stiffness_N_per_mm": 8.0},
    {"name": "hold", "stiffness_N_per_mm": 6.5},
    {"name": "yield", "stiffness_N_per_mm": 5.0},
]
schedule = design.driving_schedule(tasks, model="atlas")
for entry, pressure_kPa in zip(schedule.to_dict()["tasks"], schedule.driving_pressures_kPa, strict=True):
    gas = entry["gas"]
    print(
        f"{entry['task']}: {entry['value']:g} N/mm needs {pressure_kPa:.1f} kPa. Inject {gas['injected_mL']:.2f} mL; "
        f"the sealed pressure changes by {gas['by_temperature_kPa_per_K']:.2f} kPa/K."
    )

pressures = np.linspace(0, 1.1 * max(schedule.driving_pressures_kPa), 12)
stiffness = [state.stiffness_N_per_mm for state in design.predict(pressures, model="atlas").states]

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(pressures, stiffness, "-", color="0.6")
for task, pressure_kPa, marker in zip(tasks, schedule.driving_pressures_kPa, "osD", strict=True):
    axes.plot(pressure_kPa, task["stiffness_N_per_mm"], marker, color="k", ms=8, label=task["name"])
rated_kPa = schedule.to_dict()["rated_pressure_kPa"]
axes.axvline(rated_kPa, color="0.4", ls=":", label=f"rated pressure, {rated_kPa:.0f} kPa")
axes.set(xlabel="driving pressure (kPa)", ylabel="mean stiffness over the range (N/mm)", xlim=(0, None))
axes.legend()
