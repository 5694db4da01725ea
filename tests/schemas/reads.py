"""How each kind of file is read, files of each kind that are good, and a file's content as JSON."""

from __future__ import annotations

import datetime
import math
import tempfile
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pneutouch.catalogue import KINDS, Library
from pneutouch.catalogue.library import examples
from pneutouch.spec.campaign import Campaign
from pneutouch.spec.coupon import read_results
from pneutouch.spec.pad import PadCampaign
from pneutouch.spec.read import read_toml, validate
from pneutouch.spec.target import Target
from pneutouch.spec.tasks import TaskFile
from pneutouch.spec.toml_text import toml_text
from pneutouch.spec.tray import Tray
from pneutouch.workflows.sweep.grid import plan_of_file
from tests.conftest import ROOT
from tests.evaluation.calibrated import CONTENT
from tests.stability.fuzz.cases import RESULTS

Content = dict[str, Any]

OF_THE_CATALOGUE = {kind.removesuffix("s"): kind for kind in KINDS}
"""Names of schemas with the catalogue's kind."""


def _from_disk(read: Callable[[Path], object]) -> Callable[[Content], object]:
    """A reader that takes a path."""

    def run(content: Content) -> object:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "file.toml"
            path.write_text(toml_text(content), encoding="utf-8")
            return read(path)

    return run


READERS: dict[str, Callable[[Content], object]] = {
    **{name: (lambda c, kind=kind: KINDS[kind].validate(c, "file")) for name, kind in OF_THE_CATALOGUE.items()},
    "target": lambda content: validate(Target, content, "file"),
    "tray": lambda content: validate(Tray, content, "file"),
    "tasks": lambda content: validate(TaskFile, content, "file"),
    "pad-campaign": lambda content: validate(PadCampaign, content, "file"),
    "campaign": lambda content: validate(Campaign, content, "file"),
    "coupons": _from_disk(read_results),
    "sweep": _from_disk(plan_of_file),
}

POINTS = """design = "paper-dome"
model = "solid"

[[point]]
"membrane.wall_thickness_mm" = 1.2
"pneumatics.driving_pressures_kPa" = [0, 10]

[[point]]
membrane.material = "FLX9950"
contact = { object = "ball", ball_radius_mm = 6, friction = "inf" }
"""

PAD_CAMPAIGN = {"pad": "tip", "driving_pressure_kPa": 12.0, "ball_radius_mm": 5.5, "runs": [{"file": "stage.csv"}]}

PAD_CALIBRATION = {
    "pad": "tip",
    "places_mm": [[0.0, 0.0], [9.0, 0.0]],
    "driving_pressure_kPa": 12.0,
    "force_factor": 1.1,
    "force_factor_uncertainty": 0.02,
    "rise_factors": [1.0, 0.9],
    "rise_factor_uncertainties": [0.02, 0.03],
    "model_error": 0.01,
    "readings": 60,
    "digest": "0" * 64,
}

TASKS = '[[task]]\nname = "fruit"\nsensitivity_kPa_per_N = 2.5\n\n[[task]]\nforce_range_N = 8\n'


def good_files() -> dict[str, list[Content]]:
    """Contents by the name of their schema: everything shipped, and what is not shipped of the tests."""
    library = Library((ROOT,))
    files = {
        name: [read_toml(path) for path in library.paths(kind).values()] for name, kind in OF_THE_CATALOGUE.items()
    }
    for example in examples().values():
        files.setdefault(example.kind, []).append(read_toml(example.path))
    files["calibration"].append(CONTENT)
    files["pad-calibration"].append(PAD_CALIBRATION)
    files["pad-campaign"] = [PAD_CAMPAIGN]
    files["coupons"] = [tomllib.loads(RESULTS)]
    files["tasks"] = [tomllib.loads(TASKS)]
    files["sweep"].append(tomllib.loads(POINTS))
    return files


def as_json(value: Any) -> Any:
    """What TOML holds as JSON does: dates are texts, and so are infinity and what is no number."""
    if isinstance(value, dict):
        return {key: as_json(one) for key, one in value.items()}
    if isinstance(value, list):
        return [as_json(one) for one in value]
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
