"""The two runs of a viscous sensor by the atlas, press and hold, and press and retract; in mm, N, MPa and s.

Each follows a press in time: wall forces with memory, trapped gas, prescribed plate travel.

Quasi-linear viscoelasticity (Fung 1993, Biomechanics, section 7.6) in two coordinates, cavity volume V and plate height
h. The elastic dome has the wall pressure P(V, h) and the plate force F(V, h) of the atlas; the viscous dome has

    p = p_I + int k(t - s) dP(s),  F = int k(t - s) dF(s),  k(t) = G(t)/G_inf

from an inflated state in which everything has relaxed. At every time V is the volume at which p equals the pressure of
the gas. The model is exact for small strains, at the first instant (the elastic dome of the instantaneous modulus, on
top of the relaxed inflated state) and in the end (the elastic dome of the relaxed modulus).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.press import AtlasPress, batch_of
from pneutouch.mechanics.atlas.table import Atlas, shipped
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.viscous.prony import Prony

_NEWTON = 10
"""Greatest number of iterations of a solution: two more than for the elastic dome."""

_NO_TRAVEL = 1.0e-9


class ViscousPath(NamedTuple):
    """Paths of n domes at m times, (n, m) each; nondimensional by R0 and the relaxed modulus.

    nu: coordinate of the cavity volume, see `AtlasPress`. elastic_pressure, elastic_force: of the relaxed dome at the
    same volume and plate height. known: True if this state and all before it were found. folded: True if the wall
    buckled, or no volume balances the gas; other states that are not known are outside the atlas."""

    nu: Array
    pressure: Array
    force: Array
    elastic_pressure: Array
    elastic_force: Array
    known: Flags
    folded: Flags


class Memory:
    """Convolution of pressure and force of n domes with k(t) - 1, both linear in time within each step, from Prony
    terms ``excess`` and ``times`` as in `follow`."""

    def __init__(self, excess: Array, times: Array) -> None:
        self._excess, self._times = excess, times
        self._held = np.zeros((2, *excess.shape))

    def step(self, seconds: Array) -> tuple[Array, Array, Array]:
        """Decay and weight (n, terms) of each term over steps of ``seconds`` (n,), and the sums of the weights (n,)."""
        share = seconds[:, None] / self._times
        decay = np.exp(-share)
        with np.errstate(invalid="ignore", divide="ignore"):
            weight = self._excess * np.where(share > 0.0, -np.expm1(-share) / share, 1.0)
        return decay, weight, weight.sum(axis=1)

    def left(self, decay: Array) -> Array:
        """Remaining contribution of the past to pressure and force, (2, n)."""
        return np.asarray((self._held * decay).sum(axis=2))

    def add(self, decay: Array, weight: Array, change: Array) -> None:
        """Add a step with changes (2, n) of pressure and force to the past; ``decay`` and ``weight`` from `step`."""
        self._held = self._held * decay + weight * change[..., None]


def follow(press: AtlasPress, excess: Array, times: Array, clock: Array, travel: Array) -> ViscousPath:
    """Follow n domes along plate ``travel`` (n, m; R0) at the times ``clock`` (n, m; s), both 0 at first contact.

    excess, times: Prony terms over the relaxed modulus and their times in s, (n, terms); an excess of 0 means no term.
    """
    memory = Memory(excess, times)
    nu, known = press.free, np.ones(press.free.size, dtype=bool)
    start = press.slices.point(press.k, nu, press.apex)
    before = np.stack([start.pressure, np.zeros_like(nu)])
    rate, at = np.zeros_like(nu), travel[:, 0]
    columns = [(nu, *before, *before, known, ~known)]
    for j in range(1, clock.shape[1]):
        decay, weight, stiffer = memory.step(clock[:, j] - clock[:, j - 1])
        past = memory.left(decay) - stiffer * before
        height = press.apex - travel[:, j]
        guess = nu + rate * (travel[:, j] - at)
        solved = press.solve(guess, height, 1.0 + stiffer, past[0], _NEWTON)
        point, margin = solved.point, solved.margin
        now = np.stack([point.pressure, np.where(travel[:, j] > _NO_TRAVEL, point.force, 0.0)])
        known, lost = known & solved.ok, point.folded | ~solved.converged
        rate = np.where(known, (1.0 + stiffer) * point.by_height / np.where(margin > 0, margin, 1.0) / press.reach, 0.0)
        memory.add(decay, weight, now - before)
        nu, before, at = np.where(known, solved.nu, nu), now, travel[:, j]
        columns.append((nu, *((1.0 + stiffer) * now + past), *now, known, lost))
    return ViscousPath(*(np.stack(part, axis=1) for part in zip(*columns, strict=True)))


_Run = TypeVar("_Run")

HOLD_TIMES = np.concatenate([np.geomspace(1e-2, 1.0, 13)[:-1], np.geomspace(1.0, 600.0, 28)])
"""Times after the ramp, s: up to the paper's 600 s (Supplement D), logarithmically spaced, with 1 s among them."""

_RAMP_STEPS, _LOOP_STEPS = 30, 48
"""Numbers of equal steps in a ramp and in half a loop: losses within 0.1, hysteresis within 0.2 percentage points."""


@dataclass(frozen=True)
class RelaxationRun:
    """A sensor pressed at constant speed and held: force (N) and pressure rise (MPa) at times (s) after the ramp.

    ``ended`` is the reason if the run could not be followed further, and the arrays then end before; else None.
    """

    times: Array
    force: Array
    rise: Array
    ended: str | None = None

    @property
    def _late(self) -> Index:
        return np.flatnonzero(self.times >= 1.0 - 1e-9)

    @property
    def holds(self) -> bool:
        """True if the run continues beyond 1 s."""
        return self._late.size > 1

    def percent(self, values: Array) -> Array:
        """Values at all times of a run that `holds`, in percent of the value at 1 s."""
        return np.asarray(100 * values / values[self._late[0]])

    def drop(self, values: Array) -> tuple[float, float]:
        """Loss of ``values`` from 1 s to the end, and per decade of time (least squares over log10 t from 1 s), both
        relative to the value at 1 s.

        Raises ValueError if the run does not continue beyond 1 s.
        """
        late = self._late
        if not self.holds:
            raise ValueError("the run does not hold for longer than 1 s")
        first, decades = values[late][0], np.log10(self.times[late])
        slope = np.polyfit(decades, values[late], 1)[0]
        return float(1.0 - values[-1] / first), float(-slope / first)


@dataclass(frozen=True)
class LoopRun:
    """A sensor pressed to a depth and retracted at one speed: indentation (mm), force (N), rise (MPa), in and out.

    ``contact_lost`` is the plate travel (mm) during retraction at which the dome stops following the plate and the loop
    ends; None if it follows to the end. ``ended`` gives the reason if the run could not be followed further, else None;
    a run that does not reach its depth has no retraction.
    """

    indentation_in: Array
    force_in: Array
    rise_in: Array
    indentation_out: Array
    force_out: Array
    rise_out: Array
    contact_lost: float | None = None
    ended: str | None = None

    def hysteresis(self) -> tuple[float, float] | None:
        """Hysteresis by both usual measures, see `hysteresis`; None without a retraction."""
        if self.force_out.size < 2:
            return None
        return hysteresis(self.force_in, self.rise_in, self.force_out, self.rise_out)


def relaxation(
    sensor: Sensor,
    series: Sequence[Prony],
    driving_pressures: Sequence[float],
    depth: float,
    speed: float,
    times: Array = HOLD_TIMES,
    steps: int = _RAMP_STEPS,
    atlas: Atlas | None = None,
) -> list[list[RelaxationRun]]:
    """Press to ``depth`` (mm) at ``speed`` (mm/s), hold for ``times`` (s, > 0, ascending); lists by pressure, series.

    The sensor's modulus must be the relaxed one, and the sensor inside the atlas (`atlas.coverage.outside_atlas`).
    """
    share = np.linspace(0.0, 1.0, steps + 1)
    # The history is linear between times: intermediate times must be added to the requested ones.
    between = (
        HOLD_TIMES
        if times[-1] <= HOLD_TIMES[-1]
        else np.append(HOLD_TIMES, np.geomspace(HOLD_TIMES[-1], times[-1], 28))
    )
    waits = np.union1d(times, between[between < times[-1]])
    clock = np.concatenate([share * depth / speed, depth / speed + waits])
    travel = np.concatenate([share, np.ones(waits.size)]) * depth
    press, path = _followed(sensor, series, driving_pressures, clock, travel, atlas)
    force, rise = _with_units(press, path)
    runs = []
    for i in range(force.shape[0]):
        known, ended = _sound(press, path, i)
        requested = steps + 1 + np.searchsorted(waits, times)
        requested = requested[requested < known]
        where = None if ended is None else f"{ended} at {travel[known]:.2f} mm"
        runs.append(RelaxationRun(times[: requested.size], force[i, requested], rise[i, requested], where))
    return _by_state(runs, len(series))


def loop(
    sensor: Sensor,
    series: Sequence[Prony],
    driving_pressures: Sequence[float],
    depth: float,
    speed: float,
    steps: int = _LOOP_STEPS,
    atlas: Atlas | None = None,
) -> list[list[LoopRun]]:
    """Press to ``depth`` (mm) and retract at ``speed`` (mm/s); lists by driving pressure (MPa), then series."""
    share = np.linspace(0.0, 1.0, steps + 1)
    travel = np.concatenate([share, share[-2::-1]]) * depth
    clock = np.linspace(0.0, 2.0 * depth / speed, 2 * steps + 1)
    press, path = _followed(sensor, series, driving_pressures, clock, travel, atlas)
    force, rise = _with_units(press, path)
    runs = [loop_run(travel, force[i], rise[i], *_sound(press, path, i)) for i in range(force.shape[0])]
    return _by_state(runs, len(series))


def loop_run(travel: Array, force: Array, rise: Array, known: int, ended: str | None) -> LoopRun:
    """Loop from 2 n + 1 points, of which the first ``known`` are valid, cut where the plate would pull the dome."""
    turn, last = travel.size // 2, travel.size - 1
    where = None if ended is None else f"{ended} at {travel[known]:.2f} mm"
    there = slice(0, min(known, turn + 1))
    back = np.stack([travel, force, rise])[:, turn : max(known, turn)]
    pulled, lost = np.flatnonzero(back[1] <= 0.0), None
    if pulled.size and turn + pulled[0] < last:
        first = int(pulled[0])
        before, after = back[:, first - 1], back[:, first]
        edge = before + before[1] / (before[1] - after[1]) * (after - before)
        back, lost, where = np.column_stack([back[:, :first], edge]), float(edge[0]), None
    return LoopRun(
        indentation_in=travel[there],
        force_in=force[there],
        rise_in=rise[there],
        indentation_out=back[0],
        force_out=back[1],
        rise_out=back[2],
        contact_lost=lost,
        ended=where,
    )


def _followed(
    sensor: Sensor,
    series: Sequence[Prony],
    driving_pressures: Sequence[float],
    clock: Array,
    travel: Array,
    atlas: Atlas | None,
) -> tuple[AtlasPress, ViscousPath]:
    """Press and paths of all driving pressures in all series; along the first axis the series change fastest."""
    batch = batch_of(sensor, np.repeat(np.asarray(driving_pressures, dtype=float), len(series)))
    terms = max(len(one.shares) for one in series)
    excess, times = np.zeros((len(series), terms)), np.ones((len(series), terms))
    for row, one in enumerate(series):
        excess[row, : len(one.times)], times[row, : len(one.times)] = one.excess, one.times
    slices = (atlas or shipped()).slices(batch.wall_ratio[:1], ())
    press = AtlasPress(batch, slices, np.zeros(len(batch), dtype=np.intp))
    many = len(driving_pressures)
    shape = (len(batch), clock.size)
    path = follow(
        press,
        np.tile(excess, (many, 1)),
        np.tile(times, (many, 1)),
        np.broadcast_to(clock, shape),
        np.broadcast_to(travel / sensor.dome.inner_radius, shape),
    )
    return press, path


def _with_units(press: AtlasPress, path: ViscousPath) -> tuple[Array, Array]:
    """Force (N) and pressure rise (MPa) of paths, (n, m) each."""
    mu, radius = press.batch.shear_modulus[:, None], press.batch.inner_radius[:, None]
    return path.force * mu * radius**2, (path.pressure - path.pressure[:, :1]) * mu


def _sound(press: AtlasPress, path: ViscousPath, i: int) -> tuple[int, str | None]:
    """Number of sound states at the start of path i (known, in the gauge's range), and why no more; None if all are."""
    clipped = path.pressure[i] > press.batch.gauge_limit[i] / press.batch.shear_modulus[i]
    sound = path.known[i] & ~clipped
    if sound.all():
        return sound.size, None
    first = int(np.argmin(sound))
    if path.known[i, first]:
        return first, "gauge range"
    return first, "inward buckling" if path.folded[i, first] else "outside the atlas"


def _by_state(runs: list[_Run], series: int) -> list[list[_Run]]:
    return [runs[k : k + series] for k in range(0, len(runs), series)]


def hysteresis(force_up: Array, rise_up: Array, force_down: Array, rise_down: Array) -> tuple[float, float]:
    """Hysteresis between a loading and an unloading branch by its two usual definitions, as fractions.

    First the greatest difference of the pressure rises at equal force over the range of the loading branch's rise; then
    the area of the loop over the area under the loading branch. The paper gives hysteresis without a formula.
    """
    up, down = np.argsort(force_up), np.argsort(force_down)
    low = max(force_up.min(), force_down.min())
    high = min(force_up.max(), force_down.max())
    grid = np.unique(np.concatenate([force_up, force_down]))
    grid = grid[(grid >= low) & (grid <= high)]
    loading = np.interp(grid, force_up[up], rise_up[up])
    unloading = np.interp(grid, force_down[down], rise_down[down])
    gap = np.abs(unloading - loading)
    width, area = float(gap.max() / np.ptp(rise_up)), float(np.trapezoid(gap, grid))
    return width, area / float(np.trapezoid(loading, grid))
