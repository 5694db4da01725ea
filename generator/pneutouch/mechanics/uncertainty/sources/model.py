"""The uncertainty of the model itself: its errors against the paper's Table S1, and the numbers' own error."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.errors import InputError, shown
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.neighbours import joined
from pneutouch.mechanics.uncertainty.source import FIGURE, FIGURES, SENSITIVITY, UncertaintySource, counting
from pneutouch.spec.material import Material, PaperMeasurements
from pneutouch.units import KPA

UNEXPLAINED = 1.5
"""A resin whose cells are all off by more than this factor is left out of the pool and named: a choice of this program.
It leaves out FLX9995-DM, which reads twice too sensitive for a reason not known."""

MODEL_CORRELATION = 0.756
"""Correlation between the model's errors of two sensors in one resin, each error the logarithm of model over
measurement: 1 - mean((e22 - e0)^2) / (2 mean(e^2)) over the errors at 0 and 22 kPa of the six resins of the paper's
Table S1 that the model's error is pooled from gives 0.756. Between resins it is 0.03, taken as none."""

MODEL = "model"
"""Name of the sources of `model_sources`."""


@dataclass(frozen=True)
class ModelErrors:
    """Relative errors of the sensitivity against Table S1: of the resin itself, and of all resins of the pool."""

    resin_errors: tuple[float, ...] = ()
    pool: tuple[float, ...] = ()
    left_out: tuple[str, ...] = ()


def model_errors(material: Material, materials: Iterable[Material]) -> ModelErrors:
    """The atlas on the paper's sensor against Table S1, in every resin of ``materials`` that was measured."""
    others = list(materials)
    resin_errors, *rest = table_s1_errors([material, *others])
    return _pooled(resin_errors, others, rest)


def measured_errors(materials: Mapping[str, Material]) -> dict[str, ModelErrors]:
    """`model_errors` of every resin that was measured, by name."""
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
    """Relative errors of the atlas at 0 and 22 kPa by material; empty for one that was not measured."""
    sensors = tuple(material_sensor(m) for m in materials if m.measured is not None)
    computed = iter(_table_s1_sensitivities(sensors))
    return [() if m.measured is None else _against(m.measured, next(computed)) for m in materials]


@lru_cache
def _table_s1_sensitivities(sensors: tuple[Sensor, ...]) -> Array:
    """Sensitivities by the atlas at 0 and 22 kPa, kPa/N, (n, 2). Kept, since they do not depend on the design."""
    if not sensors:
        return np.empty((0, 2))
    batch = joined([batch_of(sensor, [0.0, 22.0 * KPA]) for sensor in sensors])
    return respond(batch).lines.sensitivity_kPa_per_N.reshape(-1, 2)


def _against(measured: PaperMeasurements, sensitivity: Array) -> tuple[float, ...]:
    truth = measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal
    errors = sensitivity / np.array(truth) - 1.0
    return tuple(float(error) for error in errors[np.isfinite(errors)])


def _unexplained(errors: tuple[float, ...]) -> bool:
    return bool(errors) and float(np.abs(np.log1p(errors)).min()) > np.log(UNEXPLAINED)


def _spread(errors: tuple[float, ...]) -> float:
    """Root mean square of the logarithms of model over measurement: scatter and bias in one, nothing corrected."""
    return float(np.sqrt(np.mean(np.log1p(errors) ** 2)))


def model_sources(near: Flags, errors: ModelErrors) -> list[UncertaintySource]:
    """The model's error in sensitivity: the resin's own near the paper's sensor, elsewhere the pool's; (n,) flags.

    A resin left out of the pool keeps its own error everywhere. Nothing of the kind is known for the other figures.
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
    """Discretisation and interpolation: greatest relative errors by figure. Raises InputError for an unknown figure."""
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
