"""
Can a graded wall keep its sensitivity under pressure?
======================================================

Inflation softens a dome and widens its contact, which costs sensitivity. A wall that is soft at the pole and stiff at
the rim loses less. The section on the left shows the share of the stiff resin, the right part the sensitivity.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("graded-dome").replace(checked_waves=0)
pressures = [0, 22]

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.8), layout="constrained", width_ratios=(1.2, 1))
design.plot_section(left)
for material, style in ((design.material, "k-o"), ("TangoPlus", "k--s")):
    states = design.replace(material=material).predict(pressures).states
    values = [state.sensitivity_kPa_per_N for state in states]
    title = material if isinstance(material, str) else "graded"
    right.plot(pressures, values, style, mfc="w", label=title)
    print(f"{title}: {values[0]:.2f} kPa/N at 0 kPa, {values[1]:.2f} at 22 kPa ({values[1] / values[0] - 1:+.0%})")
right.set(xlabel="driving pressure (kPa)", ylabel="sensitivity (kPa/N)", ylim=(0, None))
right.legend(loc="lower left")
