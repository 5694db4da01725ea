"""
What does a sensor for a robot fingertip read?
==============================================

A small dome that is screwed on from behind. The left part shows it in section, the right one the pressure rise over
the contact force at three driving pressures.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("fingertip-dome")
prediction = design.predict([0, 15, 30], model="atlas")

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained", width_ratios=(1, 1.1))
design.plot_section(left)
for state, line in zip(prediction.states, ("-", "--", ":"), strict=True):
    right.plot(
        state.contact_force_N, state.pressure_rise_kPa, color="k", ls=line, label=f"{state.driving_pressure_kPa:g} kPa"
    )
    print(f"{state.driving_pressure_kPa:g} kPa: {state.sensitivity}, up to {state.force_at_range_end}")
right.set(xlabel="contact force (N)", ylabel="pressure rise (kPa)", xlim=(0, None), ylim=(0, None))
right.legend(title="driving pressure")

size_mm = max(body.bounds[1][0] - body.bounds[0][0] for body in design.bodies)
print(f"The dome has a radius of {design.inner_radius_mm:g} mm and a wall of {design.wall_thickness_mm:g} mm.")
print(f"The sensor is {size_mm:.1f} mm wide and has {prediction.to_dict()['dead_volume_mL']:.2f} mL of dead volume.")
