"""A calibration as files: its folder, and the resin and design that predict, select and build take."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.bench.finding import rounded
from pneutouch.catalogue import KINDS, Library
from pneutouch.errors import InputError
from pneutouch.output.files import MANIFEST, check_writable, digest, json_bytes, write_folder
from pneutouch.report.residuals import residual_chart
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.calibrate.fit import Calibration
from pneutouch.workflows.coupons import MeasuredProfile, write_profiles

HEAD = "# Written by pneutouch calibrate"
"""First words of every file that is ours to overwrite."""

_CHART = (160.0, 110.0)
"""Width and height of the residual chart, mm."""
_TWO_SIDED = 1.96
_SMALL = 4


@dataclass(frozen=True, slots=True)
class SavedCalibration:
    """What is saved of a calibration."""

    files: tuple[MeasuredProfile, ...]

    @property
    def paths(self) -> list[str]:
        """Paths of the files."""
        return [str(file.path) for file in self.files]


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


def prepare(
    calibration: Calibration, name: str, root: Path, library: Library, *, shadow: bool = False
) -> SavedCalibration:
    """Check and word the files of ``name`` under ``root``: the resin where its modulus was fitted, and the design.

    Nothing is written. Raises InputError for a bad name, one that would hide another resin or design (unless
    ``shadow``), a file that the command did not write, and estimates that have no interval.
    """
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*", name):
        raise InputError("use letters, digits, - and _, starting with a letter or digit", key="save", value=name)
    by_name = {estimate["parameter"]: estimate for estimate in calibration.estimates}
    files = []
    if "modulus" in by_name:
        place = _place("materials", name, root, library, shadow)
        files.append(_material(calibration, by_name["modulus"], place, library))
    files.append(_design(calibration, by_name, name, _place("designs", name, root, library, shadow)))
    return SavedCalibration(tuple(files))


def save(saved: SavedCalibration) -> None:
    """Write what `prepare` made. Raises InputError where a folder cannot be written."""
    write_profiles(saved.files)


def _place(kind: str, name: str, root: Path, library: Library, shadow: bool) -> Path:
    path = root / KINDS[kind].folder / f"{name}.toml"
    other = library.paths(kind).get(name)
    if other is not None and other.resolve() != path.resolve() and not shadow:
        remedy = "give another name, or `shadow` to hide it"
        raise InputError(
            f"{other} is of this name, which the new file would hide", key="save", value=name, remedy=remedy
        )
    if path.is_symlink() or path.exists():
        generated = path.is_file() and not path.is_symlink() and _is_generated(path)
        if not generated:
            kept = "was not written by pneutouch calibrate, so it is left as it is"
            raise InputError(kept, file=path, remedy="move it away or give another `save`")
    return path


def _is_generated(path: Path) -> bool:
    with path.open(encoding="utf-8", errors="replace") as file:
        return file.read(len(HEAD)) == HEAD


def _head(calibration: Calibration, lines: list[str]) -> str:
    keep = "Edit this line away and the command will no longer overwrite the file."
    return "".join([f"{HEAD} from {_origin(calibration)}. {keep}\n", *(f"# {line}\n" for line in lines)])


def _origin(calibration: Calibration) -> str:
    runs, pushed = len(calibration.fit.observations.curves), len(calibration.fit.observations.injections)
    counts = f"{runs} curves" + (f", {pushed} injections" if pushed else "")
    return f"sensor {calibration.sensor or 'unnamed'}, {calibration.title or 'unnamed campaign'}, {counts}"


def _material(calibration: Calibration, estimate: dict[str, Any], path: Path, library: Library) -> MeasuredProfile:
    interval = estimate["interval_95"]
    if interval is None:
        missing = "the shear modulus has no interval (on its bound, or not seen): there is no resin to save"
        raise InputError(missing, key="save")
    base = calibration.scene.design.membrane.material
    if not isinstance(base, str):
        remedy = "a modulus can be saved of a resin that has a file"
        raise InputError(f"{base.label} is a mix of two resins", key="save", remedy=remedy)
    content = read_toml(library.paths("materials")[base])
    before = content["shear_modulus_MPa"]
    # A material file holds one standard deviation; read with k = 2 it gives this interval back.
    spread = 0.5 * (interval[1] - interval[0]) / _TWO_SIDED
    wording = (
        f"calibrated on {_origin(calibration)}; 95 % interval {interval[0]:.4g} to {interval[1]:.4g} MPa; "
        f"{'priors counted' if calibration.fit.parameters.priors else 'no priors'}; before "
        f"{before.get('value', 'a range')}: {base}.toml"
    )
    content["shear_modulus_MPa"] = {"value": rounded(estimate["value"]), "spread": rounded(spread), "source": wording}
    content["title"] = f"{content['title']}, {path.stem}"
    # The paper measured another print: its values do not bear on the error of this modulus.
    content.pop("measured", None)
    KINDS["materials"].validate(content, str(path))
    about = f"{base} with the shear modulus of the sensor in hand; the paper's measurements of {base} are not in it."
    head = _head(calibration, [about])
    changes = [{"file": str(path), "key": "shear_modulus_MPa", "before": before, "after": content["shear_modulus_MPa"]}]
    return MeasuredProfile(path, head + toml_text(content), changes)


def _design(calibration: Calibration, by_name: dict[str, dict[str, Any]], name: str, path: Path) -> MeasuredProfile:
    design = calibration.scene.design
    content = design.model_dump(exclude_none=True)
    lines, changes = [], []
    for parameter, table, key, value in (
        ("wall", "membrane", "wall_thickness_mm", lambda x: rounded(x)),
        ("dead-volume", "pneumatics", "dead_volume_mL", lambda x: round(x, _SMALL)),
    ):
        if parameter in by_name:
            lines.append(_sentence(by_name[parameter]))
            before = content[table].get(key)
            content[table][key] = value(by_name[parameter]["value"])
            changes.append({"file": str(path), "key": f"{table}.{key}", "before": before, "after": content[table][key]})
    if "offset" in by_name:
        lines.append(f"{_sentence(by_name['offset'])}; of the measurement, not of the sensor: not in this file.")
    if "modulus" in by_name:
        changes.append(
            {"file": str(path), "key": "membrane.material", "before": design.membrane.material, "after": name}
        )
        content["membrane"]["material"] = name
    KINDS["designs"].validate(content, str(path))
    return MeasuredProfile(path, _head(calibration, lines) + toml_text(content), changes)


def _sentence(estimate: dict[str, Any]) -> str:
    interval = estimate["interval_95"]
    interval_text = "no interval" if interval is None else f"95 % interval {interval[0]:.4g} to {interval[1]:.4g}"
    return f"{estimate['key']} = {estimate['value']:.4g}, {interval_text}; designed {estimate['designed']:.4g}"
