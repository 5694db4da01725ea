"""A pad's campaign read, and its prediction fitted to it: one factor for forces, one for the readings of each cell."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import least_squares, linear_sum_assignment
from scipy.sparse import lil_array

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.errors import InputError
from pneutouch.mechanics.touch.forward import PadAnswer, PadModel
from pneutouch.mechanics.touch.objects import random_objects
from pneutouch.mechanics.touch.reader_table import reader_table
from pneutouch.output.files import digest
from pneutouch.spec.files import is_file
from pneutouch.spec.pad import PAD_CAMPAIGN, PadCalibration, PadCampaign, PadRun, channels
from pneutouch.spec.read import parse_changes, read_toml, validate
from pneutouch.tables.read import whole
from pneutouch.units import KPA
from pneutouch.workflows.pad.campaign import noise_kPa
from pneutouch.workflows.pad.fault import PadFault, find_fault
from pneutouch.workflows.pad.load import ResolvedPad, load_pad
from pneutouch.workflows.pad.touch import Tabulate, pad_model

_MOST = 120
"""Number of readings of a run that are fitted, in equal steps over those with contact."""
_CONTACT = 4.0
"""Force over the resolution of its sensor from which there is contact."""
_ERROR, _PRIOR = 0.02, (0.4, 0.2, 1.0)
"""Error of a prediction assumed at first, over the greatest of a reading; and standard deviations before the fit of the
logarithms of the factors of force and rise, and of the stage's zero, mm."""
_CLEAR, _POOR, _LOST = 0.15, 0.08, 0.5
"""Gain in correlation by which channels count as swapped, remaining error from which a fault is looked for, and factor
of a cell over that of the others below which it is lost."""
_FARTHEST, _UNEXPLAINED = 3.0, 0.3
"""Factor of force or rise, up or down, and remaining error, from which readings are refused."""
_STARTS, _NOISES = 20_000, 1.2
"""Number of random balls among which a fit by hand starts; and variance of a reading less its zero, the mean of five,
over that of a reading."""


class PadReadings(NamedTuple):
    """m readings in contact: pressure rises (m, n), MPa; forces (m,), N; places x, y and depths (m, 3), mm, which are
    not numbers by hand."""

    rise: Array
    force: Array
    place: Array

    @property
    def by_hand(self) -> Flags:
        """True (m,) for a reading whose place is not known."""
        return np.isnan(self.place[:, 0])


class MeasuredPad(NamedTuple):
    """A campaign read: its folder, its file, its pad, the forward model, readings, and their digest."""

    folder: Path
    campaign: PadCampaign
    pad: ResolvedPad
    model: PadModel
    readings: PadReadings
    digest: str


class PadFit(NamedTuple):
    """A pad in hand over its prediction: factors of force and of rises (n,) with standard uncertainties, zero
    of the stage (3,), mm; errors left, root mean squares over those: of rises over the greatest of a reading, and of
    forces."""

    force_factor: float
    of_force_factor: float
    rise_factors: Array
    of_rise_factors: Array
    shift: Array
    rise_error: float
    force_error: float


def is_pad_campaign(path: Path) -> bool:
    """True for the folder of a pad's campaign, or its file."""
    return path.name == PAD_CAMPAIGN or is_file(path / PAD_CAMPAIGN)


def read_campaign(path: Path, made_by: Tabulate | None = None) -> MeasuredPad:
    """The campaign of a folder, or of its file. Raises InputError for what cannot be read or is not of this pad."""
    file = path if path.name == PAD_CAMPAIGN else path / PAD_CAMPAIGN
    campaign: PadCampaign = validate(PadCampaign, read_toml(file), str(file))
    pad = load_pad(campaign.pad, parse_changes(campaign.assignments))
    model = pad_model(pad, campaign.driving_pressure_kPa, made_by)
    if not model.radii[0] <= campaign.ball_radius_mm <= model.radii[1]:
        remedy = "give {:.3g} to {:.4g} mm".format(*model.radii)
        raise InputError("not tabulated", file=file, key="ball_radius_mm", value=campaign.ball_radius_mm, remedy=remedy)
    parts = [_run(file.parent / run.file, run, campaign, len(model.places)) for run in campaign.runs]
    readings = PadReadings(*(np.concatenate(part) for part in zip(*parts, strict=True)))
    whole_digest = digest(b"".join((file.parent / run.file).read_bytes() for run in campaign.runs))
    return MeasuredPad(file.parent, campaign, pad, model, readings, whole_digest)


def _run(path: Path, run: PadRun, campaign: PadCampaign, count: int) -> PadReadings:
    """Readings of one recording in contact, less the pressures without contact before and after each."""
    placed = run.kind == "stage"
    names = [*(("x_mm", "y_mm", "depth_mm") if placed else ()), "force_N", *channels(count)]
    rows, columns = whole(path, names)
    force, *cells_kPa = columns[3 * placed :]
    pressures = KPA * np.array(cells_kPa)
    touched = force > _CONTACT * campaign.force_resolution_N
    if placed:
        touched &= columns[2] > 0.0
    free = np.abs(force) <= _CONTACT * campaign.force_resolution_N
    if not free.any() or not touched.any():
        what = "without contact" if touched.any() else "in contact"
        remedy = "record some before the first press, after the last, and between" if touched.any() else None
        raise InputError(f"no readings {what}", file=path, key="force_N", remedy=remedy)
    kept = np.flatnonzero(touched)
    kept = kept[np.unique(np.linspace(0, kept.size - 1, _MOST).astype(np.intp))]
    zero = [np.interp(rows[kept], rows[free], _smooth(cell[free])) for cell in pressures]
    place = columns[:3, kept].T if placed else np.full((kept.size, 3), np.nan)
    return PadReadings((pressures[:, kept] - zero).T, force[kept], place)


def _smooth(values: Array, width: int = 5) -> Array:
    """Means of as many readings around each, at the ends of those that there are."""
    width = min(width, values.size)
    edge = np.pad(values, width // 2, mode="edge")
    return np.convolve(edge, np.full(width, 1.0 / width), mode="valid")[: values.size]


def fitted(measured: MeasuredPad) -> PadFit:
    """Fit the factors, and the places of presses by hand. Raises InputError for swapped channels, naming them."""
    _check_order(measured)
    model, readings, campaign = measured.model, measured.readings, measured.campaign
    fit = _Fit(model, readings, campaign.ball_radius_mm, noise_kPa(measured.pad) * KPA, campaign.force_resolution_N)
    found = least_squares(
        fit.residuals, fit.start, jac_sparsity=fit.sparsity, x_scale=fit.scale, max_nfev=60, ftol=1e-6
    )
    jacobian = found.jac.toarray() if hasattr(found.jac, "toarray") else found.jac
    free = max(readings.rise.size + readings.force.size - found.x.size, 1)
    square = max(2.0 * found.cost / free, 1e-6)
    inverse = fit.scale[:, None] * np.linalg.pinv(jacobian * fit.scale)
    spread = np.linalg.norm(inverse, axis=1) * max(square, 1.0) ** 0.5
    count = len(model.places)
    factors, of_factors = np.exp(found.x[: 1 + count]), spread[: 1 + count] * np.exp(found.x[: 1 + count])
    answer = fit.answer(found.x)
    off = answer.rise * factors[1:] - readings.rise
    # Of loud readings most is told, and of all the noise is not the prediction's.
    share = (readings.rise.size + readings.force.size) / free
    left = share * np.square(off).mean() - _NOISES * fit.noise**2
    rise_error = float(np.sqrt(max(left, 0.0) / np.square(readings.rise.max(axis=1)).mean()))
    off_N = answer.force * factors[0] - readings.force
    force_error = float(np.sqrt(np.square(off_N).mean() / np.square(readings.force).mean()))
    if rise_error > _POOR or factors[1:].min() < _LOST * np.median(factors[1:]):
        _check_fault(measured, np.flatnonzero(factors[1:] < _LOST * np.median(factors[1:])) + 1)
    _check_sizes(measured, float(factors[0]), float(np.median(factors[1:])), rise_error)
    (force, *_), (of_force, *_), shift = factors.tolist(), of_factors.tolist(), found.x[1 + count : 4 + count]
    return PadFit(force, of_force, factors[1:], of_factors[1:], shift, rise_error, force_error)


def _check_order(measured: MeasuredPad) -> None:
    """Raise InputError if the pressures of a stage's presses are those of other cells than their names say."""
    readings, placed = measured.readings, ~measured.readings.by_hand
    if placed.sum() < 2 * len(measured.model.places):
        return
    radius = np.full(placed.sum(), measured.campaign.ball_radius_mm)
    expected = measured.model.under_balls(readings.place[placed, :2], radius, readings.place[placed, 2]).rise
    alike = np.nan_to_num(_correlations(readings.rise[placed], expected))
    _, order = linear_sum_assignment(-alike)
    wrong = [k for k in range(len(order)) if order[k] != k and alike[k, order[k]] > alike[k, k] + _CLEAR]
    if wrong:
        names = channels(len(order))
        pairs = ", ".join(f"{names[k]} reads cell {order[k] + 1}" for k in wrong)
        remedy = "give each column the number of the cell that it reads"
        raise InputError(f"swapped: {pairs}", file=measured.folder / PAD_CAMPAIGN, key=names[wrong[0]], remedy=remedy)


def _correlations(one: Array, other: Array) -> Array:
    """Correlations (n, n) of the columns of two tables (m, n)."""
    parts = [(part - part.mean(axis=0)) / np.maximum(part.std(axis=0), 1e-12) for part in (one, other)]
    return np.asarray(parts[0].T @ parts[1] / len(one))


def _check_fault(measured: MeasuredPad, silent: Indices) -> None:
    """Raise InputError for cells that are ``silent``, by their numbers from 1; and if a lost cell or swapped channels
    explain readings that the prediction does not."""
    table = reader_table(measured.model, noise_kPa(measured.pad), _POOR)
    lost = PadFault("lost", tuple(silent.tolist()), 1.0)
    fault = lost if silent.size else find_fault(table, measured.readings.rise / KPA)
    if fault.kind in ("lost", "swapped"):
        names = [channels(len(measured.model.places))[k - 1] for k in fault.cells]
        problem = "the cell leaks or is clogged" if fault.kind == "lost" else f"swapped with {names[-1]}"
        remedy = "mend it, or leave it out of the reader" if fault.kind == "lost" else "exchange the two columns"
        raise InputError(problem, file=measured.folder / PAD_CAMPAIGN, key=names[0], remedy=remedy)


def _check_sizes(measured: MeasuredPad, force: float, rise: float, rise_error: float) -> None:
    """Raise InputError for forces or rises so far from the predicted ones that they are not those of this pad, or of
    which the prediction leaves most unexplained."""
    file, first = measured.folder / PAD_CAMPAIGN, channels(1)[0]
    for key, factor, unit in (("force_N", force, "N"), (first, rise, "kPa")):
        if not 1.0 / _FARTHEST < factor < _FARTHEST:
            problem = f"{factor:.3g} times what is predicted, in every cell"
            raise InputError(problem, file=file, key=key, remedy=f"give it in {unit}, and the pad, resin and ball used")
    if rise_error > _UNEXPLAINED:
        problem = (
            f"{rise_error:.0%} of the rises are not explained by a ball of {measured.campaign.ball_radius_mm:g} mm"
        )
        raise InputError(problem, file=file, key=first, remedy="check the places, the depth's sign, and the ball")


class _Fit:
    """Residuals of a fit. Parameters: logarithms of the factors of force and of each rise, zero of the stage x, y, z,
    and place and depth of each press by hand."""

    def __init__(self, model: PadModel, readings: PadReadings, radius: float, noise: float, resolution: float) -> None:
        self.model, self.readings, self.radius = model, readings, np.full(len(readings.force), radius)
        self.noise = noise
        self.of_rise = np.hypot(noise, _ERROR * readings.rise.max(axis=1, keepdims=True))
        self.of_force = np.hypot(resolution, _ERROR * readings.force)
        self.hand = np.flatnonzero(readings.by_hand)
        self.count = len(model.places)
        spread = [_PRIOR[0], *[_PRIOR[1]] * self.count, *[_PRIOR[2]] * 3]
        self.start = np.concatenate([np.zeros(len(spread)), self._places().ravel()])
        self.scale = np.concatenate([spread, np.full(self.start.size - len(spread), 0.3)])
        self.spread = np.array(spread)

    def _places(self) -> Array:
        """Places from which the fit of presses by hand starts: those of random balls that read most alike."""
        random = random_objects(self.model, "ball", _STARTS, np.random.default_rng(0))
        known = self.model.under_balls(random[:, :2], np.full(_STARTS, self.radius[0]), random[:, 3])
        at = [self.hand]
        distances = [
            np.square((known.rise - rise) / max(rise.max(), self.noise)).sum(axis=1)
            + np.square(known.force / force - 1.0) / self.count
            for rise, force in zip(self.readings.rise[*at], self.readings.force[*at], strict=True)
        ]
        return random[[int(one.argmin()) for one in distances]][:, [0, 1, 3]]

    def answer(self, at: Array) -> PadAnswer:
        """The prediction at the places of the parameters ``at``."""
        place = self.readings.place + at[1 + self.count : 4 + self.count]
        place[self.hand] = at[4 + self.count :].reshape(-1, 3)
        return self.model.under_balls(place[:, :2], self.radius, place[:, 2])

    def residuals(self, at: Array) -> Array:
        """Residuals in standard deviations, of rises, of forces, and of what is known before."""
        answer = self.answer(at)
        rises = (answer.rise * np.exp(at[1 : 1 + self.count]) - self.readings.rise) / self.of_rise
        forces = (answer.force * np.exp(at[0]) - self.readings.force) / self.of_force
        return np.concatenate([rises.ravel(), forces, at[: self.spread.size] / self.spread])

    @property
    def sparsity(self) -> Any:
        """The parameters that each residual depends on; None where all places are known."""
        if not self.hand.size:
            return None
        rows, fixed = len(self.readings.force), self.spread.size
        pattern = lil_array((rows * (self.count + 1) + fixed, self.start.size), dtype=np.int8)
        pattern[:, :fixed] = 1
        for k, row in enumerate(self.hand):
            columns = slice(fixed + 3 * k, fixed + 3 * k + 3)
            pattern[row * self.count : (row + 1) * self.count, columns] = 1
            pattern[rows * self.count + row, columns] = 1
        return pattern


def calibration_of(measured: MeasuredPad, fit: PadFit) -> PadCalibration:
    """The calibration of a pad by a fit."""
    return PadCalibration(
        pad=measured.pad.name,
        places_mm=np.round(measured.model.places, 6).tolist(),
        groups=measured.pad.file.pad.groups,
        driving_pressure_kPa=measured.campaign.driving_pressure_kPa,
        force_factor=fit.force_factor,
        force_factor_uncertainty=fit.of_force_factor,
        rise_factors=fit.rise_factors.tolist(),
        rise_factor_uncertainties=fit.of_rise_factors.tolist(),
        model_error=fit.rise_error,
        readings=len(measured.readings.force),
        simulated=measured.campaign.simulated,
        digest=measured.digest,
    )
