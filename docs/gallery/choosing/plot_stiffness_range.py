"""
Which stiffness can one dome have?
==================================

The resin sets the stiffness when the dome is made, the driving pressure changes it in use. This example shows both
for the shape of the paper's sensor: a bar for each resin, from no pressure to the rated pressure.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("paper-dome")
resins = ["TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985"]

figure, axes = plt.subplots(figsize=(6.5, 4), layout="constrained")
for place, resin in enumerate(resins):
    made = design.replace(material=resin)
    rated_kPa = made.predict([0], model="atlas").to_dict()["rating"]["rated_pressure_kPa"]
    states = made.predict([0, 0.5 * rated_kPa, rated_kPa], model="atlas").states
    stiffness = [state.stiffness_N_per_mm for state in states]
    axes.plot([place, place], [min(stiffness), max(stiffness)], color="0.7", lw=8, solid_capstyle="butt")
    axes.plot(place, stiffness[0], "ko", label="" if place else "no driving pressure")
    axes.plot(place, stiffness[-1], "kD", mfc="w", label="" if place else "rated pressure")
    print(f"{resin}: {stiffness[0]:.2f} N/mm at 0 kPa, {stiffness[-1]:.2f} N/mm at {rated_kPa:.1f} kPa")
axes.set_xticks(range(len(resins)), resins)
axes.set_yscale("log")
axes.set_yticks([4, 6, 8, 10, 15, 20], ["4", "6", "8", "10", "15", "20"])
axes.minorticks_off()
axes.set(xlabel="resin", ylabel="mean stiffness over the range (N/mm)")
axes.legend()
