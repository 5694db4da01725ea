"""A scan as a folder: signals, document, figure and manifest."""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, json_bytes, write_folder
from pneutouch.output.manifest import with_manifest
from pneutouch.texture.signal import decimated
from pneutouch.texture.substrate import BarRow
from pneutouch.units import KPA
from pneutouch.workflows.scan.document import document, inputs, spectra
from pneutouch.workflows.scan.run import AnalysedSignal, ScanRun


def write_scan(run: ScanRun, out: Path) -> Path:
    """Write signals, document, figure and manifest into ``out/<specimen>-<design>-scan/``."""
    folder = out / run.name
    check_writable(folder)
    files = {"scan.json": json_bytes(versioned("scan", document(run))), "scan.svg": spectra(run).encode()}
    for number, seen in enumerate(run.seen):
        files[f"signal-{number + 1}.csv"] = signal_csv(seen, run.bars, run.kept)
    write_folder(folder, with_manifest(files, run.name, inputs(run)))
    return folder


def signal_csv(seen: AnalysedSignal, bars: Sequence[BarRow], highest: float) -> bytes:
    """A signal decimated for ``highest`` Hz; a simulated one with place, noiseless pressure and true patterns."""
    kept = decimated(seen.signal, highest)
    columns = {"time_s": kept.time, "pressure_kPa": kept.pressure / KPA}
    if seen.scan is not None:
        every = np.searchsorted(seen.signal.time, kept.time - 0.5 * seen.signal.step)
        columns["place_mm"] = seen.scan.place[every]
        columns["noiseless_kPa"] = seen.scan.clean[every] / KPA
        columns |= {f"bar_{k + 1}": row.covers(seen.scan.place[every]) for k, row in enumerate(bars)}
    text = io.StringIO()
    text.write(",".join(columns) + "\n")
    np.savetxt(text, np.stack(list(columns.values()), axis=1), fmt="%.9g", delimiter=",")
    return text.getvalue().encode()
