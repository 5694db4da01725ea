"""Figures of many sensors at once from the atlas, by the functions of `response` as for every other curve."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.press import AtlasPress, PressTrack, SensorBatch
from pneutouch.mechanics.atlas.table import REST_VOLUME, Atlas, shipped
from pneutouch.mechanics.response import Figures, lines
from pneutouch.units import KPA

ENDS = ("depth", "plate edge", "gauge range", "break strain", "inward buckling", "outside the atlas")
"""Reasons for the end of a range, numbered in an `AtlasResponse`; the first is no event: the whole travel is used."""
DEPTH, EDGE, GAUGE, BREAK, BUCKLING, OUTSIDE = range(len(ENDS))

NEAR = 0.03
"""Travel in R0 before buckling in which the table is less certain: the stiffness falls too fast for its resolution."""
_CHUNK = 1000
_FIELDS = ("stretch", "contact_radius")
_ROUNDS = 20
_WITHIN = 1.0e-8
"""Travel in R0, and margin, within which the end of a range is located: the rest is noise in derivatives. 2e-5 leaves
1.4 % in an expanded uncertainty of `designs/stiff-dome.toml`, 1e-8 0.002 %, for nearly the same time."""


class AtlasResponse(NamedTuple):
    """Responses of n sensors; (n,) or (n, m) arrays in mm, N, MPa, sensitivities in kPa/N.

    ends: number in `ENDS`. near_buckling: the wall would buckle within `NEAR` of further travel, where the table is
    less accurate. range_end: mm of indentation. contact_radius: at range_end. Curves run from first contact to
    range_end in equal steps. max_stretch: greatest over the range, with the inflated state. Rows of sensors without a
    curve (beyond the limit point, outside the box, range of no length) are NaN; limit_pressure only outside the box.
    """

    lines: Figures[Array]
    ends: Index
    near_buckling: Flags
    range_end: Array
    contact_radius: Array
    limit_pressure: Array
    apex_outer: Array
    cavity_volume: Array
    max_stretch: Array
    indentation: Array
    force: Array
    rise: Array

    def take(self, rows: Index | Flags) -> "AtlasResponse":
        """Responses of the selected sensors."""
        some: list[Any] = [column[rows] for column in self[1:]]
        return AtlasResponse(Figures(*(column[rows] for column in self.lines)), *some)

    @classmethod
    def join(cls, parts: "Sequence[AtlasResponse]") -> "AtlasResponse":
        """Responses of several batches, one after the other."""
        columns: list[Any] = [np.concatenate(column) for column in zip(*(part[1:] for part in parts), strict=True)]
        solved = [np.concatenate(column) for column in zip(*(part.lines for part in parts), strict=True)]
        return cls(Figures(*solved), *columns)


def inside(batch: SensorBatch, atlas: Atlas) -> Flags:
    """Mask (n,) of the sensors that the atlas covers: wall, depth, stiffness of the gas, no suction; sensors with
    negative or NaN values are outside.

    A dead volume may be negative, as a deviation from a small one, down to minus half of the unloaded cavity.
    """
    recipe, size, slack = atlas.recipe, batch.inner_radius, 1e-9
    return np.asarray(
        (size > 0.0)
        & (batch.shear_modulus > 0.0)
        & (batch.depth > 0.0)
        & (batch.plate_radius > 0.0)
        & (batch.ambient_pressure >= 0.0)
        & (batch.dead_volume >= -0.5 * REST_VOLUME * size**3)
        & (batch.driving_pressure >= 0.0)
        & (batch.wall_thickness >= recipe.thinnest * (1 - slack) * size)
        & (batch.wall_thickness <= recipe.thickest * (1 + slack) * size)
        & (batch.depth <= recipe.deepest * (1 + slack) * size)
        & (batch.ambient_pressure <= recipe.stiffest * batch.shear_modulus)
        & ~np.isnan(batch.gauge_limit)
        & ~np.isnan(batch.break_stretch)
    )


def _harmless(batch: SensorBatch, good: Flags, atlas: Atlas) -> SensorBatch:
    """The batch with a harmless sensor in place of those that are not ``good``, so that no NaN or overflow of theirs
    reaches the iterations of the others."""
    plain = SensorBatch(
        *(np.array(x) for x in (1.0, atlas.recipe.thickest, 1.0, 0.0, 0.0, 0.0, 0.1, np.inf, np.inf, np.inf))
    )
    return SensorBatch(*(np.where(good, getattr(batch, f.name), getattr(plain, f.name)) for f in fields(SensorBatch)))


def respond(batch: SensorBatch, steps: int = 14, atlas: Atlas | None = None) -> AtlasResponse:
    """Press every sensor to its depth, or to the first event that ends the range, and compute the figures; no sensor's
    response depends on the others of the batch."""
    chosen = atlas or shipped()
    chunks = [slice(start, start + _CHUNK) for start in range(0, len(batch), _CHUNK)]
    parts = [run(batch.take(chunk), steps, chosen).response for chunk in chunks]
    return parts[0] if len(parts) == 1 else AtlasResponse.join(parts)


class AtlasRun(NamedTuple):
    """One pass over sensors: their responses, the press with its inflated states, and the states of every press over
    its whole depth, (n, steps + 1), also beyond the end of its range."""

    response: AtlasResponse
    press: AtlasPress
    whole: PressTrack


def run(batch: SensorBatch, steps: int, atlas: Atlas, names: tuple[str, ...] = _FIELDS) -> AtlasRun:
    """`respond` in one pass, together with the states behind it; ``names`` are the fields to cut from the tables."""
    good = inside(batch, atlas)
    batch = _harmless(batch, good, atlas)
    press = AtlasPress(batch, *atlas.slices_of(batch.wall_thickness, batch.inner_radius, names))
    share = np.linspace(0.0, 1.0, steps + 1)
    travel = share * (batch.depth / batch.inner_radius)[:, None]
    whole = press.march(travel)
    stretch, radius = press.several(_FIELDS, whole)
    end, ends = _first_end(press, travel, whole, _margins(press, whole, stretch, radius))
    track = whole
    cut = np.flatnonzero(ends != DEPTH)
    if cut.size:
        part = press.rows(cut)
        track, again = whole.each(np.copy), part.march(share * end[cut, None])
        pairs = zip((*track[:2], *track.point, *track[3:]), (*again[:2], *again.point, *again[3:]), strict=True)
        for used, solved in pairs:
            used[cut] = solved
        stretch[cut], radius[cut] = part.several(_FIELDS, again)
    ends = np.where(good, ends, OUTSIDE)
    return AtlasRun(_read_off(press, track, end, ends, good, (stretch, radius)), press, whole)


def _read_off(
    press: AtlasPress, track: PressTrack, end: Array, ends: Index, good: Flags, known: tuple[Array, Array]
) -> AtlasResponse:
    """Responses along presses to the travel ``end`` (n,) in R0; ``good`` marks the sensors that the atlas covers,
    ``known`` holds stretch and contact radius along the presses, (n, m) each."""
    batch = press.batch
    limit = press.limit * batch.shear_modulus
    share = np.linspace(0.0, 1.0, track.nu.shape[1])
    mu, radius = batch.shear_modulus[:, None], batch.inner_radius[:, None]
    indentation = share * end[:, None] * radius
    force = track.point.force * mu * radius**2
    rise = (track.point.pressure - press.pressure[:, None]) * mu
    infeasible = ~good | (batch.driving_pressure >= limit) | (end <= 0.0)
    for array in (indentation, force, rise):
        array[infeasible] = np.nan
    stretch, contact = known[0].max(axis=1), known[1][:, -1]
    return AtlasResponse(
        lines=lines(indentation, force, rise / KPA),
        ends=ends,
        near_buckling=good & _near(press, track),
        range_end=np.where(infeasible, np.nan, end * batch.inner_radius),
        contact_radius=np.where(infeasible, np.nan, contact * batch.inner_radius),
        limit_pressure=np.where(good, limit, np.nan),
        apex_outer=np.where(infeasible, np.nan, press.apex * batch.inner_radius),
        cavity_volume=np.where(infeasible, np.nan, press.volume(press.free) * batch.inner_radius**3),
        max_stretch=np.where(infeasible, np.nan, stretch),
        indentation=indentation,
        force=force,
        rise=rise,
    )


def _near(press: AtlasPress, track: PressTrack) -> Flags:
    """Mask (n,) of presses that, extrapolated linearly beyond their ends, would buckle within `NEAR`."""
    margin = np.where(track.margin[:, -1] > 0, track.margin[:, -1], 1.0)
    rate = track.point.by_height[:, -1] / margin / press.reach
    nu, height = track.nu[:, -1] + NEAR * rate, track.height[:, -1] - NEAR
    return np.asarray(press.slices.folded(press.k, nu, height) | (track.margin[:, -1] <= 0))


def _margins(press: AtlasPress, track: PressTrack, stretch: Array, radius: Array) -> Array:
    """Margins that turn positive at the end of a range, in the order of `ENDS` from EDGE to BREAK; (3, n, m)."""
    batch = press.batch
    gauge = (track.point.pressure - (batch.gauge_limit / batch.shear_modulus)[:, None]) / press.limit[:, None]
    return np.stack([radius - batch.flat_radius[:, None], gauge, stretch - batch.break_stretch[:, None]])


def _first_end(press: AtlasPress, indentation: Array, track: PressTrack, margins: Array) -> tuple[Array, Index]:
    """Plate travel (R0) at which each range ends, and the number of the reason in `ENDS`, (n,) each."""
    broken = (margins > 0.0).any(axis=0) | ~track.ok
    hit = np.flatnonzero(broken.any(axis=1))
    end, ends = indentation[:, -1].copy(), np.full(len(press.batch), DEPTH)
    at_once = hit[broken[hit, 0]]
    end[at_once] = 0.0
    if hit.size:
        column = np.maximum(broken[hit].argmax(axis=1), 1)
        part = press.rows(hit)
        start = track.nu[hit, column - 1]
        bracket = indentation[hit, column - 1], indentation[hit, column]
        buckled = track.point.folded[hit, column] | (track.margin[hit, column] <= 0)
        lost = np.where(track.ok[hit, column], DEPTH, np.where(buckled, BUCKLING, OUTSIDE))
        low, ends[hit] = _closed_in(part, start, bracket, lost)
        end[hit] = np.where(broken[hit, 0], 0.0, low)
    return end, ends


def _closed_in(press: AtlasPress, nu: Array, bracket: tuple[Array, Array], lost: Index) -> tuple[Array, Index]:
    """Travel at which a range first ends in a bracket of travels, and the number of the reason in `ENDS`, (n,) each.

    ``lost`` (n,) is the reason why the press had no state at the bracket's end, `DEPTH` where it had one; it is used if
    a solution from elsewhere just holds there. Illinois variant of false position on the greatest margin; bisection
    where there is no state.
    """
    low, high = bracket
    before, _, _ = _worst(press, nu, low)
    after, ends, _ = _worst(press, nu, high)
    ends = np.where((after <= 0.0) & (lost != DEPTH), lost, ends)
    open_ = np.ones(nu.size, dtype=bool)
    for _ in range(_ROUNDS):
        with np.errstate(invalid="ignore", divide="ignore"):
            share = before / (before - after)
        share = np.where(np.isfinite(before) & np.isfinite(after), np.clip(share, 0.02, 0.98), 0.5)
        middle = low + share * (high - low)
        worst, reason, solved = _worst(press, nu, middle)
        over, under = open_ & (worst > 0.0), open_ & ~(worst > 0.0)
        low, high = np.where(under, middle, low), np.where(over, middle, high)
        before = np.where(under, worst, np.where(over, 0.5 * before, before))
        after = np.where(over, worst, np.where(under, 0.5 * after, after))
        ends, nu = np.where(over, reason, ends), np.where(under, solved, nu)
        open_ &= (high - low >= _WITHIN) & ~(np.abs(worst) < _WITHIN)
        if not open_.any():
            break
    return np.where(np.abs(after) < np.abs(before), high, low), ends


def _worst(press: AtlasPress, nu: Array, indentation: Array) -> tuple[Array, Index, Array]:
    """Greatest margin at plate travels (n,), inf without a state; number of its reason in `ENDS`; volume nu, (n,)."""
    height = press.apex - indentation
    solved = press.solve(nu, height)
    one = PressTrack(solved.nu, height, solved.point, solved.margin, solved.ok).each(lambda column: column[:, None])
    margins = _margins(press, one, *press.several(_FIELDS, one))[..., 0]
    unknown = (solved.margin > 0.0) & ~solved.point.supported & ~solved.point.folded
    reason = np.where(solved.ok, EDGE + margins.argmax(axis=0), np.where(unknown, OUTSIDE, BUCKLING))
    return np.where(solved.ok, margins.max(axis=0), np.inf), reason, np.where(solved.ok, solved.nu, nu)
