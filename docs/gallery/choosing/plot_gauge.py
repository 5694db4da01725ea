"""
Which gauge detects the smallest force?
=======================================

The smallest force is three standard deviations of the difference of two readings, from the noise and the step that
the gauge's data sheet states. This example sets the shipped gauges side by side behind one dome. Where a data sheet
does not state the noise, the smallest force is not known, and the gauge is left out.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("fingertip-dome")
gauges = [
    "bosch-bmp390", "honeywell-abp2-5psi", "honeywell-mpr-25psi", "nxp-mpx5100gp",
    "smc-pse543", "st-lps33hw", "te-ms5837-02ba", "te-ms5837-30ba",
]  # fmt: skip
thresholds = []
for gauge in gauges:
    about = design.replace(gauge=gauge).predict([0, 10], model="atlas").to_dict()["gauge"]
    smallest = [state["smallest_force_N"] for state in about["states"]]
    if None in smallest:
        print(f"{about['title']}: {about['limited_by']}.")
        continue
    thresholds.append((about["title"], 1e3 * smallest[0], 1e3 * smallest[1]))
    print(f"{about['title']}: {thresholds[-1][1]:.2f} mN at 0 kPa, {thresholds[-1][2]:.2f} mN at 10 kPa")

thresholds.sort(key=lambda row: row[1])
figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
for place, (_, relaxed, driven) in enumerate(thresholds):
    axes.plot([relaxed, driven], [place, place], "-", color="0.7")
    axes.plot(relaxed, place, "ko", label="" if place else "0 kPa")
    axes.plot(driven, place, "ks", mfc="w", label="" if place else "10 kPa")
axes.set_yticks(range(len(thresholds)), [row[0] for row in thresholds])
axes.invert_yaxis()
axes.set_xscale("log")
axes.set(xlabel="smallest force (mN)", ylabel="gauge")
axes.legend(title="driving pressure")
