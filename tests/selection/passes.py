"""Random targets: what `select` saves must pass `check` and build.

``python -m tests.selection.passes 500 [FIRST [BUILDS]]`` tries the seeds from FIRST (0) up to 500 and builds the first
BUILDS (0) designs that pass.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.spec.target import Target
from pneutouch.workflows.build import build
from pneutouch.workflows.select.search import FoundChoice
from pneutouch.workflows.select.select import SelectionRun, select
from tests.catalogue.store import printed_combinations
from tests.conftest import ROOT
from tests.selection.targets import target

LIBRARY = Library((ROOT,))
PARTS = printed_combinations(LIBRARY)
SOFT = ["TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985"]
"""Resins of the default printer; one or two are chosen from, so that a target costs less than the search of all."""


def random_target(rng: np.random.Generator) -> Target:
    """A target of what users may ask for, alone and together: a third on parts of the connector drawn at random."""

    def maybe(share: float, value: Any) -> Any:
        return value if rng.random() < share else None

    def log(low: float, high: float) -> float:
        return round(float(np.exp(rng.uniform(np.log(low), np.log(high)))), 3)

    wanted = {
        "sensitivity_kPa_per_N": log(0.1, 8.0),
        "driving_pressure_kPa": maybe(0.5, round(float(rng.uniform(0, 30)), 1)),
        "force_range_N": maybe(0.2, log(0.5, 20.0)),
        "max_diameter_mm": maybe(0.1, log(14.0, 80.0)),
        "max_footprint_mm": maybe(0.2, log(24.0, 100.0)),
        "fits": maybe(0.25, f"finger:{rng.integers(8, 40)}"),
    }
    if rng.random() < 0.1:
        del wanted["sensitivity_kPa_per_N"]
        wanted["force_range_N"] = log(0.5, 40.0)
    given = {
        "inner_radius_mm": maybe(0.1, log(3.0, 30.0)),
        "wall_thickness_mm": maybe(0.1, log(0.6, 2.5)),
        "materials": sorted({str(name) for name in rng.choice(SOFT, size=2)}),
    }
    changes = []
    if rng.random() < 0.35:
        port, seat, mount = PARTS[rng.integers(len(PARTS))]
        changes += [f"connector.port={port}", f"connector.seat={seat}"]
        changes += [] if wanted["fits"] else [f"connector.mount={mount}"]
        if seat == "one-piece":
            changes += ["print.connector_profile=objet260-connex", "connector.material=VeroClear"]
    if rng.random() < 0.15:
        changes.append(f"indentation.plate_diameter_mm={log(5.0, 60.0)}")
    setting = {"assignments": changes, "tube_length_mm": maybe(0.2, log(20.0, 2000.0))}
    return target(_given(wanted), given=_given(given), setting=_given(setting))


def _given(fields: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in fields.items() if value is not None}


def saved(selection: SelectionRun, folder: Path) -> Evaluation:
    """What `check` makes of the file that ``--write`` makes of a selection's best design."""
    assignments = selection.assignments(selection.answer.designs[0])
    path = FoundChoice("1", selection.base, assignments).write("found", folder, overwrite=True)
    return evaluate(str(path), library=LIBRARY)


def fate(seed: int, folder: Path, *, built: bool = False) -> tuple[str, SelectionRun | None]:
    """``passes``, or why nothing was saved; AssertionError where the saved design breaks a rule or is refused.

    ``built``: whether a design that passes is built whole as well.
    """
    try:
        asked = random_target(np.random.default_rng(40_000 + seed))
        selection = select(asked, "target", LIBRARY, written=1)
    except (InputError, ValidationError):
        return "target refused", None
    if not selection.answer.designs:
        return ("all rejected" if selection.rejected else "not met"), selection
    try:
        evaluation = saved(selection, folder)
    except InputError as error:
        raise AssertionError(f"seed {seed}: {asked!r}: {error}") from error
    broken = [f for f in evaluation.findings if f.severity == "error"]
    assert not broken, f"seed {seed}: {asked!r}: {broken}"
    if built:
        written = build(evaluation, folder / "outputs")
        assert (written / f"{evaluation.scene.name}.3mf").stat().st_size > 0
    return "passes", selection


def tally(seeds: range, builds: int = 0) -> tuple[Counter[str], Counter[str]]:
    """Fates, and the reasons for which candidates were rejected before; the first ``builds`` saved are built whole."""
    fates: Counter[str] = Counter()
    reasons: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        for seed in seeds:
            what, selection = fate(seed, Path(folder), built=fates["passes"] < builds)
            fates[what] += 1
            reasons.update(f"{one.rule}: {one.reason[:60]}" for one in (selection.rejected if selection else ()))
    return fates, reasons


if __name__ == "__main__":
    end, first, builds = (int(word) for word in [*sys.argv[1:], *"00"][:3])
    print(*tally(range(first, end), builds), sep="\n")  # noqa: T201
