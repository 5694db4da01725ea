"""
The paper's sensor
==================

The sensitivity of the paper's sensor over the driving pressure, for two resins.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

pressures = [0, 5, 10, 15, 20]
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for material, style in (("TangoPlus", "k-o"), ("FLX9950", "k--s")):
    states = pt.load("paper-dome").replace(material=material).predict(pressures).states
    axes.plot(
        [state.driving_pressure_kPa for state in states],
        [state.sensitivity_kPa_per_N for state in states],
        style,
        label=material,
    )
axes.set(xlabel="driving pressure (kPa)", ylabel="sensitivity (kPa/N)")
axes.legend()
