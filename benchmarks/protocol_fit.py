"""What Table S1 says of the protocol: a Bayesian fit of the unknowns that one rig and seven resins share.

``python -m benchmarks.protocol_fit`` (ten minutes of processor time) writes docs/background/protocol.json from the curves
of `benchmarks.protocol`; with ``stored`` it reduces the stored draws anew.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.paper import OTHER_SOURCE, QUASI_STATIC, resins
from benchmarks.protocol import DEGREES, SOFTEST, Emulator, Reading, held_out, sensitivities
from benchmarks.store import LIBRARY, store, stored
from benchmarks.table_s1 import Assumptions, CellRow, read
from pneutouch.arrays import Array
from pneutouch.evaluation.table_s1 import PRESSURES
from pneutouch.mechanics.paper_sensor import PAPER_WALL, young_modulus

DRAWS, MOVES, KEPT = 2000, 10, 250
PRINTS = 0.066 / 1.85
"""Scatter between prints over the mean sensitivity of the resins in which it was measured (paper, Supplement E)."""


class Unknown(NamedTuple):
    """An unknown, even between two ends (on a scale of logarithms if both are factors), the default and the reason."""

    name: str
    low: float
    high: float
    default: float
    source: str
    logarithmic: bool = False

    def at(self, share: Array) -> Array:
        """Values at shares of the range."""
        if self.logarithmic:
            return self.low * (self.high / self.low) ** share
        return self.low + (self.high - self.low) * share


RESINS = resins(LIBRARY)
TITLES = [material.title for material in RESINS]
MODULI = np.array([m.shear_modulus_MPa.nominal for m in RESINS if m.shear_modulus_MPa])
NEAR = 1.25


def _resin(k: int) -> Unknown:
    modulus, name = RESINS[k].shear_modulus_MPa, f"modulus of {TITLES[k]} over the file's"
    assert modulus is not None
    if modulus.low is None or modulus.high is None:
        why = "another laboratory's prints have the paper's moduli within a quarter (hard-resins.md)"
        return Unknown(name, 1.0 / NEAR, NEAR, 1.0, why, True)
    low, high = modulus.low / modulus.nominal, modulus.high / modulus.nominal
    return Unknown(name, low, high, 1.0, "range of the resin's file", True)


UNKNOWNS = (
    Unknown("friction", 0.0, 1.0, 0.0, "not stated; as on this page"),
    Unknown("rim (0 base plane, 1 as printed)", 0.0, 1.0, 0.0, "printed on a connector: between the two"),
    Unknown("dead volume, mL", 0.0, 1.0, 0.0, "tube, valves and gauge not stated; 1 mL is 0.3 m of 2 mm bore"),
    Unknown("contact offset, mm", 0.0, 0.5, 0.0, "up to a step of 0.5 mm"),
    Unknown("growth counted as travel", 0.0, 1.0, 0.0, "z-positions from the inflated apex (0) or that at rest (1)"),
    Unknown(
        "force limit, N", 80.0, 200.0, np.inf, "actuator about 100 N, force sensor 120 N; 200 N ends no press", True
    ),
    Unknown("force over the relaxed", 1.0, 1.2, 1.0, "Agilus30 after 4 s over its relaxed modulus: 1.2", True),
    Unknown("wall, mm", 1.35, 1.65, PAPER_WALL, "printer's accuracy, at most 0.15 mm (its file)"),
    Unknown("all moduli over the files'", 0.6, 1.5, 1.0, "prints of one grade differ by this factor (TangoPlus)", True),
    *map(_resin, range(len(RESINS))),
    Unknown("model's own error", 0.005, 0.2, np.nan, "of each cell, standard deviation of the logarithm", True),
)
NAMES = [one.name for one in UNKNOWNS]
RESIN, OWN = NAMES.index("all moduli over the files'") + 1, len(UNKNOWNS) - 1
GENT = [(young_modulus(m.shore_a.nominal) / 3.0 / mu) for m, mu in zip(RESINS, MODULI, strict=True) if m.shore_a]
DEFAULTS = {k: one.default for k, one in enumerate(UNKNOWNS) if k != OWN}
TABLE = {RESIN + k: 1.0 for k in range(len(RESINS))}
HARD = {RESIN + k: GENT[k] for k, title in enumerate(TITLES) if title in QUASI_STATIC}


def _only(*free: int) -> dict[int, float]:
    """All unknowns but some at their defaults."""
    return {k: v for k, v in DEFAULTS.items() if k not in free}


FRICTION, RIM, VOLUME, OFFSET, GROWN, LIMIT, HOLD, WALL, SHARED = range(RESIN)
HYPOTHESES: dict[str, dict[int, float]] = {
    "steps of 0.5 mm, the files' moduli": _only(),
    "steps and a force limit of 100 N": _only() | {LIMIT: 100.0},
    "steps, force limit and a third of Gent's modulus for the two hard resins": _only() | {LIMIT: 100.0} | HARD,
    "third of Gent's modulus without a force limit": _only() | HARD,
    "moduli in their ranges": _only(*TABLE),
    "moduli in their ranges, force limit": _only(*TABLE, LIMIT),
    "dead volume and softer or stiffer resins": _only(VOLUME, SHARED),
    "dead volume, all moduli": _only(VOLUME, SHARED, *TABLE),
    "friction, rim, all moduli": _only(FRICTION, RIM, SHARED, *TABLE),
    "everything": {},
    "everything but friction": {FRICTION: 0.0},
    "everything but the printed rim": {RIM: 0.0},
    "everything but dead volume": {VOLUME: 0.0},
    "everything but a contact offset": {OFFSET: 0.0},
    "everything but growth as travel": {GROWN: 0.0},
    "everything, growth all travel": {GROWN: 1.0},
    "everything but a force limit": {LIMIT: np.inf},
    "everything but relaxation": {HOLD: 1.0},
    "everything but moduli": TABLE | {SHARED: 1.0},
}
"""Unknowns that are held at a value, by hypothesis; the model's own error is free in all."""


@cache
def emulator() -> Emulator:
    """That of the stored curves."""
    return Emulator(stored("protocol-curves"))


def values(shares: Array, fixed: dict[int, float]) -> Array:
    """Unknowns (n, n_unknowns) at shares (n, n_free) of the ranges of those not fixed."""
    out, free = np.empty((len(shares), len(UNKNOWNS))), iter(shares.T)
    for k, one in enumerate(UNKNOWNS):
        out[:, k] = fixed[k] if k in fixed else one.at(next(free))
    return out


def predicted(unknowns: Array) -> Array:
    """Sensitivities (n, 7, 2), kPa/N; NaN for a resin so soft that 22 kPa is near its limit pressure."""
    found = np.empty((len(unknowns), len(RESINS), len(PRESSURES)))
    rig = Reading(*(unknowns[:, k] for k in (LIMIT, OFFSET, GROWN, HOLD)))
    for k, mu in enumerate(MODULI):
        modulus = mu * unknowns[:, SHARED] * unknowns[:, RESIN + k]
        at = np.stack([modulus, unknowns[:, VOLUME], unknowns[:, FRICTION], unknowns[:, WALL]], axis=1)
        basis = emulator().basis(at)
        soft = modulus * unknowns[:, WALL] < SOFTEST * PAPER_WALL
        for j, pressure in enumerate(PRESSURES):
            with np.errstate(over="ignore"):
                found[:, k, j] = sensitivities(emulator().presses(basis, unknowns[:, RIM], pressure), pressure, rig)
        found[soft, k] = np.nan
    return found


@dataclass(frozen=True)
class Measured:
    """Table S1: sensitivities (7, 2), kPa/N, and their repeatabilities over them (7,)."""

    sensitivity: Array
    repeatability: Array


def measured() -> Measured:
    """Sensitivities of the paper, in the order of `RESINS`."""
    rows = read(stored("table-s1")["cells"])
    table = np.array([row.measured for row in rows]).reshape(-1, 2)
    return Measured(table, np.array([row.repeatability for row in rows]).reshape(-1, 2)[:, 0] / table.mean(axis=1))


def log_likelihood(off: Array, own: Array, repeatability: Array) -> Array:
    """Of logarithms of predicted over measured (n, k, 2), (n,): every cell has the model's ``own`` error (n,) and its
    repeatability (k,), both cells of a resin the scatter between prints. A missing figure is impossible."""
    each = own[:, None] ** 2 + repeatability**2
    both = each + 2.0 * PRINTS**2
    square = (off[..., 0] + off[..., 1]) ** 2 / (2.0 * both) + (off[..., 0] - off[..., 1]) ** 2 / (2.0 * each)
    logs = -0.5 * (square + np.log(each) + np.log(both)) - np.log(2.0 * np.pi)
    return np.nan_to_num(logs.sum(axis=1), nan=-np.inf)


class Sample(NamedTuple):
    """Draws (n, d) of a posterior in the unit cube, and the logarithm of the evidence."""

    shares: Array
    log_evidence: float


def sample(log_of: Callable[[Array], Array], size: int, seed: int, draws: int = DRAWS, moves: int = MOVES) -> Sample:
    """Sequential Monte Carlo from the unit cube: steps of the likelihood's exponent that leave half of the draws
    effective, a systematic resampling and Metropolis moves after each (Del Moral et al. 2006, DOI
    10.1111/j.1467-9868.2006.00553.x)."""
    random = np.random.default_rng(seed)
    at = random.random((draws, size))
    logs, power, evidence, scale = log_of(at), 0.0, 0.0, 2.38 / np.sqrt(size)
    while power < 1.0:
        step = _step(logs, 1.0 - power)
        weight = np.exp(step * (logs - logs.max()))
        evidence += float(np.log(weight.mean()) + step * logs.max())
        power += step
        chosen = np.searchsorted(np.cumsum(weight) / weight.sum(), (random.random() + np.arange(draws)) / draws)
        at, logs = at[np.minimum(chosen, draws - 1)], logs[np.minimum(chosen, draws - 1)]
        root = np.linalg.cholesky(np.atleast_2d(np.cov(at.T)) + 1e-10 * np.eye(size))
        for _ in range(moves):
            other = at + scale * random.standard_normal(at.shape) @ root.T
            other = 1.0 - np.abs(1.0 - np.mod(other, 2.0))  # Reflected at the faces of the cube.
            found = log_of(other)
            taken = np.log(random.random(draws)) < power * (found - logs)
            at[taken], logs[taken] = other[taken], found[taken]
            scale *= np.exp(taken.mean() - 0.25)
    return Sample(at, evidence)


def _step(logs: Array, most: float) -> float:
    """The exponent, up to ``most``, at which half of the draws are effective."""

    def effective(step: float) -> float:
        weight = np.exp(step * (logs - logs.max()))
        return float(weight.sum() ** 2 / (weight**2).sum())

    low, high = 0.0, most
    if effective(most) >= 0.5 * logs.size:
        return most
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if effective(middle) >= 0.5 * logs.size else (low, middle)
    return high


def fitted(name: str, left_out: int | None = None, seed: int = 1) -> Sample:
    """The posterior of a hypothesis from the whole table or without one resin."""
    fixed, table = HYPOTHESES[name], measured()
    kept = [k for k in range(len(RESINS)) if k != left_out]

    def log_of(shares: Array) -> Array:
        unknowns = values(shares, fixed)
        off = np.log(predicted(unknowns) / table.sensitivity)[:, kept]
        return log_likelihood(off, unknowns[:, OWN], table.repeatability[kept])

    return sample(log_of, len(UNKNOWNS) - len(fixed), seed)


def left_out_table(shares: Array, fixed: dict[int, float], seed: int = 2) -> Array:
    """Predicted tables (n, 7, 3) with all scatter: both sensitivities (kPa/N) and their ratio."""
    unknowns, random = values(shares, fixed), np.random.default_rng(seed)
    cells = np.log(predicted(unknowns))
    each = np.sqrt(unknowns[:, OWN, None] ** 2 + measured().repeatability ** 2)[..., None]
    cells += each * random.standard_normal(cells.shape) + PRINTS * random.standard_normal((*cells.shape[:2], 1))
    return np.exp(np.concatenate([cells, cells[..., 1:] - cells[..., :1]], axis=2))


def compute() -> dict[str, Any]:
    """All posteriors: evidences, draws of that with everything open, twice, and tables predicted for each resin left out."""
    jobs = [("everything", None, 2), *((name, None, 1) for name in reversed(HYPOTHESES))]
    jobs += [("everything", k, 1) for k in range(len(RESINS))]
    with ProcessPoolExecutor(2) as pool:
        found = dict(zip(jobs, pool.map(fitted, *zip(*jobs, strict=True)), strict=True))
    every = [found["everything", None, seed].shares for seed in (1, 2)]
    left = [left_out_table(found["everything", k, 1].shares, {})[:, k] for k in range(len(RESINS))]
    best = {name: _middle(found[name, None, 1].shares, fixed) for name, fixed in HYPOTHESES.items()}
    return {
        "evidence": {name: round(found[name, None, 1].log_evidence, 3) for name in HYPOTHESES},
        "again": round(found["everything", None, 2].log_evidence, 3),
        "errors": {name: np.round(table, 5).tolist() for name, table in best.items()},
        "draws": [np.round(draws[:: DRAWS // KEPT], 4).tolist() for draws in every],
        "left_out": [np.round(np.nanquantile(table, (0.05, 0.5, 0.95), axis=0), 5).tolist() for table in left],
    }


def _middle(shares: Array, fixed: dict[int, float]) -> Array:
    """Relative errors (7, 2) of the table in the middle of a posterior."""
    table: Array = np.median(predicted(values(shares, fixed)), axis=0) / measured().sensitivity - 1.0
    return table


def ratio_errors(errors: Array) -> Array:
    """Relative errors of S22/S0 (7,) from those of the cells (7, 2)."""
    found: Array = (1.0 + errors[:, 1]) / (1.0 + errors[:, 0]) - 1.0
    return found


def scored(errors: Array) -> dict[str, Any]:
    """Errors of cells (7, 2) and ratios: those of each ratio, medians, the worst and the goals met."""
    ratios, cells = ratio_errors(errors), np.abs(errors)
    return {
        "cells": errors.tolist(),
        "ratios": ratios.tolist(),
        "median": float(np.median(cells)),
        "worst": float(cells.max()),
        "rms": float(np.sqrt(np.mean(cells**2))),
        "ratio_rms": float(np.sqrt(np.mean(ratios**2))),
        "ratio_worst": float(np.abs(ratios).max()),
        "ratios_met": int((np.abs(ratios) <= 0.08).sum()),
    }


def open_share() -> float:
    """Standard deviation of the logarithm of a cell over the priors with the files' moduli, root mean square over the
    cells but those of FLX9995."""
    fixed = HYPOTHESES["everything but moduli"]
    shares = np.random.default_rng(3).random((DRAWS, len(UNKNOWNS) - len(fixed)))
    logs = np.log(predicted(values(shares, fixed))[:, [title != OTHER_SOURCE for title in TITLES]])
    return float(np.sqrt(np.mean(np.nanvar(logs, axis=0))))


def reduced(found: dict[str, Any]) -> dict[str, Any]:
    """What the page states."""
    first, second = (values(np.array(draws), {}) for draws in found["draws"])
    rows: list[CellRow] = read(stored("table-s1")["cells"])
    default = np.array([row.sensitivity[Assumptions()] / row.measured - 1 for row in rows]).reshape(-1, 2)
    truth = np.column_stack([measured().sensitivity, measured().sensitivity[:, 1] / measured().sensitivity[:, 0]])
    low, middle, high = np.array(found["left_out"]).transpose(1, 0, 2)
    odds = found["evidence"]
    off = held_out(emulator())
    return {
        "unknowns": [_compared(k, first[:, k], second[:, k]) for k in range(len(UNKNOWNS))],
        "hypotheses": [
            {"name": name, "log_odds": odds[name] - max(odds.values()), **scored(np.array(found["errors"][name]))}
            for name in sorted(odds, key=lambda name: -odds[name])
        ],
        "default": scored(default),
        "open_share": open_share(),
        "draws": DRAWS,
        "evidences_differ": abs(found["again"] - odds["everything"]),
        "resins": TITLES,
        "measured": truth.tolist(),
        "left_out": {"low": low.tolist(), "middle": middle.tolist(), "high": high.tolist()},
        "held": ((low <= truth) & (truth <= high)).sum(axis=0).tolist(),
        "emulator": {
            "median": float(np.median(np.abs(off))),
            "rms": float(np.sqrt(np.mean(off**2))),
            "degrees": DEGREES,
        },
    }


def _compared(k: int, first: Array, second: Array) -> dict[str, Any]:
    """Prior and posterior of an unknown, and the difference of two runs over the standard deviation."""
    one, both = UNKNOWNS[k], np.concatenate([first, second])
    prior = one.at(np.array([0.05, 0.5, 0.95]))
    return {
        "name": one.name,
        "source": one.source,
        "logarithmic": one.logarithmic,
        "prior": prior.tolist(),
        "posterior": np.quantile(both, (0.05, 0.5, 0.95)).tolist(),
        "mean": float(both.mean()),
        "runs_differ": float(abs(first.mean() - second.mean()) / both.std()),
    }


def main(*words: str) -> None:
    known = stored("protocol") if "stored" in words else compute()
    known["summary"] = reduced(known)
    store("protocol", known, None)


if __name__ == "__main__":
    main(*sys.argv[1:])
