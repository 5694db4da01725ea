"""
What does friction change?
==========================

The wall slides on the plate while it is pressed. This example solves the paper's dome in FLX9960 without friction,
with a coefficient of 0.6 and with a plate that grips, and shows by how much the curves differ.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("paper-dome").replace(material="FLX9960", driving_pressures_kPa=[0], depth_mm=5.5, checked_waves=0)
surfaces = {"no friction": 0.0, "coefficient 0.6": 0.6, "grip": float("inf")}

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
first = None
for (title, friction), style in zip(surfaces.items(), ("k-", "k--", "k:"), strict=True):
    state = design.replace(friction=friction).predict().at(0)
    first = first or state.sensitivity_kPa_per_N
    axes.plot(state.contact_force_N, state.pressure_rise_kPa, style, label=title)
    change = state.sensitivity_kPa_per_N / first - 1
    print(f"{title}: {state.sensitivity_kPa_per_N:.3f} kPa/N ({change:+.1%}), {state.stiffness_N_per_mm:.2f} N/mm")
axes.set(xlabel="contact force (N)", ylabel="pressure rise (kPa)", xlim=(0, None), ylim=(0, None))
axes.legend()
