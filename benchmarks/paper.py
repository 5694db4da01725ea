"""The models beside the paper: its Table S1, its cap of constant curvature and its choice of law. Nothing is fitted.

``python -m benchmarks.paper`` writes docs/background/paper.json, and the file that predictions read their error from.
"""

from __future__ import annotations

import json
import statistics
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from benchmarks.scenes import MOONEY_RIVLIN_AGILUS30, OGDEN_AGILUS30, PAPER
from benchmarks.store import LIBRARY, store
from pneutouch.catalogue import Library
from pneutouch.evaluation.table_s1 import PRESSURES, SHIPPED, compute_errors, fingerprint, measured
from pneutouch.mechanics import predict
from pneutouch.mechanics.laws import Hyperelastic, hyperelastic, neo_hookean
from pneutouch.mechanics.membrane import LIMIT_PRESSURE, RISING_BRANCH, limit_point_errors, relative_height
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.solid.inflate import inflate
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.spec.material import Material
from pneutouch.units import KPA, ML

METHODS = {
    "variational": ("membrane", "variational"),
    "printed": ("membrane", "printed"),
    "solid": ("solid", "variational"),
}

NU = 0.49
_CHAIN_MU, _CHAIN_LIMIT = 0.273, 9.26
"""Equilibrium network of a Bergstroem-Boyce fit to Agilus30 (same repository): eight chains, MPa and limiting stretch."""

OTHER_SOURCE = "FLX9995-DM"
"""Left out of the medians: its modulus comes from another source."""

QUASI_STATIC = ("FLX9985-DM", OTHER_SOURCE)
"""Both moduli of another source than the other five: a quasi-static E."""

_DIGITS = 8


@dataclass(frozen=True)
class Cell:
    """One cell of Table S1: measured sensitivity (kPa/N), and each method's relative error and what ended its range."""

    material: str
    pressure: float
    measured: float
    errors: dict[str, float]
    ends: str
    range_end: float

    def value(self, method: str) -> float:
        """The predicted sensitivity, kPa/N."""
        return self.measured * (1 + self.errors[method])


def resins(library: Library) -> list[Material]:
    """The resins of Table S1, softest first."""
    found = [m for m in library.all("materials", Material).values() if measured(m)]
    return sorted(found, key=lambda m: m.shear_modulus_MPa.nominal if m.shear_modulus_MPa else 0.0)


def table_s1(library: Library, dead_volume_ml: float = 0.0, flange: tuple[float, float] | None = None) -> list[Cell]:
    """All fourteen cells on the paper's sensor: plate to three quarters of R0; ``flange`` as in Sensor."""
    cells = []
    for material in resins(library):
        truth = measured(material)
        assert truth is not None
        sensor = material_sensor(material).replace(dead_volume=dead_volume_ml * ML, flange=flange)
        runs = {
            name: predict("", sensor, [p * KPA for p in PRESSURES], model=model, closure=closure).states
            for name, (model, closure) in METHODS.items()
        }
        for k, pressure in enumerate(PRESSURES):
            errors = {name: s[k].figures.sensitivity / truth[k] - 1 for name, s in runs.items() if s[k].figures}
            state = runs["solid"][k]
            ends = next((event.kind for event in state.events if event.ends_range), "depth")
            cells.append(Cell(material.title, pressure, truth[k], errors, ends, state.range_end))
    return sorted(cells, key=lambda cell: (cell.pressure, -cell.measured))


def ship_errors(library: Library) -> None:
    """Write the file that predictions with the solid read their error in sensitivity from."""
    found = {
        fingerprint(m): [None if e is None else round(e, 4) for e in compute_errors(m, "solid", "variational")]
        for m in resins(library)
    }
    SHIPPED.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def eight_chains(mu: float, limit: float) -> tuple[float, float, float]:
    """Yeoh constants of the first three terms of the eight-chain (Arruda-Boyce) energy."""
    second, third = 1 / (20 * limit**2), 11 / (1050 * limit**4)
    return mu * (0.5 + 6 * second + 27 * third), mu * (second + 9 * third), mu * third


LAWS: dict[str, Hyperelastic] = {
    "neo-Hookean": neo_hookean(1.0, NU),
    "eight chains as Yeoh (Agilus30, long-term)": hyperelastic("yeoh", eight_chains(_CHAIN_MU, _CHAIN_LIMIT), NU),
    "Ogden, one term (Agilus30, instantaneous)": hyperelastic(*OGDEN_AGILUS30, NU),
    "Mooney-Rivlin (Agilus30, instantaneous)": hyperelastic(*MOONEY_RIVLIN_AGILUS30, NU),
}


@dataclass(frozen=True)
class Curve:
    """An inflation of the paper's dome: p R0/(mu t0) over h/R0, and its limit point where there is one."""

    height: np.ndarray
    pressure: np.ndarray
    limit: tuple[float, float] | None


def curves() -> dict[str, Curve]:
    """Each law's inflation, normalised by its own small-strain modulus."""
    found = {}
    for name, law in LAWS.items():
        run = inflate(SolidModel(dome(PAPER.dome.shape), law), past_limit=1.5, largest=8.0)
        scale = PAPER.dome.inner_radius / (law.mu * PAPER.dome.wall_thickness)
        limit = (
            None if run.limit is None else (run.limit.inner_apex / PAPER.dome.inner_radius, run.limit.pressure * scale)
        )
        volume = np.linspace(run.volume[0], run.volume[-1], 200)
        height = PchipInterpolator(run.volume, [s.inner_apex for s in run.states])(volume) / PAPER.dome.inner_radius
        pressure = CubicHermiteSpline(run.volume, run.pressure, [s.stiffness for s in run.states])(volume)
        found[name] = Curve(height, pressure * scale, limit)
    return found


def medians(cells: list[Cell], *without: str) -> dict[str, float]:
    """Median absolute error of each method over the cells but those of some resins."""
    kept = [cell for cell in cells if cell.material not in without]
    return {method: statistics.median(abs(cell.errors[method]) for cell in kept) for method in METHODS}


def contact(library: Library) -> dict[str, Any]:
    """Every cell of Table S1 by every method, and medians."""
    cells = table_s1(library)
    return {
        "cells": [asdict(cell) | {"values": {method: cell.value(method) for method in METHODS}} for cell in cells],
        "median_of_twelve": medians(cells, OTHER_SOURCE),
        "median_of_fourteen": medians(cells),
        "median_of_ten": medians(cells, *QUASI_STATIC),
    }


def cap() -> dict[str, Any]:
    """The cap against the exact membrane: p R0/(mu t0), exact and cap's h/R0, and the errors at the limit point."""
    pressure, height = limit_point_errors()
    known = RISING_BRANCH[1:][RISING_BRANCH[1:, 0] <= LIMIT_PRESSURE]
    found = relative_height(known[:, 0], 1.0, 1.0, 1.0)
    return {
        "limit": RISING_BRANCH[-1].tolist(),
        "limit_errors": [pressure, height],
        "rows": [[float(p), float(h), float(x)] for (p, h), x in zip(known, found, strict=True)],
    }


def other_laws(found: dict[str, Curve]) -> list[dict[str, Any]]:
    """Each law's curve and limit point, and its greatest difference below the neo-Hookean limit, of that pressure."""
    plain = found["neo-Hookean"]
    assert plain.limit is not None
    rising = plain.height <= plain.limit[0]
    rows = []
    for name, curve in found.items():
        there = np.interp(plain.height[rising], curve.height, curve.pressure)
        differ = float(np.max(np.abs(there - plain.pressure[rising])) / plain.limit[1])
        points = {key: [float(f"{x:.{_DIGITS}g}") for x in getattr(curve, key)] for key in ("height", "pressure")}
        limit = None if curve.limit is None else [float(x) for x in curve.limit]
        rows.append({"law": name, "limit": limit, "difference": differ, **points})
    return rows


def main() -> None:
    ship_errors(LIBRARY)
    found = {"contact": contact(LIBRARY), "cap": cap(), "laws": other_laws(curves())}
    store("paper", found, None)


if __name__ == "__main__":
    main()
