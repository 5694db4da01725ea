"""
Does the sensor read a ball as it reads a plate?
================================================

A sensor is mostly calibrated with a flat plate. This example presses one dome with a plate, a ball, a cone and a
ring, and shows the pressure rise over the same travel and over the force. Only the force of the plate can be read
from it.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("paper-dome").replace(driving_pressures_kPa=[0], depth_mm=4, checked_waves=0)
objects = {
    "plate": {},
    "ball of 5 mm radius": {"object": "ball", "ball_radius_mm": 5},
    "cone of 60°": {"object": "cone", "cone_half_angle_deg": 60, "cone_tip_radius_mm": 1},
    "ring of 4 mm radius": {"object": "ring", "ring_radius_mm": 4, "ring_section_radius_mm": 1},
}

plate = None
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for (title, contact), style in zip(objects.items(), ("k-", "k--", "k-.", "k:"), strict=True):
    state = design.replace(**contact).predict().at(0)
    plate = plate or state
    axes.plot(state.contact_force_N, state.pressure_rise_kPa, style, label=title)
    true_N = np.interp(4, state.pressure_rise_kPa, state.contact_force_N)
    read_N = np.interp(4, plate.pressure_rise_kPa, plate.contact_force_N)
    print(f"A rise of 4 kPa by a {title} is {true_N:.2f} N; by the plate's curve it reads {read_N / true_N - 1:+.0%}.")
axes.set(xlabel="contact force (N)", ylabel="pressure rise (kPa)", xlim=(0, None), ylim=(0, None))
axes.legend()
