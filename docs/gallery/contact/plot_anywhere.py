"""
How wrong is the force where object and place of contact are unknown?
=====================================================================

A reading is turned into newtons by the curve of a central plate. With ``contact_anywhere`` the prediction states the
error of that force for balls, edges and plates elsewhere, from a table of presses that is shipped with the program.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("paper-dome")
prediction = design.predict([0, 20], model="atlas", contact_anywhere=True)
document = prediction.to_dict()["contact_anywhere"]
for state in document["states"]:
    share = state["standard_uncertainty_relative"]
    print(f"At {state['driving_pressure_kPa']:g} kPa the unknown contact adds a standard uncertainty of {share:.0%}.")


def described(contact):
    """A contact in words."""
    place = f", {contact['offset_mm']:.1f} mm off" if contact["offset_mm"] else ", central"
    if contact["object"] == "plate":
        return f"plate at {contact['tilt_deg']:g}°"
    return f"{contact['object']} of {contact['radius_mm']:.1f} mm{place}"


# %%
# The error at the smaller of the two readings of each driving pressure.

errors = np.array([[row[0] for row in state["force_error_percent"]] for state in document["states"]], float)
order = np.argsort(errors[0])
figure, axes = plt.subplots(figsize=(7, 4.6), layout="constrained")
for state, values, style, fill in zip(document["states"], errors, ("ko", "ks"), ("k", "w"), strict=True):
    label = f"{state['driving_pressure_kPa']:g} kPa"
    axes.plot(values[order], np.arange(len(order)), style, mfc=fill, label=label)
axes.set_yticks(range(len(order)), [described(document["contacts"][k]) for k in order])
axes.axvline(0, color="0.5", lw=0.8)
axes.grid(axis="y", color="0.9")
axes.set(xlabel="error of the force read by the plate's curve (%)", ylabel="what presses the dome")
axes.legend(title="driving pressure", loc="lower right")
