"""A pad that is read live: its reader, its simulated rig, and the campaign that its recordings go into."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.errors import InputError
from pneutouch.export.reader.pad_reading import PadForceReader
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.mechanics.touch.objects import answer_of, random_objects, usual_ball
from pneutouch.results.plan import PlannedRun
from pneutouch.spec.pad import PAD_CAMPAIGN, PadCampaign, PadRun
from pneutouch.spec.read import read_toml, validate
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA
from pneutouch.workflows.live.readers import PadReader
from pneutouch.workflows.live.recording import next_file
from pneutouch.workflows.live.sensor import LiveSensor
from pneutouch.workflows.live.simulated import RATE_HZ, DeviceRow, touches


@dataclass(frozen=True)
class PadRig:
    """Readings of a predicted pad at ``rate`` Hz, with the noise of its gauges, kPa."""

    model: PadModel
    noise_kPa: float
    rate: float = RATE_HZ
    seed: int = 0

    def idle(self) -> Iterator[DeviceRow]:
        """Rows without end: the ball of the pad's plan touches it now and then, each time at another place."""
        random, rest_kPa = np.random.default_rng(self.seed), self.model.of_cells("driving_pressure") / KPA
        for share in touches(1.0, self.rate, random):
            (ball,) = random_objects(self.model, "ball", 1, random)
            ball[2] = self.model.table.radius / usual_ball(self.model)
            rows = np.tile(ball, (len(share), 1))
            rows[:, 3] *= np.maximum(share, 0.0) / share.max()
            answer = answer_of(self.model, "ball", rows)
            noise = self.noise_kPa * random.standard_normal(answer.rise.shape)
            pressures_kPa = (rest_kPa + answer.rise / KPA + noise).tolist()
            for force, row in zip(answer.force.tolist(), pressures_kPa, strict=True):
                yield (np.nan, force, *row)

    def run(self, run: PlannedRun) -> Iterator[DeviceRow]:
        """Raise InputError: a pad's plan has no steps of time."""
        raise InputError("the runs of a pad's plan have no steps of time", key="plan", remedy="give `record`")


def live_pad(name: str, model: PadModel, table: Mapping[str, Any]) -> LiveSensor:
    """A pad by its forward model and the table of its reader; its driving pressures are those of the table."""
    rig = PadRig(model, table["noise_kPa"])

    def at(pressure_kPa: float | None) -> PadRig:
        if pressure_kPa is not None:
            raise InputError(
                "a pad's are those of its cells", key="pressure_kPa", value=pressure_kPa, remedy="leave it out"
            )
        return rig

    return LiveSensor(name, PadReader(PadForceReader(table)), False, at)


@dataclass(frozen=True)
class PadRecordings:
    """The campaign of a pad's plan in a folder, to which recordings by hand are added."""

    folder: Path
    pad: str
    simulated: bool = False

    def check(self) -> None:
        """Raise InputError where the folder holds no campaign of a pad, or one of other runs."""
        path = self.folder / PAD_CAMPAIGN
        if not path.exists():
            raise InputError(
                f"holds no {PAD_CAMPAIGN}", file=self.folder, remedy=f"`pneutouch plan {self.pad}` writes one"
            )
        known = validate(PadCampaign, read_toml(path), str(path))
        if known.pad not in (self.pad, str(Path(self.pad).absolute())):
            raise InputError(f"is of another pad than {self.pad}", file=path, key="pad", value=known.pad)
        if known.simulated != self.simulated:
            problem = f"is of {'simulated' if known.simulated else 'measured'} runs"
            raise InputError(problem, file=path, key="simulated", remedy="record into another folder")

    def next_file(self) -> Path:
        """File of the next recording."""
        return next_file(self.folder)

    def enter(self, file: Path, pressure_kPa: float | None) -> None:
        """Write the entry of a recording to the end of the campaign file."""
        run = PadRun(file=file.relative_to(self.folder).as_posix(), kind="hand")
        with (self.folder / PAD_CAMPAIGN).open("a", encoding="utf-8") as campaign:
            campaign.write(f"\n{toml_text({'runs': [run.model_dump(mode='python')]})}")
