"""Sources of uncertainty of the model: its errors against the paper's Table S1, and its numerical errors.

Also those of the print and its surroundings: wall, radius, air behind the cavity, weather, driving pressure.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.errors import InputError, shown
from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.source import FIGURE, Distribution, UncertaintySource, counting
from pneutouch.spec.material import Material, PaperMeasurements
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA

UNEXPLAINED = 1.5
"""Factor between model and measurement that all values of a resin must exceed for it to be left out of the pool and
named: a choice. It leaves out FLX9995-DM, which is predicted twice too sensitive for an unknown reason."""

MODEL_CORRELATION = 0.745
"""Correlation between the model's errors of two sensors in one resin, where an error is the logarithm of model over
measurement. Over the errors e0 and e22 at 0 and 22 kPa of the six pooled resins of the paper's Table S1, 1 - mean((e22
- e0)^2) / (2 mean(e^2)) is 0.756. Between resins it is 0.03, taken as zero."""

MODEL = "model"
"""Name of the sources of `model_sources`."""


@dataclass(frozen=True)
class ModelErrors:
    """Relative errors of the sensitivity against Table S1: of one resin, and of a pool; titles ``left_out`` of it."""

    resin_errors: tuple[float, ...] = ()
    pool: tuple[float, ...] = ()
    left_out: tuple[str, ...] = ()


def model_errors(material: Material, materials: Iterable[Material]) -> ModelErrors:
    """Errors of the atlas for the paper's sensor against Table S1, for ``material`` and pooled over ``materials``."""
    others = list(materials)
    resin_errors, *rest = table_s1_errors([material, *others])
    return _pooled(resin_errors, others, rest)


def measured_errors(materials: Mapping[str, Material]) -> dict[str, ModelErrors]:
    """`model_errors`, pooled over ``materials``, of each of them that has measurements, by name."""
    every = list(materials.values())
    errors = table_s1_errors(every)
    return {
        name: _pooled(resin_errors, every, errors)
        for (name, material), resin_errors in zip(materials.items(), errors, strict=True)
        if material.measured
    }


def _pooled(resin_errors: tuple[float, ...], others: list[Material], rest: list[tuple[float, ...]]) -> ModelErrors:
    pool = [error for errors in rest if not _unexplained(errors) for error in errors]
    out = [other.title for other, errors in zip(others, rest, strict=True) if _unexplained(errors)]
    return ModelErrors(resin_errors, tuple(pool), tuple(out))


def table_s1_errors(materials: list[Material]) -> list[tuple[float, ...]]:
    """Relative errors of the atlas's sensitivity at 0 and 22 kPa for each material; () without measurements."""
    sensors = tuple(material_sensor(m) for m in materials if m.measured is not None)
    computed = iter(_table_s1_sensitivities(sensors))
    return [() if m.measured is None else _against(m.measured, next(computed)) for m in materials]


@lru_cache
def _table_s1_sensitivities(sensors: tuple[Sensor, ...]) -> Array:
    """Sensitivities (n, 2), kPa/N, by the atlas at 0 and 22 kPa; cached, because no design changes them."""
    if not sensors:
        return np.empty((0, 2))
    batch = SensorBatch.join([batch_of(sensor, [0.0, 22.0 * KPA]) for sensor in sensors])
    return respond(batch).lines.sensitivity.reshape(-1, 2)


def _against(measured: PaperMeasurements, sensitivity: Array) -> tuple[float, ...]:
    truth = measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal
    errors = sensitivity / np.array(truth) - 1.0
    return tuple(float(error) for error in errors[np.isfinite(errors)])


def _unexplained(errors: tuple[float, ...]) -> bool:
    return bool(errors) and float(np.abs(np.log1p(errors)).min()) > np.log(UNEXPLAINED)


def _spread(errors: tuple[float, ...]) -> float:
    """Root mean square of the logarithms of model over measurement, from relative errors: scatter and bias together."""
    return float(np.sqrt(np.mean(np.log1p(errors) ** 2)))


def model_sources(near: Flags, errors: ModelErrors) -> list[UncertaintySource]:
    """Sources for the model's error in sensitivity: the resin's own error where ``near`` (n,) is True, else the pool's.

    A resin that is left out of the pool keeps its own error everywhere. For other figures no such error is known.
    """
    resin_errors = (near | _unexplained(errors.resin_errors)) & bool(errors.resin_errors)
    left = f", without {', '.join(errors.left_out)}" if errors.left_out else ""
    cases = (
        (
            MODEL,
            resin_errors,
            errors.resin_errors,
            "this resin's {n} cells of the paper's Table S1; they hold the error of its modulus",
        ),
        (
            MODEL,
            ~resin_errors,
            errors.pool,
            f"all {{n}} cells of the paper's Table S1{left}: the best that is known away from the paper's sensor; they "
            "hold errors of moduli too, which so count in part twice",
        ),
    )
    source_list = []
    for name, rows, known, origin in cases:
        if rows.any() and known:
            standard: Array = np.full(near.size, _spread(known))
            counts = counting(near.size, only=(SENSITIVITY,)) & rows
            origin = f"{_spread(known):.1%} root mean square against " + origin.format(n=len(known))
            source_list.append(UncertaintySource(name, FIGURE, standard, "lognormal", counts, origin, True, len(known)))
    return source_list


def numerical_sources(size: int, numerical: Mapping[str, float]) -> list[UncertaintySource]:
    """Sources for ``size`` sensors from greatest relative numerical errors by figure. InputError: unknown figure."""
    source_list = []
    for name, greatest in numerical.items():
        if name not in FIGURES:
            raise InputError(f"numerical error of {shown(name)}: no such figure; there are {', '.join(FIGURES)}")
        source_list.append(
            UncertaintySource(
                "numerical",
                FIGURE,
                np.full(size, greatest / np.sqrt(3.0)),
                "rectangular",
                counting(size, only=(FIGURES.index(name),)),
                f"greatest error found, {greatest:.2g} of {name}",
                True,
            )
        )
    return source_list


BORE, BORE_TOLERANCE = 2.5, 0.1
"""Bore of a 4 mm tube (SMC TU0425) and its tolerance, mm. Only outer diameters have a published tolerance, +-0.1 mm for
nylon (SMC KQ2 precautions); it is assumed to be that of the bore too."""

UNSTATED_VOLUME = 100.0
"""Air in fitting and gauge that a stated dead volume may omit, mm3: an assumption, 20 mm of a 2.5 mm bore."""

WEATHER = 4.5 * KPA
"""Half range of sea level pressure, MPa: mostly within 960 and 1050 mbar (San Francisco State University, Geosciences,
course M301, Atmospheric Pressure)."""

GAUGE = 0.02
"""Temperature characteristic of the SMC PSE543 gauge: +-2 % of its range (paper, Supplement C), as a share."""

_LIMITS = 3.0
"""Number of standard deviations between the mean and a limit that holds almost always (JCGM 100, 4.3.5)."""

_ROOT = np.sqrt(3.0)

_SMC_TUBES = "SMC states outer diameters only"
_BAROMETER = (
    "960 to 1050 mbar at sea level (San Francisco State University, Geosciences M301), read as three standard "
    "deviations to either side; the height of the place is not in it"
)
_GAUGE_DATA = (
    "SMC PSE543, +-2 % (paper, Supplement C); assumed to be of the reading, the gauge being zeroed when vented"
)


def build_sources(batch: SensorBatch, printer: Printer) -> list[UncertaintySource]:
    """Sources on dimensions, dead volume, ambient and driving pressure of n sensors from one printer."""
    accuracy = printer.accuracy_mm.nominal
    origin = (
        f"{printer.title}, +-{accuracy:g} mm, even between its bounds (JCGM 100, 4.3.7): {printer.accuracy_mm.source}"
    )
    bore = 2.0 * BORE_TOLERANCE / BORE

    bores = f"assumed: bore {BORE:g} +-{BORE_TOLERANCE:g} mm, so the volume +-{bore:.0%}; {_SMC_TUBES}"
    unstated = f"assumed: up to {UNSTATED_VOLUME * 1e-3:g} mL of air that the stated dead volume does not hold"
    wall, radius = accuracy / _ROOT / batch.wall_thickness, 0.5 * accuracy / _ROOT / batch.inner_radius
    volume, fitting = bore / _ROOT * np.abs(batch.dead_volume), np.full(len(batch), UNSTATED_VOLUME / _ROOT)
    ambient, driving = WEATHER / _LIMITS / batch.ambient_pressure, np.full(len(batch), GAUGE / _ROOT)

    def source(name: str, acts_on: str, standard: Array, origin: str, known: bool) -> UncertaintySource:
        shape: Distribution = "normal" if acts_on == "ambient_pressure" else "rectangular"
        return UncertaintySource(name, acts_on, standard, shape, counting(len(batch)), origin, known)

    return [
        source("wall thickness", "wall_thickness", wall, origin, True),
        source("inner radius", "inner_radius", radius, f"half of the diameter's: {origin}", True),
        source("tube bore", "dead_volume", volume, bores, False),
        source("fitting and gauge", "dead_volume", fitting, unstated, False),
        source("weather", "ambient_pressure", ambient, _BAROMETER, True),
        source("driving pressure", "driving_pressure", driving, _GAUGE_DATA, False),
    ]
