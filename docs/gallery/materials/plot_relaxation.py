"""
How much does a held reading relax?
===================================

A sensor that is held at one travel loses force and pressure, because the resin relaxes. The loss is known only for
resins with relaxation data, such as Agilus30; there are two sources, and they differ.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("agilus-dome")
viscous = design.predict([0, 20], model="atlas").to_dict()["viscous"]

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
names = []
for state in viscous["states"]:
    for number, source in enumerate(state["by_source"]):
        held = source["relaxation"]
        place, names = len(names), [*names, f"{state['driving_pressure_kPa']:g} kPa,\nsource {chr(ord('A') + number)}"]
        values = [held["force_loss_percent"], held["pressure_rise_loss_percent"]]
        axes.bar(place - 0.2, values[0], 0.36, color="0.3", label="" if place else "contact force")
        axes.bar(
            place + 0.2, values[1], 0.36, color="w", edgecolor="k", hatch="//", label="" if place else "pressure rise"
        )
        print(
            f"{names[-1]}: force -{values[0]:.0f} %, pressure rise -{values[1]:.0f} %, from 1 to 600 s".replace(
                "\n", " "
            )
        )
for letter, source in zip("ABCDEF", viscous["sources"], strict=False):
    print(f"{letter}: {source}")
axes.set_xticks(np.arange(len(names)), names)
axes.set(xlabel="driving pressure and source of the data", ylabel="loss from 1 to 600 s (%)")
axes.legend()
