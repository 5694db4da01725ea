"""
How far can a dome be inflated?
===============================

Beyond the limit point the dome grows at falling pressure, so that a regulator cannot hold it. This example draws the
inflation curve of the paper's sensor and prints its limit point and the rated pressure, which is 0.9 of the limit's
lower end.
"""

import matplotlib.pyplot as plt

import pneutouch as pt

design = pt.load("paper-dome")
prediction = design.predict([0], model="atlas")
document = prediction.to_dict()
inflation, limit = document["inflation"], document["limit_point"]
rated_kPa = document["rating"]["rated_pressure_kPa"]

print(f"Limit point: {limit['driving_pressure_kPa']:.1f} kPa, apex {limit['apex_height_outer_mm']:.1f} mm outside")
print(f"Its interval (k = 2): {prediction.at(0).limit_pressure}")
print(f"Rated pressure: {rated_kPa:.1f} kPa")

# %%
# The rated pressure is far below the limit point, because the modulus of the resin is known only within a wide range.

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(inflation["apex_height_outer_mm"], inflation["driving_pressure_kPa"], "k-", label="outer surface")
axes.plot(inflation["apex_height_inner_mm"], inflation["driving_pressure_kPa"], "k--", label="inner surface")
axes.plot(limit["apex_height_outer_mm"], limit["driving_pressure_kPa"], "ko", label="limit point")
axes.axhline(rated_kPa, color="0.5", ls=":", label="rated pressure")
axes.set(xlabel="apex height (mm)", ylabel="pressure (kPa)", ylim=(0, None))
axes.legend(loc="lower right")
