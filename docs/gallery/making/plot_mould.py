"""
What mould casts a dome?
========================

A design of a cast silicone comes with its mould: cap, ring, core and base, to be printed. This example draws the
closed mould as it is poured; ``build`` writes its print files.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("cast-dome")
figure, axes = plt.subplots(figsize=(9, 3.4), layout="constrained")
design.plot_mould(axes)
axes.set(ylabel="height as poured (mm)")

membrane = next(body for body in design.bodies if body.name == "membrane")
print(f"The membrane of {design.material} has a volume of {membrane.volume / 1e3:.2f} mL.")
print(f"Its wall is {design.wall_thickness_mm:g} mm thick over a core of {design.inner_radius_mm:g} mm radius.")
