"""The solid on shapes other than the hemisphere: discs and caps against plate, membrane and shallow-shell theory."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq
from tests.mechanics.exact_membrane import flat_at, flat_limit

from benchmarks.contact_references import POISSON, SpherePress, pressed_shell
from benchmarks.shallow_shells import ShallowShell, hencky
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, at_volume, inflate, state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure
from pneutouch.mechanics.solid.second_variation import HarmonicSolid, unstable_waves
from pneutouch.shape.disc import Disc
from pneutouch.shape.round import Cap

RATIOS = (0.3, 0.49)
"""Poisson's ratios of the discs."""

CAP_RISE, CAP_POISSON = 0.05, 1.0 / 3.0
"""Rise of the emptied caps' middle surface over the radius of its rim, and Poisson's ratio of the published curves."""


def disc(wall: float, nu: float, **cells: Any) -> SolidModel:
    """A disc of radius 1 mm with a shear modulus of 1 MPa; its cavity is so shallow that steps in volume are small."""
    return SolidModel(dome(Disc(1.0, wall, 0.03), **cells), neo_hookean(1.0, nu))


def rise(state: FreeState, solid: SolidModel) -> float:
    """Height (mm) of the middle of a disc's wall on the axis over that at its edge."""
    return 0.5 * (state.inner_apex + state.outer_apex + solid.mesh.wall)


def thickening(mesh: SolidMesh) -> SolidMesh:
    """The mesh with an edge that is held as plate theory has it: its thickness may change."""
    edge = mesh.clamped
    middle = edge[edge.size // 2 :][:1]
    return replace(mesh, clamped=edge[:0], axis=np.concatenate([mesh.axis, edge]), sliding=middle)


def bent_plate(wall: float, nu: float) -> list[float]:
    """Small deflection of a clamped plate: errors against Kirchhoff and against Reissner and Mindlin (shear factor 5/6),
    and the latter for an edge that may thicken."""
    clamped = disc(wall, nu, arc=96, through=4, base_ratio=0.1)
    freed = SolidModel(thickening(clamped.mesh), clamped.material)
    thin = 1e-3 * wall
    pressure = thin * 64.0 * 2.0 * (1.0 + nu) * wall**3 / (12.0 * (1.0 - nu**2))
    found, other = (rise(state_at(solid, pressure), solid) for solid in (clamped, freed))
    sheared = thin + pressure / (4.0 * 5.0 / 6.0 * wall)
    return [found / thin - 1.0, found / sheared - 1.0, other / sheared - 1.0]


def far_bent_plate(load: float, nu: float, wall: float = 0.01) -> list[float]:
    """Deflection over the wall by Föppl and von Kármán at p a^4/(E h^4), and the solid's error."""
    shell, solid = ShallowShell(0.0, nu, 24), disc(wall, nu)
    exact = shell.pole(shell.inflated(load))
    found = rise(state_at(solid, load * 2.0 * (1.0 + nu) * wall**4), solid)
    return [exact, found / wall / exact - 1.0]


def small_strain(wall: float, nu: float, goal: float = 0.05) -> float:
    """Error of the solid where Hencky's membrane has the deflection ``goal`` over its radius."""
    solid = disc(wall, nu)
    pressure = (goal / hencky(nu)) ** 3 * 2.0 * (1.0 + nu) * wall
    return rise(state_at(solid, pressure), solid) / goal - 1.0


def inflated_membrane(wall: float, arc: int | None) -> dict[str, Any]:
    """A disc far inflated: the errors of p a/(mu t0) and height at the limit point, and states by their height over the
    radius, with the exact pressure and the solid's error. Flatter ones, in which the wall still bends, are left out."""
    solid = disc(wall, 0.4999, arc=arc)
    run = inflate(solid, past_limit=1.6)
    assert run.limit is not None
    ends = zip((run.limit.pressure / wall, rise(run.limit, solid)), flat_limit(), strict=True)
    known = [(state.pressure / wall, rise(state, solid)) for state in run.states]
    rows = [[high, exact := flat_at(high), found / exact - 1.0] for found, high in known if high > 0.25]
    limit = [found / exact - 1.0 for found, exact in ends]
    return {"wall": wall, "cells": len(solid.mesh.outer), "limit": limit, "rows": rows}


def shallow_cap(slope: float) -> tuple[SolidModel, float]:
    """A cap by its lambda, with a rim of 1 mm radius in the middle of the wall, and its classical buckling pressure, MPa."""
    nu, root = CAP_POISSON, np.sqrt(3.0 * (1.0 - CAP_POISSON**2))
    wall, radius = CAP_RISE * 4.0 * root / slope**2, (1.0 + CAP_RISE**2) / (2.0 * CAP_RISE)
    inside = 1.0 - 0.5 * wall / radius
    solid = SolidModel(dome(Cap(inside, wall, CAP_RISE * inside)), neo_hookean(1.0, nu))
    return solid, float(4.0 * (1.0 + nu) * wall**2 / (radius**2 * root))


def emptied_cap(slope: float) -> dict[int, float]:
    """Outside pressures over the classical one at which the solid's cap loses its stability, by waves around the axis:
    0, the limit point of its round form, and 2 to 8 before it."""
    solid, classical = shallow_cap(slope)
    run = inflate(solid, to_pressure=-3.0 * classical)
    assert run.limit is not None
    lost = {0: -run.limit.pressure, **{n: _lost(solid, run, n) for n in range(2, 9)}}
    return {n: pressure / classical for n, pressure in lost.items() if np.isfinite(pressure)}


def _lost(solid: SolidModel, run: Inflation, n: int) -> float:
    """Outside pressure (MPa) at which a path becomes unstable to ``n`` waves; inf if it does not."""
    harmonic = HarmonicSolid(solid)
    states = {state.unit.volume: state for state in run.states}

    def sign(volume: float) -> float:
        state = states.get(volume) or at_volume(solid, list(pair), volume)
        assert not isinstance(state, NewtonFailure)
        states[volume] = state
        return -1.0 if unstable_waves(harmonic, state.unit, (n,)) else 1.0

    for pair in pairwise(run.states):
        if sign(pair[1].unit.volume) < 0.0:
            return -states[brentq(sign, *(state.unit.volume for state in pair), rtol=1e-7)].pressure
    return np.inf


def snapped_cap(slope: float) -> dict[str, Any]:
    """Outside pressures over the classical one, by theory and by the solid: at the limit point and where the cap first
    loses its stability, to that many waves; and the greatest difference over all waves."""
    root = np.sqrt(3.0 * (1.0 - CAP_POISSON**2))
    high = slope**2 / (4.0 * root)
    found = ShallowShell(high, CAP_POISSON, 20).buckling()
    theory, solid = {n: float(value * root / (8.0 * high**2)) for n, value in found.items()}, emptied_cap(slope)
    first = [min(one, key=one.__getitem__) for one in (theory, solid)]
    return {
        "lambda": slope,
        "limit": [theory[0], float(solid[0])],
        "waves": first,
        "first": [theory[first[0]], float(solid[first[1]])],
        "greatest": float(max(abs(solid[n] / theory[n] - 1.0) for n in theory)),
    }


def pressed_cap(ratio: float, angle: float = 0.8) -> SpherePress:
    """A cap of a sphere of 1 mm, up to an angle from the pole (rad), under a small ball at no pressure."""
    inner = 1.0 - 0.5 * ratio
    cap = Cap(inner * np.sin(angle), ratio, inner * (1.0 - np.cos(angle)))
    mesh = dome(cap, arc=96, through=2, base_ratio=20.0)
    return pressed_shell(SolidModel(mesh, neo_hookean(1.0, POISSON)), ratio, 0.0)


def shapes() -> dict[str, Any]:
    """All comparisons: errors by Poisson's ratio and wall or load, pressures of membrane and caps."""
    caps = [(ratio, pressed_cap(ratio)) for ratio in (0.01, 0.005, 0.0025)]
    return {
        "plates": [[nu, wall, *bent_plate(wall, nu)] for nu in RATIOS for wall in (0.1, 0.05, 0.02, 0.01)],
        "far_bent": [[nu, load, *far_bent_plate(load, nu)] for nu in RATIOS for load in (1.0, 10.0, 100.0, 1000.0)],
        "hencky": [[nu, wall, small_strain(wall, nu)] for nu in RATIOS for wall in (0.002, 0.001)],
        "flat": [inflated_membrane(wall, arc) for wall in (0.02, 0.01, 0.005) for arc in (None, 96)],
        "cap_ball": [[ratio, one.value / one.thin - 1, one.value / one.sheared - 1] for ratio, one in caps],
        "snaps": [snapped_cap(slope) for slope in (4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0)],
    }
