"""What is fuzzed: every reader of bytes that others wrote, each as a function of a file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from pneutouch.errors import InputError, PneutouchError
from tests.fuzzing import files, requests
from tests.fuzzing.parts import archive


@dataclass(frozen=True)
class Target:
    """A reader. ``name`` is the file's; ``written`` makes the file's bytes of an input; ``allowed`` are its errors.

    ``library`` is the one that an extra needs.
    """

    name: str
    read: Callable[[Path], object]
    written: Callable[[bytes], bytes] = bytes
    allowed: tuple[type[Exception], ...] = (InputError,)
    library: str = ""


ALL_ERRORS = (PneutouchError,)

TARGETS: dict[str, Target] = {
    "design": Target("a.toml", files.read_design),
    "specimen": Target("a.toml", files.read_specimen),
    "target": Target("a.toml", files.read_target),
    "sweep": Target("a.toml", files.read_sweep),
    "tray": Target("a.toml", files.read_tray),
    "tasks": Target("a.toml", files.read_tasks),
    "tasks-csv": Target("a.csv", files.read_tasks),
    "campaign": Target("campaign.toml", files.read_campaign),
    "material": Target("a.toml", files.reader_of("materials")),
    "printer": Target("a.toml", files.reader_of("printers")),
    "gauge": Target("a.toml", files.reader_of("gauges")),
    "mixing": Target("a.toml", files.reader_of("mixing")),
    "calibration": Target("a.toml", files.reader_of("calibrations")),
    "port": Target("a.toml", files.reader_of("ports")),
    "seat": Target("a.toml", files.reader_of("seats")),
    "mount": Target("a.toml", files.reader_of("mounts")),
    "coupons": Target("a.toml", files.read_coupons),
    "run-csv": Target("a.csv", files.read_run),
    "run-xlsx": Target("a.xlsx", files.read_run, written=archive, library="openpyxl"),
    "run-parquet": Target("a.parquet", files.read_run, library="pyarrow"),
    "run-tdms": Target("a.tdms", files.read_run, library="nptdms"),
    "threemf": Target("a.3mf", files.read_threemf, written=archive),
    "recipe": Target("a.json", files.read_recipe),
    "dataset": Target("a.nc", files.read_dataset),
    "journal": Target("journal", files.read_journal),
    "slice": Target("a.png", files.read_slice),
    "stack": Target("stack.json", files.read_stack),
    "leak": Target("figures.json", files.read_leak),
    "prediction": Target("prediction.json", files.read_prediction),
    "figures": Target("figures.json", files.read_figures),
    "exported": Target("a.json", requests.read_exported),
    "question": Target("a.json", requests.read_question, allowed=ALL_ERRORS),
    "search": Target("a.json", requests.read_search),
    "measured": Target("a.json", requests.read_measured),
    "head": Target("a.txt", requests.read_head),
}
