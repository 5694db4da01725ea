"""
Where is a pad touched, and how well is that known?
===================================================

One pressure gives one number; the pressures of several domes give a place. What a reading leaves open is told by the
information in it: here for a ball of 8 mm radius anywhere over three pads, a fingertip of 7 domes, the jaw of a gripper
with 2 x 4, and a palm of 19, with gauges of 2 Pa of noise. Dark is well known.
"""

import matplotlib.pyplot as plt
import numpy as np

import pneutouch as pt

design = pt.load("small-cell")  # each of their domes
pads = [pt.load_pad(name) for name in ("fingertip-pad", "jaw-pad", "palm-pad")]
figure, axes = plt.subplots(2, 3, figsize=(9, 5.4), layout="constrained", width_ratios=[27, 36, 45])

for pad, (above, below) in zip(pads, axes.T, strict=True):
    touch = pad.touch(driving_pressure_kPa=12)
    reach = np.abs(pad.places_mm).max(axis=0) + design.inner_radius_mm + design.wall_thickness_mm
    x, y = np.meshgrid(*(np.linspace(-side, side, 61) for side in reach))
    ball = touch.ball(x.ravel(), y.ravel(), 8, 1.4)
    found = touch.resolution(x.ravel(), y.ravel(), 8, 1.4, noise_kPa=0.002)
    known = np.where(ball.force_N > 0.02, 1, np.nan)
    force = (100 * known * found.force_N / np.maximum(ball.force_N, 1e-6)).reshape(x.shape)
    place = (known * found.place_mm).reshape(x.shape)
    print(f"{pad.name}: force to {np.nanmedian(force):.0f} %, place to {np.nanmedian(place):.1f} mm (medians)")
    for ax, values, most in ((above, force, 20), (below, place, 4)):
        drawn = ax.pcolormesh(x, y, values, cmap="gray", vmin=0, vmax=most, rasterized=True)
        ax.plot(*pad.places_mm.T, "o", mfc="none", mec="w", ms=9)
        ax.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
    above.set_title(f"{len(pad.places_mm)} domes")
    if pad is pads[-1]:
        figure.colorbar(axes[0, 2].collections[0], ax=axes[0], label="standard deviation of force (%)", extend="max")
        figure.colorbar(axes[1, 2].collections[0], ax=axes[1], label="that of place (mm)", extend="max")
