"""A calibration as files: its folder, and the calibration file that a design names."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.parameters import DEAD, KEYS, NAMES, OFFSET, outside_value
from pneutouch.bench.calibrate.response import ResponseGap
from pneutouch.catalogue import KINDS
from pneutouch.errors import InputError
from pneutouch.output.files import MANIFEST, check_writable, digest, json_bytes, write_folder
from pneutouch.report.residuals import residual_chart
from pneutouch.rounding import rounded
from pneutouch.spec.calibration import FORMAT
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA, ML
from pneutouch.workflows.calibrate.fit import Calibration
from pneutouch.workflows.coupons import MeasuredProfile, write_profiles

_CHART = (160.0, 110.0)
"""Width and height of the residual chart, mm."""

_TWO_SIDED = 1.96
_DIGITS = 8
"""Significant digits of a calibration file: a covariance of correlated parameters needs more than its values."""

_NAME_LIMIT = 100


@dataclass(frozen=True, slots=True)
class CampaignSource:
    """Where the runs of a calibration are from: SHA-256 of the files, who measured, and the mean age of the print."""

    digest: str
    lab: str = ""
    simulated: bool = False
    age_days: float = 0.0


@dataclass(frozen=True, slots=True)
class SavedCalibration:
    """A calibration file before it is written: its name, its path and its text."""

    name: str
    path: Path
    text: str


def write_calibration(calibration: Calibration, out: Path) -> Path:
    """Write calibration.json and residuals.svg into ``out/<design>-<sensor>-calibration``. Raises InputError."""
    name = re.sub(r"[^A-Za-z0-9_-]+", "-", f"{calibration.scene.name}-{calibration.sensor or 'sensor'}-calibration")
    folder = out / name
    check_writable(folder)
    files = {
        "calibration.json": json_bytes(calibration.document),
        "residuals.svg": residual_chart(calibration.residuals, _CHART).encode(),
    }
    listed = {path: digest(content) for path, content in sorted(files.items())}
    write_folder(folder, {**files, MANIFEST: json_bytes({"files": listed})})
    return folder


def default_name(calibration: Calibration) -> str:
    """Name of the calibration file where none is given: design and sensor."""
    name = re.sub(r"[^A-Za-z0-9_-]+", "-", f"{calibration.scene.name}-{calibration.sensor or 'sensor'}")
    return name.lstrip("-_")[:_NAME_LIMIT] or "sensor"


def prepare(
    calibration: Calibration, name: str, root: Path, source: CampaignSource, *, replace: bool = False
) -> SavedCalibration:
    """Check and word ``root/calibrations/name.toml``; nothing is written.

    Raises InputError for a bad name, a file of that name with another content (unless ``replace``), and a modulus or
    wall that was fitted and has no interval.
    """
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*", name) or name == "none" or len(name) > _NAME_LIMIT:
        rule = f"use at most {_NAME_LIMIT} letters, digits, - and _, starting with a letter or digit, and not none"
        raise InputError(rule, key="save", value=name)
    path = root / KINDS["calibrations"].folder / f"{name}.toml"
    content = calibration_content(calibration, source)
    KINDS["calibrations"].validate(content, str(path))
    head = f"# Calibration of one sensor; pneutouch predict {calibration.scene.name}@{name} uses it.\n"
    text = head + toml_text(content)
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise InputError("is no file of its own", file=path, remedy="move it away or give another `save`")
    if path.is_file() and path.read_bytes() != text.encode() and not replace:
        remedy = "give another `save`, or `replace` to replace it"
        raise InputError("there is a calibration of this name, of other content", file=path, remedy=remedy)
    return SavedCalibration(name, path, text)


def save(saved: SavedCalibration) -> None:
    """Write what `prepare` made. Raises InputError where the folder cannot be written."""
    write_profiles([MeasuredProfile(saved.path, saved.text, [])])


def calibration_content(calibration: Calibration, source: CampaignSource) -> dict[str, Any]:
    """The content of the calibration file."""
    fitted, design = calibration.fit, calibration.scene.design
    observations, gap = fitted.observations, calibration.gap
    covered, covariance = _covariance(calibration)
    membrane = design.model_dump(by_alias=True, exclude_none=True)["membrane"]
    content = {
        "format": FORMAT,
        "title": f"sensor {calibration.sensor or 'unnamed'}, {calibration.title or 'unnamed campaign'}",
        "covariance": [[float(x) for x in row] for row in covariance],
        "source": {
            "sensor": calibration.sensor or "unnamed",
            "campaign": calibration.title,
            "lab": source.lab,
            "digest": source.digest,
            "simulated": source.simulated,
            "curves": 0 if gap is None else len(observations.curves),
            "injections": len(observations.injections),
            "driving_pressures_kPa": [] if gap is None else [*gap.driving_pressures_kPa],
            "ambient_pressure_kPa": observations.ambient / KPA,
            "age_days": float(source.age_days),
        },
        "design": {
            "name": calibration.scene.name,
            "material": membrane["material"],
            "inner_radius_mm": float(membrane["inner_radius_mm"]),
            "wall_thickness_mm": float(membrane["wall_thickness_mm"]),
            "dead_volume_mL": fitted.sensor.gas.dead_volume / ML,
        },
        "parameters": [
            {
                "key": KEYS[k],
                "value": outside_value(k, float(fitted.full[k])),
                "fitted": k in fitted.parameters.fitted,
                "covered": k in covered,
            }
            for k in range(len(NAMES))
        ],
        **({} if gap is None else {"response": _response(gap, calibration)}),
    }
    return rounded(content, _DIGITS)  # type: ignore[no-any-return]


def _covariance(calibration: Calibration) -> tuple[list[int], Array]:
    """Parameters with a covariance, and the covariance; of modulus and wall that of the logarithm, in mL and mm.

    A standard deviation is half of the 95 % interval over 1.96, so that k = 2 gives the interval back. What was not
    fitted but has a prior moves the estimates, and so is correlated with them. A dead volume or an offset on its bound
    has no interval and is left to the sources of the design.
    """
    fit = calibration.fit
    fitted, others, spread = fit.parameters.fitted, fit.parameters.others, fit.parameters.prior_spread
    for place, k in enumerate(fitted):
        if k not in (DEAD, OFFSET) and not np.isfinite(fit.half_width[place]):
            missing = f"{KEYS[k]} has no interval (on its bound, or not seen): there is no calibration to save"
            raise InputError(missing, key="save", remedy="leave it out of `fit`")
    size = len(NAMES)
    whole, grown = np.zeros((size, size)), np.ones(size)
    whole[np.ix_(fitted, fitted)] = fit.covariance.matrix
    for j in others:
        whole[j, j] = spread[j] ** 2
        whole[list(fitted), j] = whole[j, list(fitted)] = fit.covariance.considered[:, j] * spread[j]
    for place, k in enumerate(fitted):
        if np.isfinite(fit.half_width[place]):
            grown[k] = fit.half_width[place] / _TWO_SIDED / np.sqrt(whole[k, k])
    kept = sorted([*others, *(k for place, k in enumerate(fitted) if np.isfinite(fit.half_width[place]))])
    scale = grown * np.where(np.arange(size) == DEAD, 1.0 / ML, 1.0)
    whole = (whole * np.outer(scale, scale))[np.ix_(kept, kept)]
    return kept, 0.5 * (whole + whole.T)


def _response(gap: ResponseGap, calibration: Calibration) -> dict[str, Any]:
    correction = gap.correction
    return {
        "force_factors": [*correction.force_factors],
        "pressure_factors": [*correction.rise_factors],
        "sensitivity_errors_relative": gap.sensitivity_errors.tolist(),
        "force_errors_relative": gap.force_errors.tolist(),
        "held_out_pressures_kPa": [one.driving_pressure_kPa for one in calibration.held_out],
        "held_out_sensitivity_errors": [one.error for one in calibration.held_out],
    }
