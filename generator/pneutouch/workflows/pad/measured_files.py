"""Files of a measured pad: its figures, and its calibration."""

from pathlib import Path

from pneutouch.catalogue.library import KINDS, user_folder
from pneutouch.errors import InputError
from pneutouch.formats import versioned
from pneutouch.output.files import create_file, json_bytes, replace_file, with_manifest, write_folder
from pneutouch.report.pages import filled
from pneutouch.results.pad import MeasuredCell, PadFigures
from pneutouch.results.record import plain
from pneutouch.spec.pad import PadCalibration
from pneutouch.spec.toml_text import toml_text
from pneutouch.spec.values import plain_name
from pneutouch.wording import rounded
from pneutouch.workflows.pad.measured import MeasuredPad, PadFit

_DIGITS = 6


def write_figures(measured: MeasuredPad, fit: PadFit, out: Path) -> tuple[PadFigures, Path]:
    """Write ``out/<pad>-figures/`` with the figures as data and as a page; the same input gives the same bytes."""
    name, readings = f"{measured.pad.name}-figures", measured.readings
    cells = zip(measured.model.places.tolist(), fit.rise_factors, fit.of_rise_factors, strict=True)
    record = PadFigures(
        pad=measured.pad.name,
        simulated=measured.campaign.simulated,
        driving_pressure_kPa=measured.campaign.driving_pressure_kPa,
        ball_radius_mm=measured.campaign.ball_radius_mm,
        readings=len(readings.force),
        by_hand=int(readings.by_hand.sum()),
        force_factor=fit.force_factor,
        force_factor_uncertainty=fit.of_force_factor,
        stage_zero_mm=None
        if readings.by_hand.all()
        else (float(fit.shift[0]), float(fit.shift[1]), float(fit.shift[2])),
        rise_error=fit.rise_error,
        force_error=fit.force_error,
        cells=tuple(
            MeasuredCell(k, (x, y), float(factor), float(of)) for k, ((x, y), factor, of) in enumerate(cells, start=1)
        ),
    )
    record = rounded(record, _DIGITS, 1e-9)
    page = filled("pad_figures.md.j2", record=record).encode()
    files = {"pad-figures.json": json_bytes(versioned("pad-figures", plain(record))), "report.md": page}
    return record, write_folder(out / name, with_manifest(files, name, {"digest": measured.digest}))


def save_calibration(calibration: PadCalibration, name: str, *, replace: bool) -> Path:
    """Write a calibration among those of the user's folder. Raises InputError if there is one of other content."""
    path = user_folder() / KINDS["pad-calibrations"].folder / f"{plain_name(name, key='save')}.toml"
    content = toml_text(calibration.model_dump(mode="python")).encode()
    if replace or (path.is_file() and path.read_bytes() == content):
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, content)
        return path
    if path.exists():
        remedy = "give another `save`, or `replace` to replace it"
        raise InputError("there is a calibration of this name, of other content", file=path, remedy=remedy)
    create_file(path, content)
    return path
