"""
How can the membrane be held?
=============================

The seat joins the membrane to the connector. This example draws three seats of the same dome to one scale: a flange
that is glued, one that a ring clamps, and membrane and connector printed as one piece.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

jetted = {"connector_material": "VeroClear", "profile": "j735", "connector_profile": "j735"}
seats = {"glued-flange": "glued", "clamped-flange-M2": "clamped", "one-piece": "one piece"}
designs = [
    pt.load("paper-dome").replace(f"dome-{seat}", seat=seat, material="Agilus30", driving_pressures_kPa=[0], **jetted)
    for seat in seats
]

figure, row = plt.subplots(1, 3, figsize=(10, 3), layout="constrained", sharex=True, sharey=True)
for design, axes in zip(designs, row, strict=True):
    design.plot_section(axes)
    axes.set(title=seats[design.seat])
    axes.label_outer()
    names = ", ".join(body.name for body in design.bodies)
    print(f"{seats[design.seat]}: {len(design.bodies)} bodies ({names})")
