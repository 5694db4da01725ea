"""Reading of a pad: from the pressure rises of its cells to force and place, and to what touches it.

One touched cell cannot tell a small ball in its middle from a large one beside it: what is known after a reading is no
ellipse around one best answer. So a reading is compared with many random contacts; the nearest of them are each moved
by a few steps of least squares until they explain it, and then stand for all that explain it (approximate Bayesian
computation with adjustment, Beaumont et al. 2002, doi 10.1093/genetics/162.4.2025, by randomised maximum likelihood).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.mechanics.touch.cell import TABLE_ERROR, TILTS
from pneutouch.mechanics.touch.forward import ObjectKind, PadAnswer, PadModel

KINDS: tuple[ObjectKind, ...] = ("ball", "plate")
_KNOWN = 20_000
"""Number of random contacts of each kind."""
_SEED = 0
"""Seed of the random contacts and of the noise of their copies: the same readings give the same answer."""
_MEMBERS = 96
"""Number of them that stand for a reading."""
_ITERATIONS = 12
"""Steps by which each is adjusted."""
_BATCH = 64
"""Readings that are read together, which bounds the memory."""
_STEP = 1e-3
"""Step of the differences by which derivatives are taken, in spreads of each parameter."""
_MISFIT = 5.0
"""Greatest mean square of the residuals by cell, in standard deviations, of an object that explains a reading: of three
cells or more, chance exceeds it in less than 0.2 %."""
_FEWEST, _HEATINGS = 8, 20
"""Number of members that count at least, and of doublings of the cost at which the others begin to count."""
_SURE = 0.95
"""Probability from which a kind of object is named."""
_JUDGED, _MENDED = 20, 0.8
"""Number of readings by which a fault is looked for, and the share of them that it has to explain."""
_TOUCHED = 4.0
"""Rise in standard deviations of the gauge from which a cell counts as touched."""


class PadReading(NamedTuple):
    """m readings of a pad: what touches it (m,): ``none``, ``ball``, ``plate``, ``either`` where readings tell them not
    apart, ``outside`` where neither explains them or a cell is beyond its range. Force with its standard uncertainty
    (m,), N; centre of the force (m, 2), as in `PadAnswer`, with its covariance (m, 2, 2), mm; curvature of the object
    with its standard uncertainty (m,), 1/mm. NaN where it is not known."""

    kind: Array
    force: Array
    force_uncertainty: Array
    centre: Array
    centre_covariance: Array
    curvature: Array
    curvature_uncertainty: Array


@dataclass(frozen=True)
class PadReader:
    """Reader of a pad. ``noise`` is the standard deviation of a gauge, MPa; ``model_error`` that of the forward model
    over the greatest rise of a reading; ``used`` (n,) is False for a cell that is left out, None: all are used."""

    model: PadModel
    noise: float
    model_error: float = TABLE_ERROR / 3.0
    used: Flags | None = None

    def read(self, rise: Array) -> PadReading:
        """Read pressure rises (m, n), MPa."""
        rise = np.atleast_2d(rise)
        parts = [self._batch(rise[k : k + _BATCH]) for k in range(0, len(rise), _BATCH)]
        return PadReading(*(np.concatenate(part) for part in zip(*parts, strict=True)))

    def without(self, cells: Sequence[int]) -> "PadReader":
        """The reader with cells, by their numbers from 0, left out too; it shares the random contacts."""
        used = np.isin(np.arange(len(self.model.places)), np.setdiff1d(self.cells, cells))
        other = replace(self, used=used)
        other.__dict__["_known"] = self._known
        return other

    @cached_property
    def cells(self) -> Indices:
        """Numbers of the cells that are used, from 0."""
        count = len(self.model.places)
        return np.arange(count) if self.used is None else np.flatnonzero(self.used)

    def _batch(self, rise: Array) -> PadReading:
        rise, count = rise[:, self.cells], len(rise)
        deviation = np.hypot(self.noise, self.model_error * rise.max(axis=1))
        touched = rise.max(axis=1) > _TOUCHED * self.noise
        nearest = self._nearest(rise)
        random = np.random.default_rng(_SEED)
        noisy = rise[:, None] + deviation[:, None, None] * random.standard_normal((count, _MEMBERS, rise.shape[1]))
        out = np.full((count, _MEMBERS, 6), np.nan)
        balls = nearest < _KNOWN
        for kind, of_kind in zip(KINDS, (balls, ~balls), strict=True):
            if not of_kind.any():
                continue
            which, member = np.nonzero(of_kind)
            start = self._known[kind][0][nearest[which, member] % _KNOWN]
            fitted = self._adjusted(kind, start, noisy[which, member], deviation[which])
            answer = answer_of(self.model, kind, fitted)
            square = np.square((answer.rise[:, self.cells] - rise[which]) / deviation[which, None]).sum(axis=1)
            bend = fitted[:, 2] if kind == "ball" else np.zeros(len(fitted))
            out[which, member] = np.column_stack([square, answer.force, answer.centre, bend, answer.inside])
        return self._told(out, balls, touched)

    def _told(self, members: Array, balls: Flags, touched: Flags) -> PadReading:
        square = members[..., 0]
        # A member explains its own noisy copy of the reading: against the reading itself its square has the scatter of
        # the noise, and only what exceeds that by far counts against it.
        free = len(self.cells)
        weight = _weights(0.5 * np.maximum(square - square.min(axis=1, keepdims=True) - 4.0 * free, 0.0))
        share = (weight * balls).sum(axis=1)
        likely = np.where(share > _SURE, "ball", np.where(share < 1.0 - _SURE, "plate", "either"))
        inside = (weight * members[..., 5]).sum(axis=1) > 1.0 - _SURE
        explained = (square.min(axis=1) <= _MISFIT * free) & inside
        kind = np.where(touched, np.where(explained, likely, "outside"), "none")
        mean = np.einsum("mk,mkc->mc", weight, members)
        away = members - mean[:, None]
        spread = np.einsum("mk,mkc,mkd->mcd", weight, away, away)
        known, none = touched & explained, kind == "none"
        bend, of_bend = mean[:, 4] / self.model.table.radius, np.sqrt(spread[:, 4, 4]) / self.model.table.radius
        return PadReading(
            kind,
            np.where(known, mean[:, 1], np.where(none, 0.0, np.nan)),
            np.where(known, np.sqrt(spread[:, 1, 1]), np.where(none, 0.0, np.nan)),
            np.where(known[:, None], mean[:, 2:4], np.nan),
            np.where(known[:, None, None], spread[:, 2:4, 2:4], np.nan),
            np.where(known, bend, np.nan),
            np.where(known, of_bend, np.nan),
        )

    def _nearest(self, rise: Array) -> Indices:
        """Numbers (m, `_MEMBERS`) of the random contacts nearest to readings, those of plates after those of balls.

        Rises count by their logarithm where they are above the noise: which cells are touched decides."""
        known = np.concatenate([self._known[kind][1] for kind in KINDS])[:, self.cells]
        unit = _TOUCHED * self.noise
        known, rise = np.arcsinh(known / unit), np.arcsinh(rise / unit)
        squares = np.square(known).sum(axis=1)
        nearest = np.empty((len(rise), _MEMBERS), dtype=np.intp)
        for k, reading in enumerate(rise):
            nearest[k] = np.argpartition(squares - 2.0 * (known @ reading), _MEMBERS)[:_MEMBERS]
        return nearest

    @cached_property
    def _known(self) -> dict[ObjectKind, tuple[Array, Array]]:
        """Parameters (`_KNOWN`, k) and rises (`_KNOWN`, n) of random contacts of each kind."""
        random = np.random.default_rng(_SEED)
        out: dict[ObjectKind, tuple[Array, Array]] = {}
        for kind in KINDS:
            drawn = random_objects(self.model, kind, _KNOWN, random)
            out[kind] = drawn, answer_of(self.model, kind, drawn).rise
        return out

    def _adjusted(self, kind: ObjectKind, start: Array, rise: Array, deviation: Array) -> Array:
        """Parameters (m, k) near to ``start`` that explain ``rise``, by damped steps of least squares; what is known
        beforehand holds each at its start."""
        spread = self._known[kind][0].std(axis=0)
        at, damping = start.copy(), np.full(len(start), 1e-2)
        residual = self._residual(kind, at, start, spread, rise, deviation)
        for _ in range(_ITERATIONS):
            jacobian = self._derivatives(kind, at, spread, deviation)
            normal = np.einsum("mni,mnj->mij", jacobian, jacobian)
            slope = np.einsum("mni,mn->mi", jacobian, residual)
            scale = np.einsum("mii->mi", normal)[:, :, None] * np.eye(at.shape[1])
            step = -np.linalg.solve(normal + damping[:, None, None] * scale, slope[..., None])[..., 0]
            tried = at + np.clip(step, -0.5 * spread, 0.5 * spread)
            new = self._residual(kind, tried, start, spread, rise, deviation)
            gained = (new**2).sum(axis=1) < (residual**2).sum(axis=1)
            at[gained], residual[gained] = tried[gained], new[gained]
            damping = np.where(gained, 0.2 * damping, 5.0 * damping)
        return at

    def _residual(
        self, kind: ObjectKind, at: Array, start: Array, spread: Array, rise: Array, deviation: Array
    ) -> Array:
        found = answer_of(self.model, kind, at).rise[:, self.cells]
        return np.hstack([(found - rise) / deviation[:, None], (at - start) / spread])

    def _derivatives(self, kind: ObjectKind, at: Array, spread: Array, deviation: Array) -> Array:
        """Derivatives (m, n used + k, k) of the residuals, by central differences."""
        steps, count = _STEP * spread, at.shape[1]
        both = np.concatenate([at + sign * step for step in np.diag(steps) for sign in (1.0, -1.0)])
        ends = answer_of(self.model, kind, both).rise[:, self.cells].reshape(count, 2, len(at), -1)
        slopes = np.moveaxis((ends[:, 0] - ends[:, 1]) / (2.0 * steps[:, None, None]), 0, -1)
        known = np.broadcast_to(np.diag(1.0 / spread), (len(at), count, count))
        return np.concatenate([slopes / deviation[:, None, None], known], axis=1)


class PadFault(NamedTuple):
    """A fault that explains readings which no object explains: cells ``lost`` or ``swapped``, by their numbers from 0,
    and the share of the readings that are explained with it and as they are."""

    kind: Literal["none", "lost", "swapped", "unknown"]
    cells: tuple[int, ...]
    explained: float
    before: float


def find_fault(reader: PadReader, rise: Array) -> PadFault:
    """The lost cell or the two swapped channels that explain readings (m, n), of which the `_JUDGED` loudest count.

    ``none`` where they are explained as they are, ``unknown`` where no single fault explains them."""
    loud = rise[np.argsort(rise.sum(axis=1))[::-1][:_JUDGED]]
    before = _explained(reader, loud)
    if before >= _SURE:
        return PadFault("none", (), before, before)
    swaps = list(combinations(range(rise.shape[1]), 2))
    found = []
    for one, other in swaps:
        turned = loud.copy()
        turned[:, [one, other]] = loud[:, [other, one]]
        found.append(PadFault("swapped", (one, other), _explained(reader, turned), before))
    # A reading without one cell is explained more easily: of equals a swap is the fault.
    lost = [PadFault("lost", (k,), _explained(reader.without([k]), loud), before) for k in range(rise.shape[1])]
    best = max([*found, *lost], key=lambda fault: fault.explained)
    return best if best.explained >= max(_MENDED, before + 0.2) else PadFault("unknown", (), before, before)


def _explained(reader: PadReader, rise: Array) -> float:
    """Share of readings that an object explains."""
    return float((reader.read(rise).kind != "outside").mean())


def _weights(cost: Array) -> Array:
    """Weights (m, k) of members by their costs, of which so few that none has a spread count the others too."""
    heat = np.ones((len(cost), 1))
    for _ in range(_HEATINGS):
        weight = np.exp(-cost / heat)
        weight /= weight.sum(axis=1, keepdims=True)
        heat[np.square(weight).sum(axis=1) > 1.0 / _FEWEST] *= 2.0
    return np.asarray(weight)


def answer_of(model: PadModel, kind: ObjectKind, parameters: Array) -> PadAnswer:
    """Answers of a pad to objects: of a ball its place x, y (mm), its curvature in 1/R0 and its depth (mm), (m, 4); of
    a plate its slopes along x and y and its depth, (m, 3)."""
    if kind == "plate":
        return model.under_plates(parameters[:, :2], parameters[:, 2])
    low, high = (model.table.radius / size for size in model.radii)
    radius = model.table.radius / np.clip(parameters[:, 2], high, low)
    return model.under_balls(parameters[:, :2], radius, parameters[:, 3])


def random_objects(model: PadModel, kind: ObjectKind, count: int, random: np.random.Generator) -> Array:
    """Parameters (count, k) of random objects within the range of every cell and touching one: balls of any curvature
    of the table with their axis anywhere over the pad, plates of any slope of the table, at any depth."""
    kept, size = [], 0
    low, high = model.radii
    reach = model.table.outer + np.abs(model.places).max(axis=0)
    while size < count:
        depth = random.uniform(0.0, 1.6 * model.table.depth, count)
        if kind == "ball":
            bend = model.table.radius * random.uniform(1.0 / high, 1.0 / low, count)
            drawn = np.column_stack([random.uniform(-reach, reach, (count, 2)), bend, depth])
        else:
            steepest = TILTS[-1] / np.sqrt(1.0 - TILTS[-1] ** 2)
            turn, slope = random.uniform(0.0, 2.0 * np.pi, count), steepest * np.sqrt(random.uniform(0.0, 1.0, count))
            drawn = np.column_stack([slope * np.cos(turn), slope * np.sin(turn), depth])
        drawn = drawn[answer_of(model, kind, drawn).inside]
        kept.append(drawn)
        size += len(drawn)
    return np.concatenate(kept)[:count]
