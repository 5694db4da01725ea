"""Driving pressure at which a sensor shows a pattern, and domes that separate two patterns; by the atlas."""

import math
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.sensor import Sensor
from pneutouch.texture.scalogram import MORSE
from pneutouch.texture.sliding import NOISE, RATE, touches
from pneutouch.texture.substrate import BarRow, MatrixLayer, amplitude
from pneutouch.units import KPA

BLUR = (0.85, 1.0, 1.15)
"""Factors on the predicted contact radius; an amplitude is the root mean square over them. A real patch has no sharp
edge, so its filter has no zeros; a dome must not be selected because it has a zero there."""

LEAST_RATIO = 3.0
"""Least ratio of a pattern's amplitude to noise in the state (driving pressure) that is to show it."""

LEAST_TRAVEL = 0.025
"""Indentation over R0 above which the atlas's contact radius is smooth; below, it jumps from element to element."""

POINTS = 23
"""Number of driving pressures examined."""


class BarPattern(NamedTuple):
    """Row of bars as wide as the gaps between them, by pitch and depth in mm."""

    pitch: float
    depth: float

    @property
    def bars(self) -> BarRow:
        """The pattern as a row of bars."""
        half = 0.5 * self.pitch
        return BarRow(f"{self.pitch:g}@{self.depth:g}", self.pitch, half, 1.0, self.depth, np.array([[0.0, half]]))


class PressureAdvice(NamedTuple):
    """Best driving pressure, amplitudes at it and at zero pressure, and all pressures tried with amplitudes (n,);
    MPa."""

    driving_pressure: float
    amplitude: float
    unpressurised: float
    pressures: Array
    amplitudes: Array


class Separation(NamedTuple):
    """Domes, best first, (n,): number, driving pressures of two states (MPa), amplitudes (n, 2 states, 2 patterns).

    The first state favours the first pattern, the second the other; ``contrast`` is the ratio of A1/A2 between the
    states."""

    dome: Array
    pressures: Array
    amplitudes: Array
    contrast: Array


def noise_amplitude(frequency: float, noise: float = NOISE, rate: float = RATE) -> float:
    """Mean |W| of white noise (MPa rms a sample) at a voice (Hz), MPa; its two parts are Gaussian."""
    ratio = np.linspace(0.02, 2.0, 400)
    power = float(np.sum(MORSE.response(ratio) ** 2)) * float(ratio[1] - ratio[0])
    return noise * math.sqrt(power * frequency / rate) * math.sqrt(math.pi) / 2.0


def amplitudes(batch: SensorBatch, preload: float, matrix: MatrixLayer, patterns: list[BarPattern]) -> Array:
    """Pressure amplitudes at a held height, MPa, (n, patterns), averaged over `BLUR`.

    NaN if a dome does not reach the preload, or reaches it within `LEAST_TRAVEL`.
    """
    contact = touches(batch, preload)
    radius = np.where(contact.indentation >= LEAST_TRAVEL * batch.inner_radius, contact.contact_radius, np.nan)
    gain = contact.pressure_slope * preload / (1.0 + contact.stiffness * matrix.compliance(radius))
    radii = radius[:, None] * np.array(BLUR)
    return np.stack(
        [gain * np.sqrt((amplitude(matrix, pattern.bars, radii) ** 2).mean(axis=1)) for pattern in patterns], axis=1
    )


def recommend(
    pattern: BarPattern, sensor: Sensor, matrix: MatrixLayer, highest: float, preload: float = 0.5
) -> PressureAdvice:
    """Driving pressure up to ``highest`` (MPa) at which a sensor shows a pattern with the greatest amplitude.

    The sensor must lie in the atlas. Raises InputError if it never reaches the preload (N), or for an impossible
    pattern."""
    check(pattern, matrix)
    pressures = np.linspace(0.0, highest, POINTS)
    levels = amplitudes(batch_of(sensor, pressures), preload, matrix, [pattern])[:, 0]
    if not np.isfinite(levels).any():
        raise InputError(
            f"preload = {preload:g} N: the sensor reaches it at no driving pressure up to {highest / KPA:g} kPa"
        )
    best = int(np.nanargmax(levels))
    return PressureAdvice(float(pressures[best]), float(levels[best]), float(levels[0]), pressures, levels)


def separate(
    batch: SensorBatch,
    dome: Array,
    preload: float,
    matrix: MatrixLayer,
    patterns: tuple[BarPattern, BarPattern],
    floor: tuple[float, float],
) -> Separation:
    """Rank domes by how differently they show two patterns at two driving pressures.

    Rows of ``batch`` with the same number in ``dome`` (n,) are one dome at several pressures; ``floor`` is the noise at
    each pattern's frequency, MPa. Contrast: (A1/A2 in the first state) over (A1/A2 in the second), with amplitudes of
    at least their floor. A dome is left out unless each pattern is `LEAST_RATIO` times its floor in its state."""
    for pattern in patterns:
        check(pattern, matrix)
    levels = amplitudes(batch, preload, matrix, list(patterns))
    level = np.log(np.maximum(levels, floor))
    # NaN, for a dome that cannot be judged, compares as not greater.
    seen = levels >= LEAST_RATIO * np.array(floor)
    lean = level[:, 0] - level[:, 1]
    rows = []
    for number in np.unique(dome):
        rows_of_dome = np.flatnonzero(dome == number)
        first, second = rows_of_dome[seen[rows_of_dome, 0]], rows_of_dome[seen[rows_of_dome, 1]]
        if first.size and second.size:
            a, b = first[np.argmax(lean[first])], second[np.argmin(lean[second])]
            rows.append((float(np.exp(lean[a] - lean[b])), int(a), int(b)))
    rows.sort(key=lambda row: (-row[0], row[1]))
    one, two = (np.array([row[k] for row in rows], dtype=np.intp) for k in (1, 2))
    return Separation(
        dome[one],
        np.stack([batch.driving_pressure[one], batch.driving_pressure[two]], axis=1),
        np.stack([levels[one], levels[two]], axis=1),
        np.array([row[0] for row in rows]),
    )


def check(pattern: BarPattern, matrix: MatrixLayer) -> None:
    """Raise InputError for a pattern that does not fit the specimen ``matrix``."""
    if not (0.0 < pattern.pitch < np.inf and 0.0 <= pattern.depth < matrix.height):
        raise InputError(
            f"pattern {pattern.pitch:g}@{pattern.depth:g}: pitch must be more than 0 and depth from 0 to less than the "
            f"block's {matrix.height:g} mm"
        )
