"""A pad as an object: what its cells read under balls and plates, and what touches it by their readings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pneutouch.api.show import Shown, field_rows
from pneutouch.arrays import Array, Flags
from pneutouch.errors import InputError
from pneutouch.mechanics.touch.cell import TABLE_ERROR
from pneutouch.mechanics.touch.forward import PadAnswer, PadModel
from pneutouch.mechanics.touch.reader_table import reader_table
from pneutouch.mechanics.touch.resolution import resolution
from pneutouch.units import KPA
from pneutouch.workflows.pad.fault import find_fault, pad_reader
from pneutouch.workflows.pad.load import ResolvedPad
from pneutouch.workflows.pad.load import load_pad as resolved
from pneutouch.workflows.pad.touch import pad_model


@dataclass(frozen=True)
class PadContact:
    """m contacts with a pad of n cells.

    Attributes:
        pressure_rises_kPa: Pressure rise of each cell (m, n).
        forces_N: Force on each cell (m, n).
        force_N: Whole force (m,).
        centre_mm: Where the line of the whole force crosses the plane of the domes' tops, x and y (m, 2).
        inside: True where every cell is within its range and one is touched (m,).
    """

    pressure_rises_kPa: Array
    forces_N: Array
    force_N: Array
    centre_mm: Array
    inside: Flags


@dataclass(frozen=True)
class PadResolution:
    """Standard deviations for m contacts.

    Attributes:
        force_N: Of the force (m,).
        place_mm: Of the centre of the force, both directions together (m,).
    """

    force_N: Array
    place_mm: Array


@dataclass(frozen=True)
class PadEstimate:
    """Objects that touch a pad, by m readings; NaN where something is not known.

    Attributes:
        kind: ``none``, ``ball``, ``plate``, ``cylinder``, ``either`` where these cannot be told apart, ``outside``
            where none explains the readings or a cell is beyond its range (m,).
        force_N, force_uncertainty_N: Force and its standard uncertainty (m,).
        centre_mm, centre_covariance_mm2: Centre of the force as of `PadContact` (m, 2), and its covariance (m, 2, 2).
        curvature_per_mm, curvature_uncertainty_per_mm: Curvature of the object, 0 of a plate, and its standard
            uncertainty (m,).
        slope, slope_uncertainty: Slopes of a plate along x and y, and their standard uncertainties (m, 2).
        turn_deg, turn_uncertainty_deg: Angle of a cylinder's axis to x, 0 to 180, and its standard uncertainty (m,).
    """

    kind: Array
    force_N: Array
    force_uncertainty_N: Array
    centre_mm: Array
    centre_covariance_mm2: Array
    curvature_per_mm: Array
    curvature_uncertainty_per_mm: Array
    slope: Array
    slope_uncertainty: Array
    turn_deg: Array
    turn_uncertainty_deg: Array


class PadTouch(Shown):
    """A pad at one driving pressure, whose cells have been tabulated: contacts forwards and readings backwards."""

    def __init__(self, model: PadModel) -> None:
        self._model, self._table = model, lru_cache(maxsize=8)(partial(reader_table, model))

    @property
    def driving_pressure_kPa(self) -> float:
        """Driving pressure of every cell that is in no group with one of its own."""
        return self._model.table.driving_pressure / KPA

    @property
    def depth_mm(self) -> float:
        """Greatest travel of an object on one cell."""
        return self._model.depth

    @property
    def ball_radii_mm(self) -> tuple[float, float]:
        """Least and greatest radius of a ball or cylinder."""
        return self._model.radii

    def ball(self, x_mm: ArrayLike, y_mm: ArrayLike, radius_mm: ArrayLike, depth_mm: ArrayLike) -> PadContact:
        """Balls with axes at x and y, pressed until their lowest points are ``depth_mm`` below the tops of the domes;
        numbers or arrays of one length. Raises InputError for a radius beyond `ball_radii_mm`."""
        x, y, radius, depth = _columns(x_mm=x_mm, y_mm=y_mm, radius_mm=radius_mm, depth_mm=depth_mm)
        self._check(radius)
        return _contact(self._model.under_balls(np.column_stack([x, y]), radius, depth))

    def cylinder(
        self, x_mm: ArrayLike, y_mm: ArrayLike, turn_deg: ArrayLike, radius_mm: ArrayLike, depth_mm: ArrayLike
    ) -> PadContact:
        """Endless lying cylinders, or bars with edges of that radius: axes through x and y at ``turn_deg`` to x; the
        rest as of `ball`. Raises InputError for a radius beyond `ball_radii_mm`."""
        x, y, turn, radius, depth = _columns(
            x_mm=x_mm, y_mm=y_mm, turn_deg=turn_deg, radius_mm=radius_mm, depth_mm=depth_mm
        )
        self._check(radius)
        normal = np.radians(turn + 90.0)
        axis = np.column_stack([normal, x * np.cos(normal) + y * np.sin(normal)])
        return _contact(self._model.under_cylinders(axis, radius, depth))

    def plate(self, slope_x: ArrayLike, slope_y: ArrayLike, depth_mm: ArrayLike) -> PadContact:
        """Plates that rise by slopes along x and y, pressed to ``depth_mm`` below the domes' tops at x = y = 0."""
        x, y, depth = _columns(slope_x=slope_x, slope_y=slope_y, depth_mm=depth_mm)
        return _contact(self._model.under_plates(np.column_stack([x, y]), depth))

    def resolution(
        self,
        x_mm: ArrayLike,
        y_mm: ArrayLike,
        radius_mm: ArrayLike,
        depth_mm: ArrayLike,
        noise_kPa: float,
        model_error: float = TABLE_ERROR / 3.0,
    ) -> PadResolution:
        """Standard deviations of force and place that readings of balls leave, of which nothing is known but which cell
        is near: by their Fisher information."""
        x, y, radius, depth = _columns(x_mm=x_mm, y_mm=y_mm, radius_mm=radius_mm, depth_mm=depth_mm)
        balls = np.column_stack([x, y, self._model.table.radius / radius, depth])
        return PadResolution(*resolution(self._model, "ball", balls, noise_kPa * KPA, model_error))

    def read(
        self,
        pressure_rises_kPa: ArrayLike,
        noise_kPa: float,
        left_out: Iterable[int] = (),
        model_error: float = TABLE_ERROR / 3.0,
    ) -> PadEstimate:
        """Objects that touch the pad, by pressure rises (m, n) or (n,) of its cells.

        ``noise_kPa`` is the standard deviation of a gauge, ``model_error`` that of the prediction over the greatest
        rise of a reading; cells ``left_out``, by their numbers from 1, are not used. Raises InputError."""
        rises_kPa, count = np.atleast_2d(np.asarray(pressure_rises_kPa, dtype=float)), len(self._model.places)
        if rises_kPa.shape[1] != count or not np.isfinite(rises_kPa).all():
            remedy = f"give a number for each of the {count} cells, in the order of their numbers"
            raise InputError("not the readings of this pad", key="pressure_rises_kPa", value="...", remedy=remedy)
        if not noise_kPa > 0.0:
            remedy = "give the standard deviation of a gauge at rest, more than 0"
            raise InputError("no noise", key="noise_kPa", value=noise_kPa, remedy=remedy)
        numbers = sorted(set(left_out))
        if (numbers and not 1 <= numbers[0] <= numbers[-1] <= count) or len(numbers) >= count:
            raise InputError("no such cells", key="left_out", value=numbers, remedy=f"give some of 1 to {count}")
        reader = pad_reader(self._table(noise_kPa, model_error), numbers)
        contacts = [reader.read(cells_kPa) for cells_kPa in rises_kPa.tolist()]
        kind, force_N, of_force_N, *rest = map(np.array, zip(*contacts, strict=True))
        x, y, xx, xy, yy, bend, of_bend, *slopes, turn, of_turn = rest
        spread = np.stack([xx, xy, xy, yy], axis=-1).reshape(-1, 2, 2)
        lies = np.column_stack(slopes[:2]), np.column_stack(slopes[2:]), np.degrees(turn), np.degrees(of_turn)
        return PadEstimate(kind, force_N, of_force_N, np.column_stack([x, y]), spread, bend, of_bend, *lies)

    def fault(
        self, pressure_rises_kPa: ArrayLike, noise_kPa: float, model_error: float = TABLE_ERROR / 3.0
    ) -> tuple[str, tuple[int, ...]]:
        """The fault that explains why readings (m, n) of many contacts are ``outside``: ``lost`` or ``swapped``, with
        the numbers of the cells from 1; ``none``, or ``unknown``. Takes some seconds for seven cells."""
        rises_kPa = np.atleast_2d(np.asarray(pressure_rises_kPa, dtype=float))
        self.read(rises_kPa[:1], noise_kPa, (), model_error)
        found = find_fault(self._table(noise_kPa, model_error), rises_kPa)
        return found.kind, found.cells

    def _check(self, radius: Array) -> None:
        """Raise InputError for a radius that is not tabulated."""
        low, high = self.ball_radii_mm
        for value in radius[(radius < low) | (radius > high)]:
            remedy = f"give {low:.3g} to {high:.4g} mm; a larger one is a plate"
            raise InputError("is not tabulated", key="radius_mm", value=float(value), remedy=remedy)

    def _head(self) -> str:
        return f"pad of {len(self._model.places)} cells at {self.driving_pressure_kPa:g} kPa, to {self.depth_mm:.3g} mm"

    def _cells(self) -> list[Any]:
        return [[k, float(x), float(y)] for k, (x, y) in enumerate(self._model.places, start=1)]


class Pad(Shown):
    """A pad of several cells, read from its file."""

    def __init__(self, pad: ResolvedPad) -> None:
        self._pad = pad

    @property
    def name(self) -> str:
        """Name of the pad."""
        return self._pad.name

    @cached_property
    def places_mm(self) -> Array:
        """Axes of the cells, x and y (n, 2), in the order of their numbers."""
        return np.array(self._pad.layout.places)

    def touch(self, driving_pressure_kPa: float) -> PadTouch:
        """The pad at a driving pressure; takes minutes the first time. Raises InputError as `pad_model` does."""
        return PadTouch(pad_model(self._pad, driving_pressure_kPa))

    def _head(self) -> str:
        return f"pad {self.name}: {len(self.places_mm)} cells of {self._pad.file.pad.cell}"

    def _cells(self) -> list[Any]:
        return [list(row) for row in field_rows(self._pad.file)]


def load_pad(name_or_path: str | Path, **changes: Any) -> Pad:
    """A pad by its name (the user's ``designs/pads/`` first, then the shipped ones) or by its path; ``changes`` are of
    its [pad] table, such as ``pitch_mm=10``."""
    return Pad(resolved(str(name_or_path), {f"pad.{key}": value for key, value in changes.items()}))


def _columns(**given: ArrayLike) -> list[Array]:
    """Numbers or arrays as arrays of one length. Raises InputError naming the first that is none."""
    arrays = {key: np.atleast_1d(np.asarray(value, dtype=float)) for key, value in given.items()}
    count = max(map(len, arrays.values()))
    for key, values in arrays.items():
        if values.ndim != 1 or len(values) not in (1, count) or not np.isfinite(values).all():
            raise InputError("must be a number, or a list as long as the others", key=key, value="...")
    return [np.broadcast_to(values, count) for values in arrays.values()]


def _contact(answer: PadAnswer) -> PadContact:
    return PadContact(answer.rise / KPA, answer.forces, answer.force, answer.centre, answer.inside)
