"""
How much sensitivity does a longer tube cost?
=============================================

The gas in connector, tube and gauge is compressed together with that of the cavity, so that a longer tube lowers the
pressure rise. This example predicts the default dome behind tubes of different length.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("long-tube")
lengths = [0, 100, 200, 300, 500, 700, 1000, 1500, 2000]

volumes, low, high = [], [], []
for length in lengths:
    prediction = design.replace(tube_length_mm=length).predict([0, 12], model="atlas")
    volumes.append(prediction.to_dict()["dead_volume_mL"])
    low.append(prediction.at(0).sensitivity_kPa_per_N)
    high.append(prediction.at(12).sensitivity_kPa_per_N)
print(f"Without a tube the dead volume is {volumes[0]:.2f} mL, behind {lengths[-1]} mm it is {volumes[-1]:.1f} mL.")
print(f"The sensitivity at 0 kPa falls from {low[0]:.2f} to {low[-1]:.2f} kPa/N, at 12 kPa to {high[-1]:.2f} kPa/N.")

# %%
# The axis above states the dead volume that belongs to each tube.

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(lengths, low, "k-o", label="0 kPa")
axes.plot(lengths, high, "k--s", mfc="w", label="12 kPa")
axes.set(xlabel="tube length (mm)", ylabel="sensitivity (kPa/N)", xlim=(0, None), ylim=(0, None))
mm_per_mL = lengths[-1] / (volumes[-1] - volumes[0])
top = axes.secondary_xaxis(
    "top", (lambda mm: volumes[0] + mm / mm_per_mL, lambda each: mm_per_mL * (each - volumes[0]))
)
top.set_xlabel("dead volume (mL)")
axes.legend(title="driving pressure")
