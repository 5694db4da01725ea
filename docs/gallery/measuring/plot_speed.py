"""
How fast does a sensor read?
============================

Between dome and gauge lie a channel and a tube, whose air has inertia and resistance. This example predicts bandwidth
and delay of the Agilus30 dome for several tubes.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("agilus-dome")
lengths = [50, 100, 200, 300, 500, 1000]

bandwidth, resonance = [], []
for length in lengths:
    state = design.replace(tube_length_mm=length).predict([0], model="atlas").to_dict()["dynamics"]["states"][0]
    bandwidth.append(state["bandwidth_3_dB_Hz"])
    resonance.append(state["first_resonance_Hz"])
    print(f"{length} mm: within 3 dB up to {bandwidth[-1]:.0f} Hz, delay {state['delay_ms']:.2f} ms")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.loglog(lengths, resonance, "k--s", mfc="w", label="first resonance")
axes.loglog(lengths, bandwidth, "k-o", label="within 3 dB")
axes.minorticks_off()
axes.set_xticks(lengths, [f"{length:g}" for length in lengths])
axes.set_yticks([50, 100, 200, 500, 1000], ["50", "100", "200", "500", "1000"])
axes.set(xlabel="tube length (mm)", ylabel="frequency (Hz)")
axes.legend()
