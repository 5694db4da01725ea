"""Files of a calibration: its output folder, and the calibration file that a design names."""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import UNSEEN
from pneutouch.bench.calibrate.goodness import ResponseGap
from pneutouch.bench.calibrate.parameters import DEAD, FRICTION, KEYS, MODULUS, NAMES, OFFSET, WALL, outside_value
from pneutouch.catalogue import KINDS
from pneutouch.errors import InputError
from pneutouch.formats import format_of, versioned
from pneutouch.output.files import check_writable, json_bytes, replace_files, with_manifest, write_folder
from pneutouch.report.fit_charts import residual_chart
from pneutouch.results.record import plain
from pneutouch.shape import stated_sizes
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.design import NO_CALIBRATION
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.spec.values import NAME_RULE, plain_name
from pneutouch.units import KPA, ML
from pneutouch.wording import rounded
from pneutouch.workflows.calibrate.fit import Calibration


def check_place(name: str, root: Path) -> Path:
    """Path of a calibration's file, ``root/calibrations/name.toml``.

    Raises InputError for a bad name, for a path that is no file, and for a folder that cannot be written.
    """
    # DESIGN@NAME is a path where it ends with .toml.
    if plain_name(name, key="save") == NO_CALIBRATION or name.endswith(".toml"):
        remedy = f"{NAME_RULE}; not {NO_CALIBRATION}, and not ending with .toml"
        raise InputError("cannot be the name of a calibration", key="save", value=name, remedy=remedy)
    path = root / KINDS["calibrations"].folder / f"{name}.toml"
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise InputError("is no file of its own", file=path, remedy="move it away or give another `save`")
    parent = next(one for one in path.absolute().parents if one.exists())
    if not parent.is_dir():
        raise InputError(f"{parent} is not a folder", file=path, remedy="move it away: it must be a folder")
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{parent} cannot be written", file=path, remedy="take a user's folder you may write to")
    return path


def check_unlike(path: Path, digest: str, names: Sequence[str], hold_out_kPa: Sequence[float]) -> None:
    """Raise InputError if the file exists and cannot be the calibration that is to be made.

    It can be that calibration if its campaign has the ``digest``, ``names`` were fitted and ``hold_out_kPa`` held out.
    """
    if not path.is_file():
        return
    try:
        there = KINDS["calibrations"].validate(read_toml(path), str(path))
    except InputError:
        raise taken(path) from None
    assert isinstance(there, SensorCalibration)
    held_kPa = [] if there.response is None else there.response.held_out_pressures_kPa
    fitted = {parameter.key for parameter in there.parameters if parameter.fitted}
    requested = {KEYS[NAMES.index(name)] for name in names}
    if there.source.digest != digest or fitted != requested or held_kPa != list(hold_out_kPa):
        raise taken(path)


def taken(path: Path) -> InputError:
    """Error for a name that another calibration has."""
    remedy = "give another `save`, or `replace` to replace it"
    return InputError("there is a calibration of this name, of other content", file=path, remedy=remedy)


_CHART = (160.0, 110.0)
"""Width and height of the residual chart, mm."""

_TWO_SIDED = 1.96
_DIGITS = 8
"""Significant digits in a calibration file: the covariance of correlated parameters needs more than the values do."""

_NAME_LIMIT = 100


@dataclass(frozen=True, slots=True)
class CampaignSource:
    """Source of a calibration's runs: SHA-256 of the files, laboratory, if simulated, and mean age of the print."""

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


def folder_of(design: str, sensor: str, out: Path) -> Path:
    """Output folder of a calibration: ``out/<design>-<sensor>-calibration``."""
    return out / f"{_plain(design, sensor)}-calibration"


def write_calibration(calibration: Calibration, out: Path, source: CampaignSource, unsaved: Sequence[str] = ()) -> Path:
    """Write calibration.json, residuals.svg and a manifest into `folder_of`, with the notes ``unsaved`` added."""
    folder = folder_of(calibration.scene.name, calibration.sensor, out)
    check_writable(folder)
    record = replace(calibration.record, notes=(*calibration.record.notes, *unsaved))
    files = {
        "calibration.json": json_bytes(versioned("calibration-report", plain(record))),
        "residuals.svg": residual_chart(calibration.residuals, _CHART).encode(),
    }
    fitted = calibration.fit.parameters
    inputs = {
        "design": calibration.scene.name,
        "sensor": calibration.sensor,
        "campaign": {"title": calibration.title, "digest": source.digest},
        "fit": list(fitted.names),
        "priors": fitted.priors,
        "hold_out_kPa": [one.driving_pressure_kPa for one in calibration.held_out],
    }
    return write_folder(folder, with_manifest(files, folder.name, inputs))


def default_name(design: str, sensor: str) -> str:
    """Name of a calibration file if none is given: design and sensor."""
    return _plain(design, sensor).lstrip("-_")[:_NAME_LIMIT] or "sensor"


def _plain(design: str, sensor: str) -> str:
    return re.sub(r"[^A-Za-z0-9_-]+", "-", f"{design}-{sensor or 'sensor'}")


def prepare(
    calibration: Calibration, name: str, root: Path, source: CampaignSource, *, replace: bool = False
) -> SavedCalibration:
    """Check and compose ``root/calibrations/name.toml``; nothing is written.

    Raises InputError as `check_place` and `savable` do, and without ``replace`` for a file of that name with other
    content.
    """
    path = check_place(name, root)
    head = f"# Calibration of one sensor; pneutouch predict {calibration.scene.name}@{name} uses it.\n"
    text = head + toml_text(savable(calibration, source))
    if path.is_file() and path.read_bytes() != text.encode() and not replace:
        raise taken(path)
    return SavedCalibration(name, path, text)


def savable(calibration: Calibration, source: CampaignSource) -> dict[str, Any]:
    """Content of the calibration file, checked. Raises InputError if the fit cannot be a calibration.

    It cannot be one if a fitted modulus, wall or friction has no interval, the data do not determine the friction, the
    runs contradict the fitted model, or a value or its uncertainty is beyond the bounds. The error's key is ``fit``
    where another choice of parameters may help.
    """
    _check_friction(calibration)
    content = calibration_content(calibration, source)
    if calibration.misfit.contradicted:
        held = not {MODULUS, WALL} <= set(calibration.fit.parameters.fitted)
        raise InputError(
            f"the runs contradict the fitted model: it is off in {calibration.misfit.words}",
            key="fit" if held else None,
            remedy=f"{'fit modulus and wall, or ' if held else ''}check units, columns, driving pressures, design and "
            "contact of the runs",
        )
    try:
        KINDS["calibrations"].validate(content, "calibration")
    except InputError as error:
        where = f"{error.key}: " if error.key else ""
        raise InputError(f"{where}{error.problem}", key="fit", remedy="fit fewer parameters") from None
    return content


def _check_friction(calibration: Calibration) -> None:
    """Raise InputError if friction was fitted and the data do not determine it (`UNSEEN`)."""
    fit, identified = calibration.fit, calibration.identified
    if FRICTION not in fit.parameters.fitted:
        return
    place = fit.parameters.fitted.index(FRICTION)
    left = float(np.sqrt(fit.covariance.matrix[place, place]) / fit.parameters.prior_spread[FRICTION])
    if FRICTION not in identified.unseen and not left > UNSEEN:
        return
    groups = [group.members for group in identified.ambiguities if FRICTION in group.members]
    others = " and ".join(NAMES[k] for k in groups[0] if k != FRICTION) if groups else ""
    why = f"the data do not distinguish friction from {others}" if others else "the data do not determine the friction"
    raise InputError(why, key="fit", value=",".join(fit.parameters.names), remedy="leave out friction")


def save(saved: SavedCalibration) -> None:
    """Write the file that `prepare` composed. Raises InputError if the folder cannot be written."""
    try:
        replace_files({saved.path: saved.text.encode()})
    except InputError as error:
        # The remedy there is of an output folder; the problem names the file.
        raise InputError(error.problem, remedy="take a user's folder you may write to") from None


def calibration_content(calibration: Calibration, source: CampaignSource) -> dict[str, Any]:
    """Content of the calibration file, numbers rounded to `_DIGITS`."""
    fitted, design = calibration.fit, calibration.scene.design
    observations, gap = fitted.observations, calibration.gap
    covered, covariance = _covariance(calibration)
    membrane = design.model_dump(by_alias=True, exclude_none=True)["membrane"]
    dome, sizes = design.membrane.dome, stated_sizes(design.membrane.dome)
    content = {
        "format": format_of("calibration"),
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
            "depth_mm": None if gap is None else gap.depth,
            "plate_diameter_mm": None if gap is None else float(design.indentation.plate_diameter_mm),
            **({} if design.contact.is_atlas_plate else {"contact": design.contact.words}),
        },
        "design": {
            "name": calibration.scene.name,
            "material": membrane["material"],
            "inner_radius_mm": float(membrane["inner_radius_mm"]),
            "wall_thickness_mm": float(membrane["wall_thickness_mm"]),
            "shape": dome.key,
            **({"sizes": sizes} if sizes else {}),
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
            if k != FRICTION or k in fitted.parameters.fitted
        ],
        **({} if gap is None else {"response": _response(gap, calibration)}),
    }
    return rounded(content, _DIGITS)


def _covariance(calibration: Calibration) -> tuple[list[int], Array]:
    """Indices of the parameters with a covariance, and the covariance, (k, k): of logarithms for modulus and wall, else
    mL and mm.

    A standard deviation is half of the 95 % interval over 1.96, so that k = 2 gives the interval back. What was not
    fitted but has a prior moves the estimates, and so is correlated with them. A dead volume or an offset on its bound
    has no interval and is left to the sources of the design.
    """
    fit = calibration.fit
    fitted, others, spread = fit.parameters.fitted, fit.parameters.others, fit.parameters.prior_spread
    for place, k in enumerate(fitted):
        if k not in (DEAD, OFFSET) and not np.isfinite(fit.half_width[place]):
            missing = f"{KEYS[k]} has no interval (on its bound, or not seen): there is no calibration to save"
            raise InputError(missing, key="fit", remedy=f"leave out {NAMES[k]}")
    # A friction that was not fitted is a source of its own in every prediction.
    others = tuple(k for k in others if k != FRICTION)
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


def _response(gap: ResponseGap, calibration: Calibration) -> dict[str, float | list[float]]:
    correction = gap.correction
    return {
        "force_factors": [*correction.force_factors],
        "pressure_factors": [*correction.rise_factors],
        "sensitivity_errors_relative": gap.sensitivity_errors.tolist(),
        "force_errors_relative": gap.force_errors.tolist(),
        "errors_freedom": float(gap.freedom),
        "held_out_pressures_kPa": [one.driving_pressure_kPa for one in calibration.held_out],
        "held_out_sensitivity_errors": [one.sensitivity_error for one in calibration.held_out],
    }
