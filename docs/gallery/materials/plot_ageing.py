"""
What is a sensor after a year?
==============================

Printed resins change with age. With ``aged=True`` the prediction is that of a print one year old. This example shows by
how much force and pressure rise then differ from those of the fresh print at the same travel.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("paper-dome").replace(driving_pressures_kPa=[0, 20])
fresh, aged = (design.predict(model="atlas", aged=old) for old in (False, True))

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for young, old, fill in zip(fresh.states, aged.states, ("k", "w"), strict=True):
    title = f"{young.driving_pressure_kPa:g} kPa"
    for key, name, style in (("contact_force_N", "force", "k-o"), ("pressure_rise_kPa", "pressure rise", "k--s")):
        change = 100 * (old.curve[key][1:] / young.curve[key][1:] - 1)
        axes.plot(young.indentation_mm[1:], change, style, mfc=fill, ms=5, label=f"{name}, {title}")
    sensitivity = old.sensitivity_kPa_per_N / young.sensitivity_kPa_per_N - 1
    stiffness = old.stiffness_N_per_mm / young.stiffness_N_per_mm - 1
    print(f"At {title}: sensitivity {sensitivity:+.1%}, stiffness {stiffness:+.1%}.")
print(f"The modulus is taken as {aged.to_dict()['aged']['modulus_ratio']:.2f} times that of the fresh print.")
axes.set(xlabel="indentation (mm)", ylabel="change after a year (%)", xlim=(0, None))
axes.legend(fontsize="small")
