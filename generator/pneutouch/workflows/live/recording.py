"""Files of live samples, whole after every second, and their entries in a campaign that `characterize` reads."""

import contextlib
import math
import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Protocol

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.formats import format_of
from pneutouch.output.files import replace_file
from pneutouch.spec.campaign import CAMPAIGN, CampaignRun, campaign_of
from pneutouch.spec.pad import channels
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.live.protocol import DeviceSample
from pneutouch.workflows.simulate_inputs import named_design

FLUSHED_S = 1.0
"""Seconds after which what was recorded is on the disk."""

RECORDING = ".recording.csv"
"""Ending of a file while it is recorded; one that stays so was cut off, and is whole up to its last second."""


@dataclass
class Recording:
    """One run as a CSV file: time, then travel and force if the device sends them, and pressures.

    ``path`` is the file's name when it is closed. ``mark`` is its first line, a comment, or empty.
    Samples beyond ``most_s`` seconds are left out, and the recording is ``full``. ``beside``: whether the device was
    seen to send travel and force, whose columns are there then.
    """

    path: Path
    mark: str = ""
    most_s: float = math.inf
    full: bool = False
    beside: tuple[bool, bool] = (False, False)
    seconds: float = 0.0
    _file: IO[str] | None = field(default=None, repr=False)
    _kept: list[int] = field(default_factory=list, repr=False)
    _flushed: float = field(default=0.0, repr=False)

    @property
    def cut_off(self) -> Path:
        """The file while it is recorded."""
        return self.path.with_name(self.path.name.removesuffix(".csv") + RECORDING)

    def check(self) -> None:
        """Raise InputError if a file of that name, or one of a recording that was cut off, is there."""
        for path in (self.path, self.cut_off):
            if path.exists():
                remedy = "a recording is never overwritten: move it away, or record another run"
                raise InputError("is there already", file=path, remedy=remedy)

    def add(self, sample: DeviceSample, seconds: float) -> None:
        """Write a sample; ``seconds`` after the one before."""
        if self._file is None:
            self._begin(sample)
        elif self.seconds + seconds > self.most_s + 1e-6:
            self.full = True
            return
        else:
            self.seconds += seconds
        assert self._file is not None
        values = (sample.position_mm, sample.force_N, *sample.pressures_kPa)
        cells = ["" if math.isnan(values[k]) else f"{values[k]:.6g}" for k in self._kept]
        self._file.write(f"{self.seconds:.4f},{','.join(cells)}\n")
        now = time.monotonic()
        if now - self._flushed > FLUSHED_S:
            self.flush()

    def _begin(self, sample: DeviceSample) -> None:
        cells = len(sample.pressures_kPa)
        pressures = ["pressure_kPa"] if cells == 1 else channels(cells)
        names = ["position_mm", "force_N", *pressures]
        sent = (not math.isnan(sample.position_mm), not math.isnan(sample.force_N))
        beside = [k for k in range(2) if sent[k] or self.beside[k]]
        self._kept = [*beside, *range(2, len(names))]
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file = self.cut_off.open("x", encoding="utf-8")
        self._file.write(f"{self.mark}\n" if self.mark else "")
        self._file.write(f"time_s,{','.join(names[k] for k in self._kept)}\n")
        self._flushed = time.monotonic()

    def flush(self) -> None:
        """Bring what was recorded onto the disk."""
        if self._file is not None:
            self._file.flush()
            os.fsync(self._file.fileno())
        self._flushed = time.monotonic()

    def abandon(self) -> None:
        """Leave the file as it is: it could not be written."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.close()
            self._file = None

    def close(self, *, cut: bool = False) -> Path | None:
        """End the recording and give the file its name, or one that says that it was ``cut`` short; None if nothing was
        recorded."""
        if self._file is None:
            return None
        self.flush()
        self._file.close()
        self._file = None
        path, number = self.path, 1
        while cut and (path == self.path or path.exists()):
            path, number = self.path.with_name(f"{self.path.stem}.cut-{number}.csv"), number + 1
        self.cut_off.rename(path)
        return path


def next_file(folder: Path) -> Path:
    """File of the next recording below a folder."""
    number, runs = 1, folder / "runs"
    while any((runs / f"live-{number}{ending}").exists() for ending in (".csv", RECORDING)):
        number += 1
    return runs / f"live-{number}.csv"


class Recordings(Protocol):
    """A campaign that recordings are added to."""

    def check(self) -> None:
        """Raise InputError if nothing can be added to it."""

    def next_file(self) -> Path:
        """File of the next recording."""

    def enter(self, file: Path, pressure_kPa: float | None) -> None:
        """Enter a recording at a driving pressure; None: not known."""


@dataclass(frozen=True)
class FreeCampaign:
    """A campaign of runs that no plan has, in a folder: of ``design`` with ``assignments``, ``simulated`` or not.

    ``copied`` are the files that the campaign's design needs beside it, by name."""

    folder: Path
    design: str
    assignments: Sequence[str] = ()
    simulated: bool = False
    copied: Mapping[str, bytes] = field(default_factory=dict)

    @classmethod
    def of(cls, folder: Path, design: str, assignments: Sequence[str], simulated: bool) -> "FreeCampaign":
        """The campaign of a design by its name or path; the file of a path is copied beside it. Raises InputError."""
        name, copied = named_design(design, Library.default())
        return cls(folder, name, assignments, simulated, copied)

    def check(self) -> None:
        """Raise InputError if the folder holds a campaign of another design, or one that cannot be read."""
        if not (self.folder / CAMPAIGN).exists():
            return
        known, _ = campaign_of(self.folder)
        is_own = known.design == self.design and list(known.assignments) == list(self.assignments)
        if not is_own or known.simulated != self.simulated:
            problem = f"holds runs of {known.design} {' '.join(known.assignments)}".rstrip()
            problem += ", simulated ones" if known.simulated else ""
            raise InputError(problem, file=self.folder / CAMPAIGN, remedy="record into another folder")

    def next_file(self) -> Path:
        """File of the next run."""
        return next_file(self.folder)

    def enter(self, file: Path, pressure_kPa: float | None) -> None:
        """Write the entry of a run to the end of the campaign file, which is made if there is none; what stands in it
        stays as it is. The kind of the run is left out: it is recognised."""
        path, name = self.folder / CAMPAIGN, file.relative_to(self.folder).as_posix()
        before = campaign_of(self.folder)[0].runs if path.exists() else []
        here_kPa = 0.0 if pressure_kPa is None else round(max(pressure_kPa, 0.0), 2)
        run = CampaignRun(
            file=name,
            sensor="live",
            driving_pressure_kPa=here_kPa,
            run=1 + sum(one.driving_pressure_kPa == here_kPa and one.sensor == "live" for one in before),
        )
        unknown = {"driving_pressure_kPa"} if pressure_kPa is None else set()
        left_out = {"kind", "age_days", "resin", *unknown}
        entry = run.model_dump(mode="python", exclude_none=True, exclude=left_out)
        head = {
            "campaign_format": format_of("campaign"),
            "title": f"Live recordings of {self.design}"[:120],
            "design": self.design,
            "assignments": list(self.assignments),
            "simulated": self.simulated,
        }
        text = "" if path.exists() else toml_text(head)
        for other, content in self.copied.items():
            if not (self.folder / other).exists():
                replace_file(self.folder / other, content)
        with path.open("a", encoding="utf-8") as campaign:
            campaign.write(f"{text}\n{toml_text({'runs': [entry]})}")
