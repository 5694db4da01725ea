"""The scan: a dome slides over a specimen, held at one height or at one force, and its pressure is recorded.

What modulates the pressure: the dome (stiffness k) and the specimen (compliance c) are springs in series. At a held
height the dome is pressed by what the specimen does not give, delta(F) + c(x) F = const, so that

    dp = -dp/d(delta) F dc/(1 + k c)

to first order (physics.md 4.2); here the dome's whole curve is used. At a held force the dome's state does not change
at all in this model: only the sensor's height follows the specimen. No friction, no inertia, no relaxation, no relief.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.mechanics.gauge_reading import PAPER_NOISE, PAPER_STEP, RECORDER_RATE_HZ
from pneutouch.texture.contact import PreloadContact
from pneutouch.texture.signal import Signal
from pneutouch.texture.substrate import BarRow, Substrate
from pneutouch.units import GAUGE_LIMIT, KPA

Control = Literal["height", "force"]
RATE = RECORDER_RATE_HZ
"""Samples a second, Hz; paper, Supplement C."""

STEP, NOISE = PAPER_STEP, PAPER_NOISE
"""Step of the recorder and white noise of a sample, MPa rms, of the paper's gauge."""

_NODES = 2**14
_NEWTON = 6


@dataclass(frozen=True, slots=True)
class ScanPath:
    """Movement of the sensor: mm from ``start`` to ``end`` at ``speed`` mm/s, held at a "height" or a "force"."""

    start: float
    end: float
    speed: float
    control: Control = "height"


@dataclass(frozen=True, slots=True)
class Recorder:
    """The pressure's recorder: samples a second, noise (MPa rms), step and range (MPa), seed of the noise."""

    rate: float = RATE
    noise: float = NOISE
    step: float = STEP
    limit: float = GAUGE_LIMIT
    seed: int = 0


@dataclass(frozen=True, slots=True)
class TextureScan:
    """A scan: the record, the same without noise, and the place (mm), (n,) each.

    ``height``: of the sensor above that at the preload, mm; not zero where the force is held.
    """

    signal: Signal
    clean: Array
    place: Array
    height: Array

    def pattern(self, bars: BarRow) -> Array:
        """1 where a bar is under the dome's axis, else 0, (n,)."""
        return bars.covers(self.place)


def gain(touch: PreloadContact, compliance: float) -> float:
    """Pressure by the specimen's compliance at a held height, MPa per mm/N: -dp/d(delta) F/(1 + k c)."""
    return -touch.pressure_slope * touch.preload / (1.0 + touch.stiffness * compliance)


def pressure_amplitude(
    touch: PreloadContact, substrate: Substrate, bars: BarRow, control: Control = "height", order: int = 1
) -> float:
    """Amplitude of the pressure at a pattern's frequency, MPa, to first order; never negative, 0 at a held force."""
    if control == "force":
        return 0.0
    response = gain(touch, float(substrate.compliance(_NODES).mean())) * substrate.amplitude(bars, order)
    return abs(response)


def scan(touch: PreloadContact, substrate: Substrate, path: ScanPath, recorder: Recorder = Recorder()) -> TextureScan:
    """Slide a dome over a specimen. Raises InputError for an impossible path, or one that leaves the curve of the
    dome."""
    _check(touch, substrate, path, recorder)
    time = (
        np.arange(int(np.floor((path.end - path.start) / path.speed * recorder.rate * (1 + 1e-12))) + 1) / recorder.rate
    )
    place = path.start + path.speed * time
    nodes = substrate.length * np.arange(_NODES + 1) / _NODES
    compliance = substrate.compliance(_NODES)
    mean = float(compliance.mean())
    if path.control == "height":
        indentation = _held(touch, compliance, touch.indentation + mean * touch.preload)
        pressure, height = touch.pressure_at(indentation), np.zeros_like(compliance)
    else:
        pressure = np.full_like(compliance, touch.pressure)
        height = (mean - compliance) * touch.preload
    clean, lift = (np.interp(place, nodes, np.append(values, values[0])) for values in (pressure, height))
    return TextureScan(Signal(0.0, 1.0 / recorder.rate, record(clean, recorder)), clean, place, lift)


def record(pressure: Array, recorder: Recorder) -> Array:
    """Pressures as recorded: with noise, in steps, cut at the range."""
    noisy = pressure + recorder.noise * np.random.default_rng(recorder.seed).standard_normal(len(pressure))
    if recorder.step > 0:
        noisy = recorder.step * np.round(noisy / recorder.step)
    return np.asarray(np.clip(noisy, -recorder.limit, recorder.limit))


def _held(touch: PreloadContact, compliance: Array, approach: float) -> Array:
    """The dome's indentations where dome and specimen share one approach (mm): delta + c F(delta) = approach."""
    at = np.full_like(compliance, touch.indentation)
    for _ in range(_NEWTON):
        excess = at + compliance * touch.force_at(at) - approach
        at = at - excess / (1.0 + compliance * touch.force_slope_at(at))
    if at.max() > touch.travel[-1] or at.min() < 0:
        raise InputError(
            f"preload = {touch.preload:g} N: the specimen moves the dome to {at.max():.3f} mm of indentation, beyond "
            f"the {touch.travel[-1]:.3f} mm that are known; give less preload"
        )
    return at


def _check(touch: PreloadContact, substrate: Substrate, path: ScanPath, recorder: Recorder) -> None:
    if not 0 < path.speed < np.inf:
        raise InputError(f"speed = {path.speed:g} mm/s: must be more than 0")
    if not path.end > path.start:
        raise InputError(
            f"the scan path from {path.start:g} to {path.end:g} mm is empty; the specimen is shorter than the patch"
        )
    if not 0 <= recorder.noise < np.inf:
        raise InputError(f"noise = {recorder.noise / KPA:g} kPa: must not be below 0")
    for row in substrate.bars:
        # The lobes beyond are those of a sharp-edged uniform patch, which a real contact has not.
        if row.pitch < LEAST_PITCH * touch.contact_radius:
            raise InputError(
                f"{row.name}: pitch {row.pitch:g} mm: less than {LEAST_PITCH:g} times the patch, whose radius is "
                f"{touch.contact_radius:.2f} mm at {touch.driving_pressure / KPA:g} kPa and {touch.preload:g} N; "
                f"it must be at least {LEAST_PITCH * touch.contact_radius:.2f} mm, or the preload less"
            )


LEAST_PITCH = 0.5
"""Least pitch over contact radius: k rho = 4 pi, the fourth lobe of the patch filter."""
