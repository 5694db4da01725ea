"""A dome at a preload slides over a specimen at constant height or constant force, and its pressure is recorded.

The plate is flat, rigid and frictionless, the gas trapped (Boyle, with the dead volume): the specimen deforms far less
than the dome (`texture.substrate`). Dome (stiffness k) and specimen (compliance c) are springs in series. At constant
height delta(F) + c(x) F = const, so that dp = -dp/d(delta) F dc/(1 + k c) to first order (physics.md 4.2); here the
whole curve of the dome is used. At constant force only the sensor's height follows the specimen. Friction, inertia,
relaxation and relief are neglected."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array, bisected, hermite
from pneutouch.errors import BeyondLimitError, InputError
from pneutouch.mechanics.atlas.press import AtlasPress, PressTrack, SensorBatch, batch_of
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.gauge_reading import PAPER_NOISE, PAPER_STEP, RECORDER_RATE_HZ
from pneutouch.mechanics.models.choice import outside
from pneutouch.mechanics.sensor import Sensor
from pneutouch.texture.signal import Signal
from pneutouch.texture.substrate import BarRow, Substrate
from pneutouch.units import GAUGE_LIMIT, KPA

_COLUMNS = 61
"""Number of plate heights of a loading curve, with Hermite cubics of exact slopes in between."""
_SOLID_STEPS = 30


@dataclass(frozen=True, slots=True)
class PreloadContact:
    """A dome at one driving pressure and one preload; mm, N, MPa.

    Attributes:
        driving_pressure, preload: As given.
        indentation, contact_radius, pressure: Values at the preload; pressure is gauge.
        stiffness: dF/d(indentation), N/mm, gas included.
        pressure_slope: dp/d(indentation), MPa/mm, gas included.
        model: Name of the model that was used.
        travel, force, rise: Loading curve, (n,), from first contact on; rise is above the driving pressure.
        force_slope, rise_slope: Derivatives of force and rise by travel, (n,)."""

    driving_pressure: float
    preload: float
    indentation: float
    contact_radius: float
    pressure: float
    stiffness: float
    pressure_slope: float
    model: str
    travel: Array
    force: Array
    rise: Array
    force_slope: Array
    rise_slope: Array

    def force_at(self, indentation: Array) -> Array:
        """Force in N at indentations in mm, any shape, within the curve."""
        return _along(indentation, self.travel, self.force, self.force_slope)

    def force_slope_at(self, indentation: Array) -> Array:
        """Derivative of the force, N/mm, linear between the curve's points: good enough for Newton's method."""
        return np.interp(indentation, self.travel, self.force_slope)

    def pressure_at(self, indentation: Array) -> Array:
        """Gauge pressure in MPa at indentations in mm, any shape, within the curve."""
        return self.driving_pressure + _along(indentation, self.travel, self.rise, self.rise_slope)


class PreloadContacts(NamedTuple):
    """Many sensors at one preload, (n,) each as in `PreloadContact`; NaN where the atlas does not reach the preload."""

    indentation: Array
    contact_radius: Array
    stiffness: Array
    pressure_slope: Array


def touch(sensor: Sensor, driving_pressure: float, preload: float) -> PreloadContact:
    """Press the dome at a driving pressure (MPa) to a preload (N), by the atlas; by the solid where the atlas ends
    before.

    Raises InputError for a preload that is not positive or not reached within the sensor's depth, and for pressures
    that are negative, beyond the limit point or beyond the pressure sensor's range."""
    _check_preload(sensor, driving_pressure, preload)
    curve = None if outside("atlas", sensor) else _atlas_curve(sensor, driving_pressure)
    model = "atlas"
    if curve is None or curve[1][-1] < preload:
        model, curve = "solid", _solid_curve(sensor, driving_pressure)
    travel, force, rise, radius, force_slope, rise_slope = curve
    if force[-1] < preload:
        raise InputError(
            f"preload = {preload:g} N: at {driving_pressure / KPA:g} kPa the sensor reaches {force[-1]:.3g} N within "
            f"its {travel[-1]:.2f} mm of travel; give less, or a design with more indentation.depth_mm"
        )
    at = float(_inverse(np.array([preload]), travel[None], force[None], force_slope[None])[0])
    pressure = driving_pressure + float(_along(np.array(at), travel, rise, rise_slope))
    if pressure > sensor.gas.gauge_limit:
        raise InputError(
            f"preload = {preload:g} N: the pressure there is {pressure / KPA:.4g} kPa, beyond the pressure sensor's "
            f"{sensor.gas.gauge_limit / KPA:g} kPa; give less"
        )
    return PreloadContact(
        driving_pressure=driving_pressure,
        preload=preload,
        indentation=at,
        contact_radius=float(np.interp(at, travel, radius)),
        pressure=pressure,
        stiffness=float(np.interp(at, travel, force_slope)),
        pressure_slope=float(np.interp(at, travel, rise_slope)),
        model=model,
        travel=travel,
        force=force,
        rise=rise,
        force_slope=force_slope,
        rise_slope=rise_slope,
    )


def touches(batch: SensorBatch, preload: float) -> PreloadContacts:
    """Many sensors at a preload (N), by the atlas, which must cover the batch; pressures below the limit points."""
    walls, k = np.unique(batch.wall_ratio, return_inverse=True)
    press = AtlasPress(batch, shipped().slices(walls, ("contact_radius",)), k)
    depth = batch.depth / batch.inner_radius
    track = press.march(np.linspace(0.0, 1.0, _COLUMNS) * depth[:, None])
    travel, force, _, radius, force_slope, rise_slope = _dimensional(press, track)
    known = np.logical_and.accumulate(track.ok, axis=1) & (force_slope > 0)
    known[:, 0] = track.ok[:, 0]
    force = np.where(known, force, -np.inf)
    reached = force.max(axis=1) >= preload
    at = np.full(len(batch), np.nan)
    at[reached] = _inverse(np.full(reached.sum(), preload), travel[reached], force[reached], force_slope[reached])

    def read(values: Array) -> Array:
        return np.array([np.interp(x, t, v) for x, t, v in zip(at, travel, values, strict=True)])

    return PreloadContacts(at, read(radius), read(force_slope), read(rise_slope))


def _check_preload(sensor: Sensor, pressure: float, preload: float) -> None:
    if not 0.0 < preload < np.inf:
        raise InputError(f"preload = {preload:g} N: must be more than 0")
    if not 0.0 <= pressure < np.inf:
        raise InputError(f"driving pressure {pressure / KPA:g} kPa: must be a finite number, 0 or more")
    if pressure >= sensor.gas.gauge_limit:
        raise InputError(
            f"driving pressure {pressure / KPA:g} kPa: beyond the pressure sensor's range of "
            f"{sensor.gas.gauge_limit / KPA:g} kPa"
        )
    if outside("atlas", sensor) is None:
        ratio = np.array([sensor.dome.wall_thickness / sensor.dome.inner_radius])
        limit = float(shipped().slices(ratio, ()).limit_pressure[0]) * sensor.wall.shear_modulus
        if pressure >= limit:
            raise _beyond(pressure, limit)


def _beyond(pressure: float, limit: float) -> InputError:
    return InputError(
        f"driving pressure {pressure / KPA:g} kPa: beyond the limit point, where the dome snaps; it must be less than "
        f"{limit / KPA:.2f} kPa"
    )


LoadingCurve = tuple[Array, Array, Array, Array, Array, Array]
"""Travel (mm), force (N), rise (MPa), contact radius (mm), slopes of force and rise by travel, along the last axis."""


def _atlas_curve(sensor: Sensor, pressure: float) -> LoadingCurve | None:
    """The curve as far as the atlas covers it; None for fewer than four points."""
    batch = batch_of(sensor, [pressure])
    press = AtlasPress(batch, shipped().slices(batch.wall_ratio, ("contact_radius",)), np.zeros(1, dtype=np.intp))
    track = press.march(np.linspace(0.0, sensor.protocol.depth / sensor.dome.inner_radius, _COLUMNS)[None, :])
    curve = _dimensional(press, track)
    known = int(np.logical_and.accumulate(track.ok[0] & (curve[4][0] > 0)).sum())
    if known < 4:
        return None
    return tuple(column[0, :known] for column in curve)  # type: ignore[return-value]


def _dimensional(press: AtlasPress, track: PressTrack) -> LoadingCurve:
    """Curves (n, m) in mm, N and MPa, with exact slopes that include the change of volume with the plate."""
    mu, size = press.batch.shear_modulus[:, None], press.batch.inner_radius[:, None]
    point = track.point
    swell = point.by_height / np.where(track.margin > 0, track.margin, np.inf)
    force_slope = -point.by_height * swell - point.force_by_height
    rise_slope = point.by_volume * swell - point.by_height
    radius = np.maximum.accumulate(np.maximum(press.field("contact_radius", track), 0.0), axis=1)
    return (
        (press.apex[:, None] - track.height) * size,
        point.force * mu * size**2,
        (point.pressure - press.pressure[:, None]) * mu,
        radius * size,
        force_slope * mu * size,
        rise_slope * mu / size,
    )


def _solid_curve(sensor: Sensor, pressure: float) -> LoadingCurve:

    from scipy.interpolate import CubicSpline

    from pneutouch.mechanics.models.solid import solid_states

    try:
        state = solid_states(sensor.replace(steps=_SOLID_STEPS), np.array([pressure]))[0]
    except BeyondLimitError as error:
        raise _beyond(error.pressure, error.limit) from None
    travel, force, rise = state.indentation, state.force, state.pressure_rise
    if len(travel) < 4:
        raise InputError(f"driving pressure {pressure / KPA:g} kPa: the dome carries no plate; give another design")
    slopes = [CubicSpline(travel, values)(travel, 1) for values in (force, rise)]
    return travel, force, rise, state.contact_radius, slopes[0], slopes[1]


def _along(at: Array, travel: Array, values: Array, slopes: Array) -> Array:
    return np.asarray(hermite(at, travel, values, slopes))


def _inverse(level: Array, travel: Array, force: Array, slope: Array) -> Array:
    """Travel at which each curve (n, m) first reaches a force (n,), by bisection on its Hermite cubic."""
    rows = np.arange(len(level))
    after = np.maximum((force >= level[:, None]).argmax(axis=1), 1)
    low, high = travel[rows, after - 1], travel[rows, after]
    f0, f1 = force[rows, after - 1], force[rows, after]
    m0, m1 = slope[rows, after - 1] * (high - low), slope[rows, after] * (high - low)

    def excess(s: Array) -> Array:
        value = (f0 * (1 + 2 * s) + m0 * s) * (1 - s) ** 2 + (f1 * (3 - 2 * s) + m1 * (s - 1)) * s * s
        return np.asarray(value - level)

    return np.asarray(low + bisected(excess, np.zeros_like(level), np.ones_like(level)) * (high - low))


Control = Literal["height", "force"]
RATE = RECORDER_RATE_HZ
"""Samples a second, Hz; paper, Supplement C."""

STEP, NOISE = PAPER_STEP, PAPER_NOISE
"""Step of the recorder, MPa, and white noise of a sample, MPa rms, of the paper's gauge."""

_NODES = 2**14
_NEWTON = 6


@dataclass(frozen=True, slots=True)
class ScanPath:
    """Movement of the sensor: mm from ``start`` to ``end`` at ``speed`` mm/s, at constant "height" or "force"."""

    start: float
    end: float
    speed: float
    control: Control = "height"


@dataclass(frozen=True, slots=True)
class Recorder:
    """Recorder of the pressure: samples a second, noise (MPa rms), step and range (MPa), seed of the noise."""

    rate: float = RATE
    noise: float = NOISE
    step: float = STEP
    limit: float = GAUGE_LIMIT
    seed: int = 0


@dataclass(frozen=True, slots=True)
class TextureScan:
    """A scan: recorded signal, pressure without noise (MPa) and position (mm), (n,) each.

    ``height``, (n,), is the sensor's height above that at the preload, mm; not zero at constant force."""

    signal: Signal
    clean: Array
    place: Array
    height: Array

    def pattern(self, bars: BarRow) -> Array:
        """1 where a bar is under the dome's axis, else 0, (n,)."""
        return bars.covers(self.place)


def gain(touch: PreloadContact, compliance: float) -> float:
    """Derivative of the pressure by the specimen's compliance (mm/N) at constant height, MPa N/mm: -dp/d(delta) F/(1 +
    k c)."""
    return -touch.pressure_slope * touch.preload / (1.0 + touch.stiffness * compliance)


def pressure_amplitude(
    touch: PreloadContact, substrate: Substrate, bars: BarRow, control: Control = "height", order: int = 1
) -> float:
    """Amplitude of the pressure, MPa, at ``order`` times a pattern's frequency, to first order; 0 at constant force."""
    if control == "force":
        return 0.0
    response = gain(touch, float(substrate.compliance(_NODES).mean())) * substrate.amplitude(bars, order)
    return abs(response)


def scan(touch: PreloadContact, substrate: Substrate, path: ScanPath, recorder: Recorder = Recorder()) -> TextureScan:
    """Slide a dome over a specimen. Raises InputError for an impossible path, a pattern finer than `LEAST_PITCH`
    allows, or indentation beyond the dome's curve."""
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
    """Pressures (MPa) as recorded: with noise, rounded to steps, clipped to the range."""
    noisy = pressure + recorder.noise * np.random.default_rng(recorder.seed).standard_normal(len(pressure))
    if recorder.step > 0:
        noisy = recorder.step * np.round(noisy / recorder.step)
    return np.asarray(np.clip(noisy, -recorder.limit, recorder.limit))


def _held(touch: PreloadContact, compliance: Array, approach: float) -> Array:
    """Indentations of the dome for one common approach (mm) of dome and specimen: delta + c F(delta) = approach."""
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
        # The lobes beyond are those of a sharp-edged uniform patch, which real contacts do not have.
        if row.pitch < LEAST_PITCH * touch.contact_radius:
            raise InputError(
                f"{row.name}: pitch {row.pitch:g} mm: less than {LEAST_PITCH:g} times the patch, whose radius is "
                f"{touch.contact_radius:.2f} mm at {touch.driving_pressure / KPA:g} kPa and {touch.preload:g} N; "
                f"it must be at least {LEAST_PITCH * touch.contact_radius:.2f} mm, or the preload less"
            )


LEAST_PITCH = 0.5
"""Least pitch over contact radius: k rho = 4 pi, in the fourth lobe of the patch's filter."""
