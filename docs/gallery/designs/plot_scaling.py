"""
How does the sensitivity change with the size of the dome?
==========================================================

The pressure rise is a force over an area, so that the sensitivity falls with the square of the radius. This example
keeps the ratio of wall to radius and doubles the size twice.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

radii = np.array([4, 5, 6, 8, 10, 12, 16])
design = pt.load("paper-dome")


def sensitivity_of(radius_mm):
    """Sensitivity in kPa/N of the paper's dome, scaled to a radius, without driving pressure."""
    scale = radius_mm / design.inner_radius_mm
    size = {"inner_radius_mm": radius_mm, "wall_thickness_mm": scale * design.wall_thickness_mm}
    scaled = design.replace(**size, plate_diameter_mm=4 * radius_mm)
    return scaled.predict([0], model="atlas").at(0).sensitivity_kPa_per_N


sensitivity = np.array([sensitivity_of(float(radius)) for radius in radii])
exponent = np.polyfit(np.log(radii), np.log(sensitivity), 1)[0]
print(f"The sensitivity falls from {sensitivity[0]:.2f} to {sensitivity[-1]:.2f} kPa/N.")
print(f"It goes with the radius to the power of {exponent:.3f}.")

# %%
# With no dead volume, the same resin and the same ambient pressure the exponent is that of an area.

figure, axes = plt.subplots(figsize=(5, 4), layout="constrained")
axes.loglog(radii, sensitivity[0] * (radii[0] / radii) ** 2, "-", color="0.6", label="power of -2")
axes.loglog(radii, sensitivity, "ko", label="predicted")
axes.set_xticks(radii, [f"{radius:g}" for radius in radii])
axes.minorticks_off()
ticks = [0.5, 1, 2, 5, 10]
axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
axes.set(xlabel="inner radius (mm)", ylabel="sensitivity (kPa/N)")
axes.legend()
