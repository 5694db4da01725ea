"""
How do wall and radius trade sensitivity for force?
===================================================

``pt.sweep`` predicts a grid of designs into an xarray dataset. The map shows the sensitivity over radius and wall as
grey levels and the force at the end of the range as lines: a sensitive dome does not carry much force.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("paper-dome").replace(driving_pressures_kPa=[0], plate_diameter_mm=60)
radii, walls = np.linspace(7, 13, 7), np.linspace(0.9, 2.4, 5)
data = pt.sweep(design, model="atlas", inner_radius_mm=radii, wall_thickness_mm=walls)
data = data.sel(driving_pressure_kPa=0).transpose("membrane_wall_thickness_mm", "membrane_inner_radius_mm")
sensitivity, force = data["sensitivity_kPa_per_N"], data["force_range_high_N"]

place = {"membrane_inner_radius_mm": 10, "membrane_wall_thickness_mm": 1.6}
there = data.sel(place, method="nearest")
print(f"{data['status'].size} designs were predicted.")
print(
    f"A radius of 10 mm with a wall of 1.6 mm has {float(there['sensitivity_kPa_per_N']):.2f} kPa/N "
    f"and reads up to {float(there['force_range_high_N']):.0f} N."
)

figure, axes = plt.subplots(figsize=(6, 4.2), layout="constrained")
shades = axes.contourf(radii, walls, sensitivity, levels=np.arange(0.5, 5.5, 0.5), cmap="Greys", vmax=7)
lines = axes.contour(radii, walls, force, levels=[10, 15, 20, 30, 40, 60, 80], colors="k", linewidths=1)
axes.clabel(lines, fmt="%g N", fontsize="small")
figure.colorbar(shades, label="sensitivity at 0 kPa (kPa/N)")
axes.set(xlabel="inner radius (mm)", ylabel="wall thickness (mm)")
