"""Export of a pad's reader, for a microcontroller and Python."""

from pathlib import Path

from pneutouch import __version__
from pneutouch.export.reader.pad_render import PadReaderSource, pad_reader_files
from pneutouch.mechanics.touch.cell import TABLE_ERROR
from pneutouch.mechanics.touch.reader_table import reader_table
from pneutouch.output.files import digest, json_bytes, with_manifest, write_folder
from pneutouch.units import KPA
from pneutouch.workflows.pad.campaign import noise_kPa
from pneutouch.workflows.pad.load import ResolvedPad
from pneutouch.workflows.pad.touch import calibrated_model, pad_model, pad_pressure_kPa


def write_pad_reader(pad: ResolvedPad, calibration: str | None, out: Path) -> Path:
    """Write ``out/<pad>-reader/``: header of C99 and Python module, by a calibration or as predicted at the greatest
    driving pressure of the cell. The same input gives the same bytes. Raises InputError as `calibrated_model`."""
    error = TABLE_ERROR / 3.0
    if calibration is None:
        model = pad_model(pad, pad_pressure_kPa(pad))
    else:
        # A fit to one ball does not lessen the error of the table for others.
        model, known = calibrated_model(pad, calibration)
        error = max(error, known.model_error)
    table = reader_table(model, noise_kPa(pad), error)
    made_of = digest(json_bytes(table))
    pressure_kPa = round(model.table.driving_pressure / KPA, 6)
    source = PadReaderSource(pad.name, pressure_kPa, calibration, __version__, made_of)
    name = f"{pad.name}-reader"
    return write_folder(out / name, with_manifest(pad_reader_files(table, source), name, {"table": made_of}))
