"""
Where does the uncertainty of the sensitivity come from?
========================================================

The prediction states the interval of each figure with the shares of its variance. This example draws the shares of
the sensitivity for a fresh design without driving pressure and near its rated pressure.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("fingertip-dome")
states = design.predict([0, 30], model="atlas").to_dict()["states"]

shares = {}
for state in states:
    figure = state["uncertainty"]["figures"]["sensitivity_kPa_per_N"]
    shares[f"{state['driving_pressure_kPa']:g} kPa"] = figure["shares"]
    print(
        f"{state['driving_pressure_kPa']:g} kPa: {figure['value']:.2f} kPa/N, {figure['low']:.2f} to "
        f"{figure['high']:.2f} (k = 2); "
        f"largest share {max(figure['shares'], key=figure['shares'].get)}, {max(figure['shares'].values()):.0%}"
    )

names = sorted({name for part in shares.values() for name in part}, key=lambda name: shares["0 kPa"].get(name, 0))
names = [name for name in names if max(part.get(name, 0) for part in shares.values()) > 0.002]
figure, axes = plt.subplots(figsize=(7, 3.8), layout="constrained")
for (title, part), aside, grey in zip(shares.items(), (0.2, -0.2), ("0.3", "0.8"), strict=True):
    places = [place + aside for place in range(len(names))]
    axes.barh(places, [100 * part.get(name, 0) for name in names], 0.38, color=grey, label=title)
axes.set_yticks(range(len(names)), names)
axes.set(xlabel="share of the variance of the sensitivity (%)", ylabel="source of uncertainty")
axes.legend(title="driving pressure", loc="lower right")
