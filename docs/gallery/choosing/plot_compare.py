"""
Is one design really better than another?
=========================================

Two predictions differ only where their difference exceeds its uncertainty. ``pt.compare`` sets designs side by side
and decides that for each figure; what both sensors share, such as the error of the model, counts less in the
difference.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

designs = [
    pt.load("paper-dome").replace("wall-1.5mm"),
    pt.load("paper-dome").replace("wall-1.2mm", wall_thickness_mm=1.2),
    pt.load("paper-dome").replace("FLX9960", material="FLX9960"),
]
frame = pt.compare(*designs, driving_pressures_kPa=[0], model="atlas").to_frame()
rows = {
    "sensitivity_kPa_per_N": "sensitivity",
    "stiffness_N_per_mm": "stiffness",
    "force_at_range_end_N": "force range",
}

figure, axes = plt.subplots(figsize=(6.5, 4), layout="constrained")
for design, style, aside in zip(designs[1:], ("ks", "ko"), (-0.1, 0.1), strict=True):
    for place, (key, title) in enumerate(rows.items()):
        row = frame.loc[(0.0, key), design.name]
        value, low, high = row["percent"], row["low_percent"], row["high_percent"]
        axes.errorbar(
            place + aside,
            value,
            [[value - low], [high - value]],
            fmt=style,
            mfc="k" if row["exceeds"] else "w",
            ms=8,
            capsize=4,
            label="" if place else design.name,
        )
        verdict = "exceeds its uncertainty" if row["exceeds"] else "is within its uncertainty"
        print(f"{design.name}, {title}: {value:+.0f} % ({low:+.0f} to {high:+.0f} %) {verdict}.")
axes.axhline(0, color="0.5", lw=0.8)
axes.set_xticks(np.arange(len(rows)), rows.values())
axes.set(xlabel="figure at 0 kPa", ylabel=f"difference from {designs[0].name} (%)", xlim=(-0.5, 2.5))
axes.legend(title="filled: exceeds its uncertainty", loc="upper left")
