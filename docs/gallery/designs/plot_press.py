"""
What does the gauge read while the sensor is pressed?
=====================================================

The pressure rise follows the contact force nearly in a line. This example draws the curves of the Agilus30 dome at
three driving pressures, with the line that is fitted to each; its slope is the sensitivity.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("agilus-dome")
prediction = design.predict([0, 10, 20], model="atlas")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for state, marker, line in zip(prediction.states, "osD", ("-", "--", ":"), strict=True):
    force_N, rise_kPa = state.contact_force_N, state.pressure_rise_kPa
    slope, start = np.polyfit(force_N, rise_kPa, 1)
    axes.plot(force_N, rise_kPa, marker, color="k", mfc="none", ms=5)
    axes.plot(force_N, start + slope * force_N, line, color="0.4", label=f"{state.driving_pressure_kPa:g} kPa")
    print(
        f"At {state.driving_pressure_kPa:g} kPa the sensitivity is {state.sensitivity}, "
        f"R² = {state.r_squared:.4f}, and the force at {state.range_end_mm:.2f} mm is {force_N[-1]:.1f} N."
    )
axes.set(xlabel="contact force (N)", ylabel="pressure rise (kPa)", xlim=(0, None), ylim=(0, None))
axes.legend(title="driving pressure, fitted line")
