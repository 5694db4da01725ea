"""A puck pressed between plates: its neo-Hookean modulus from force over compression."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.tensile.read import LEAST_POINTS, MODULI, column_pairs
from pneutouch.errors import InputError
from pneutouch.mechanics.laws.hyperelastic import first_invariant, same_invariant
from pneutouch.tables.read import layout_of, whole

_LEAST, _MOST = 0.05, 0.4
"""Compression over thickness that a test must reach, and that the fit goes up to."""

_ZEROS = np.linspace(0.0, 0.1, 101)
"""Travel before the plate touches, over the thickness."""


@dataclass(frozen=True, slots=True)
class PuckSize:
    """Diameter and thickness of a puck in mm; ``bonded`` where its faces cannot slide on the plates."""

    diameter: float
    thickness: float
    bonded: bool = False

    @property
    def stiffening(self) -> float:
        """Apparent over true modulus: 1 + 2 S^2 with S = d / (4 t) where the faces are held (Gent and Lindley, Proc.
        Inst. Mech. Eng. 173, 111-122, 1959), 1 where they slide."""
        return 1.0 + 2.0 * (self.diameter / (4.0 * self.thickness)) ** 2 if self.bonded else 1.0


@dataclass(frozen=True, slots=True)
class PuckFit:
    """Modulus in MPa, its k = 2 uncertainty by the scatter of the points, and how far the law is off.

    Attributes:
        stretch: Of the fitted points, below 1 (n,).
        stress: Their nominal stress, compression negative, MPa (n,), as of a puck whose faces slide.
        misfit: Greatest relative difference of stress where the compression is above a twentieth of the thickness.
        largest: Stretch of uniaxial tension with the greatest first invariant of the test.
        zero: Travel before the plate touched, mm.
    """

    modulus: float
    error: float
    stretch: Array
    stress: Array
    misfit: float
    largest: float
    zero: float


def fit_puck(path: Path, size: PuckSize) -> PuckFit:
    """Fit the neo-Hookean law to a file of compression (mm) and force (N), both positive as the plate goes down.

    Raises InputError for a file that cannot be read, for too few points or too little compression, and for units that
    no elastomer has.
    """
    layout = layout_of(path)
    pairs = [pair for pair in column_pairs(layout.names, layout.units, str(path)) if pair.length.kind == "travel"]
    if not pairs:
        raise InputError("no column of travel", file=path, remedy="name the columns Compression (mm), Force (N)")
    columns = whole(path, (pairs[0].length.name, pairs[0].load.name), layout)[1]
    travel, force = columns[0] * (pairs[0].length.factor or 1.0), columns[1] * (pairs[0].load.factor or 1.0)
    if (np.diff(travel) < -2e-3 * np.ptp(travel)).any():
        raise InputError("the compression falls", file=path, remedy="give the points of one loading")
    area = 0.25 * np.pi * size.diameter**2
    fits = [_fit(travel - zero * size.thickness, force / area / size.stiffening, size.thickness) for zero in _ZEROS]
    known = [(fit, float(zero)) for fit, zero in zip(fits, _ZEROS, strict=True) if fit is not None]
    if not known:
        problem = f"fewer than {LEAST_POINTS} points, or less than {100 * _LEAST:g} % of the thickness"
        raise InputError(problem, file=path, remedy="press further, to a fifth of the thickness or so")
    (modulus, error, stretch, stress, misfit), zero = min(known, key=lambda pair: pair[0][4])
    if not MODULI[0] <= modulus <= MODULI[1]:
        problem = f"force over area makes a shear modulus of {modulus:.4g} MPa; an elastomer has {MODULI[0]:g} to "
        raise InputError(f"{problem}{MODULI[1]:g} MPa", file=path, remedy="is the force in N and the travel in mm?")
    largest = float(same_invariant(first_invariant(stretch).max()))
    return PuckFit(modulus, error, stretch, stress, misfit, largest, zero * size.thickness)


def _fit(travel: Array, stress: Array, thickness: float) -> tuple[float, float, Array, Array, float] | None:
    """Modulus, twice its standard error, the points and the misfit; None if there are too few points."""
    near = (travel > 0.0) & (travel <= _MOST * thickness)
    if near.sum() < LEAST_POINTS or travel[near].max() < _LEAST * thickness:
        return None
    stretch, nominal = 1.0 - travel[near] / thickness, -stress[near]
    shape = stretch - stretch**-2
    modulus = float(shape @ nominal / (shape @ shape))
    rest = nominal - modulus * shape
    error = 2.0 * float(np.sqrt(rest @ rest / (nominal.size - 1) / (shape @ shape)))
    far = stretch < 1.0 - _LEAST
    misfit = float(np.abs(rest[far] / nominal[far]).max()) if far.any() else np.inf
    return modulus, error, stretch, nominal, misfit
