"""Dithers of an even fraction compared on a block: evenness in 1 mm cubes, spectrum, time."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.export.voxels.bluenoise import thresholds

PITCH = (25.4 / 600, 25.4 / 300, 0.027)
SHAPE = (96, 64, 128)
"""Layers, rows, columns: whole blocks of the blue noise, 2.6 x 5.4 x 5.4 mm."""

FRACTIONS = (0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98)
_WARM = 96
"""Layers before the block in which error diffusion gets under way; without them it starts late at fractions near 0 and 1."""

COARSE = 0.4
"""Wavelength in mm from which a spectrum counts as clumps: about a quarter of a wall of 1.5 mm."""

Flags = np.ndarray


@dataclass(frozen=True)
class Row:
    """One dither of one fraction. ``cube`` is the worst error of fraction in a 1 mm cube; ``clumps`` the power at long
    wavelengths and ``peak`` the greatest of a single wave among them, over that of white noise; ``seconds`` a million voxels."""

    method: str
    fraction: float
    whole: float
    cube: float
    clumps: float
    peak: float
    seconds: float


def blue_noise(fraction: float) -> Flags:
    """Thresholds of void and cluster: what a stack is made with."""
    noise = thresholds(PITCH, 1)
    rows, columns = slice(0, SHAPE[1]), slice(0, SHAPE[2])
    return np.array([fraction > noise.layer(number, rows, columns) for number in range(SHAPE[0])])


def white_noise(fraction: float) -> Flags:
    """Every voxel for itself."""
    return np.random.default_rng(1).random(SHAPE) < fraction


def error_diffusion(fraction: float, noise: float = 0.5) -> Flags:
    """Half of a voxel's error to the next row (1, 2, 1), half to the next layer (1, 2, 1 along x); rows turn from layer to
    layer. Threshold shaken by ``noise``, or rows of one phase would form walls."""
    rng = np.random.default_rng(1)
    layers, rows, columns = SHAPE
    layers += _WARM
    out = np.zeros((layers, rows, columns), bool)
    carried = rng.uniform(-0.5, 0.5, (rows, columns))
    for z in range(layers):
        below, carried = carried, np.zeros((rows, columns))
        shaken = 0.5 + noise * (rng.random((rows, columns)) - 0.5)
        beside = np.zeros(columns)
        for y in range(rows) if z % 2 == 0 else range(rows - 1, -1, -1):
            wanted = fraction + below[y] + beside
            out[z, y] = wanted > shaken[y]
            half = 0.5 * (wanted - out[z, y])
            # Along x the block closes on itself: no error is lost there.
            beside = 0.5 * half + 0.25 * (np.roll(half, 1) + np.roll(half, -1))
            carried[y] += beside
        # What the last row would pass on goes up too: no error leaves the block.
        carried[y] += beside
    return out[_WARM:]


METHODS: dict[str, Callable[[float], Flags]] = {
    "blue noise": blue_noise,
    "error diffusion": error_diffusion,
    "white noise": white_noise,
}


def spectrum(block: Flags) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (1/mm) and powers over that of white noise, of every wave of a block but the mean."""
    fraction = block.mean()
    power = np.abs(np.fft.rfftn(block - fraction)) ** 2 / (block.size * fraction * (1 - fraction))
    axes = [np.fft.fftfreq(n, d) for n, d in zip(SHAPE[:2], (PITCH[2], PITCH[1]), strict=True)]
    z, y, x = np.meshgrid(*axes, np.fft.rfftfreq(SHAPE[2], PITCH[0]), indexing="ij")
    return np.sqrt(x**2 + y**2 + z**2).ravel()[1:], power.ravel()[1:]


def radial(block: Flags, edges: np.ndarray) -> np.ndarray:
    """Mean power in rings of frequency between ``edges`` (1/mm)."""
    frequency, power = spectrum(block)
    place = np.digitize(frequency, edges) - 1
    kept = (place >= 0) & (place < len(edges) - 1)
    total = np.bincount(place[kept], power[kept], len(edges) - 1)
    return total / np.maximum(np.bincount(place[kept], minlength=len(edges) - 1), 1)


def worst_cube(block: Flags, fraction: float) -> float:
    """The greatest error of fraction over all cubes of 1 mm that lie in the block, wherever they begin."""
    size = [round(1 / step) for step in reversed(PITCH)]
    total = np.pad(block.cumsum(0).cumsum(1).cumsum(2), ((1, 0),) * 3)
    for axis, n in enumerate(size):
        total = np.take(total, range(n, total.shape[axis]), axis) - np.take(total, range(total.shape[axis] - n), axis)
    return float(np.abs(total / np.prod(size) - fraction).max())


def compare() -> list[Row]:
    """Every method at every fraction."""
    blue_noise(0.5)
    rows = []
    for method, make in METHODS.items():
        for fraction in FRACTIONS:
            start = time.process_time()
            block = make(fraction)
            made = block.size * (1 + _WARM / SHAPE[0] * (method == "error diffusion"))
            seconds = (time.process_time() - start) / made * 1e6
            frequency, power = spectrum(block)
            long = power[frequency < 1 / COARSE]
            rows.append(
                Row(
                    method,
                    fraction,
                    float(abs(block.mean() - fraction)),
                    worst_cube(block, fraction),
                    float(long.mean()),
                    float(long.max()),
                    seconds,
                )
            )
    return rows
