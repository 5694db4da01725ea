"""
Which dome meets a target sensitivity?
======================================

``pt.select`` returns designs for a target: here 1.9 kPa/N at 12 kPa with a force range of at least 15 N, in a dome of
at most 25 mm. The picture shows the best candidate of each resin: its force range and the uncertainty of its
sensitivity.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

selection = pt.select(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12, force_range_N=15, max_diameter_mm=25)
design = selection.designs[0]
print(f"{len(selection.designs)} designs meet the target. The first is of {design.material}:")
print(f"inner radius {design.inner_radius_mm:g} mm, wall {design.wall_thickness_mm:g} mm.")

best = {}
for candidate in selection.to_dict()["designs"]:
    best.setdefault(candidate["material"], candidate)

# %%
# A point further to the right withstands more force; one further down has a smaller uncertainty.

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for (resin, candidate), marker in zip(best.items(), "osD^vP", strict=False):
    size = f"R {candidate['inner_radius_mm']:g}, wall {candidate['wall_thickness_mm']:g} mm"
    uncertainty = 100 * candidate["expanded_uncertainty_relative"]
    axes.plot(candidate["force_range_N"][1], uncertainty, marker, color="k", mfc="0.8", ms=9, label=f"{resin}: {size}")
    print(f"{resin}: {size}, force range {candidate['force_range_N'][1]:.1f} N, uncertainty {uncertainty:.0f} %")
axes.axvline(15, color="0.5", ls=":", label="required force range")
axes.set(xlabel="force range (N)", ylabel="expanded uncertainty of the sensitivity (%)")
axes.legend(fontsize="small")
