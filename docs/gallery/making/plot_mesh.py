"""
How fine is the print mesh?
===========================

Print files hold flat triangles in place of the round wall. This example takes the mesh of the membrane and measures
how far the middles of its triangles lie from the spheres of the design, which must be less than a printer can place.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("paper-dome")
membrane = next(body for body in design.bodies if body.name == "membrane")
middles = membrane.vertices[membrane.triangles].mean(axis=1)
radius = np.linalg.norm(middles, axis=1)
print(f"The membrane has {len(membrane.triangles)} triangles and a volume of {membrane.volume:.1f} mm³.")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
inner_mm, outer_mm = design.inner_radius_mm, design.inner_radius_mm + design.wall_thickness_mm
for sphere_mm, title, grey in ((inner_mm, "inner surface", "0.3"), (outer_mm, "outer surface", "0.75")):
    near = (abs(radius - sphere_mm) < 0.1) & (middles[:, 2] > 1)
    off_um = 1e3 * (radius[near] - sphere_mm)
    axes.hist(off_um, bins=30, color=grey, label=title, alpha=0.8)
    print(f"{title}: {near.sum()} triangles, at most {abs(off_um).max():.1f} µm from the sphere")
axes.set(xlabel="middle of a triangle above the sphere (µm)", ylabel="triangles")
axes.legend()
