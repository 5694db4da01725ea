"""
How does the driving pressure tune the paper's sensor?
======================================================

The driving pressure is the stiffness setting that can change in use. This example predicts the sensitivity of the
paper's sensor over the driving pressure, with its interval (coverage factor 2), for two resins.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("paper-dome")
pressures = np.array([0, 5, 10, 15, 20])

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for material, style, aside in (("TangoPlus", "k-o", -0.1), ("FLX9950", "k--s", 0.1)):
    states = design.replace(material=material).predict(pressures, model="atlas").states
    value = np.array([state.sensitivity_kPa_per_N for state in states])
    ends = np.array([state.sensitivity.interval for state in states]).T
    axes.errorbar(pressures + aside, value, abs(ends - value), fmt=style, mfc="w", capsize=3, label=material)
    print(f"{material}: {states[0].sensitivity} at 0 kPa, {states[-1].sensitivity} at 20 kPa")
axes.set(xlabel="driving pressure (kPa)", ylabel="sensitivity (kPa/N)", ylim=(0, None))
axes.legend(title="bars: interval (k = 2)", loc="lower left")
