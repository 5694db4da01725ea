"""Plan of a pad's measurement, balls pressed at a raster of places, and the campaign that simulated rigs make of it."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.gauge import reading_of
from pneutouch.formats import versioned
from pneutouch.mechanics.gauge_reading import PAPER_NOISE
from pneutouch.mechanics.touch.forward import PadAnswer, PadModel
from pneutouch.mechanics.touch.objects import random_objects, usual_ball
from pneutouch.output.files import check_writable, json_bytes, with_manifest, write_folder
from pneutouch.report.pages import filled
from pneutouch.spec.pad import PAD_CAMPAIGN, PadCampaign, PadRun, channels
from pneutouch.spec.read import Changes
from pneutouch.spec.toml_text import assignments, toml_text
from pneutouch.tables.csv_table import columns_csv
from pneutouch.units import KPA
from pneutouch.workflows.pad.build_pad import inputs
from pneutouch.workflows.pad.load import ResolvedPad
from pneutouch.workflows.pad.touch import Tabulate, pad_model, pad_pressure_kPa

_DEPTHS, _NEAR, _ASIDE, _TURN = (0.4, 0.7, 0.95), 1.05, 0.5, 2.4
"""Shares of the travel in contact; distance over the least one at which two cells are neighbours, between which the
ball is pressed too; distance from a cell's axis over its radius; turn from press to press, rad: our choice."""
_RESTS, _BY_HAND = 5, 40
"""Readings without contact before each place, and presses by hand of a simulated campaign."""
_SCATTER = {"force": 0.1, "rise": 0.03, "place_mm": 0.3}
"""Standard deviations of a simulated pad: of the logarithms of its factors, and of the stage's zero."""


class PadPlan(NamedTuple):
    """Places x, y and depths (m, 3), mm, of a ball on a pad, and what it is to read there, MPa and N."""

    pad: ResolvedPad
    model: PadModel
    radius: float
    presses: Array
    answer: PadAnswer

    @property
    def highest(self) -> int:
        """Number of a cell with the highest dome, from whose top depths count."""
        return 1 + int(np.argmax(self.model.of_cells("apex")))


def plan_pad(pad: ResolvedPad, made_by: Tabulate | None = None) -> PadPlan:
    """Presses of a ball on each cell and between neighbours, at the greatest driving pressure of the cell's design.

    Those on a cell are beside its axis, each in another direction: there readings tell the zero of the stage.

    Raises InputError as `pad_model` does."""
    model = pad_model(pad, pad_pressure_kPa(pad), made_by)
    radius, places = usual_ball(model), model.places
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1)) + np.diag(np.full(len(places), np.inf))
    pairs = [(j, k) for j, k in np.argwhere(apart <= _NEAR * apart.min()) if j < k]
    turns = _TURN * np.arange(len(_DEPTHS) * len(places)).reshape(-1, len(_DEPTHS))
    aside = _ASIDE * model.of_cells("radius")[:, None, None] * np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    between = np.array([0.5 * (places[j] + places[k]) for j, k in pairs]).reshape(-1, 1, 2)
    spots = np.concatenate([places[:, None] + aside, np.repeat(between, len(_DEPTHS), axis=1)])
    steps = np.linspace(0.0125, 1.0, 159) * model.deepest
    presses = []
    for spot, share in zip(spots.reshape(-1, 2), np.tile(_DEPTHS, len(spots)), strict=True):
        answer = model.under_balls(np.broadcast_to(spot, (len(steps), 2)), np.full(len(steps), radius), steps)
        touched = steps[answer.inside & (answer.rise.max(axis=1) > 0.0)]
        presses += [(*spot, float(np.quantile(touched, share)))] if touched.size else []
    rows: Array = np.round(np.array(presses, dtype=float), 2)
    return PadPlan(pad, model, radius, rows, model.under_balls(rows[:, :2], np.full(len(rows), radius), rows[:, 2]))


def write_pad_plan(plan: PadPlan, out: Path, changes: Changes | None = None) -> Path:
    """Write ``out/<pad>-plan/``: plan.md, presses.csv, and the campaign file to fill in; the same input, the same
    bytes."""
    name, count = f"{plan.pad.name}-plan", len(plan.model.places)
    check_writable(out / name)
    campaign = _campaign(plan, changes, [PadRun(file="runs/stage.csv")])
    expected = {
        **dict(zip(("x_mm", "y_mm", "depth_mm"), plan.presses.T, strict=True)),
        "force_N": plan.answer.force,
        **dict(zip(channels(count), plan.answer.rise.T / KPA, strict=True)),
    }
    sheet = filled("pad_plan.md.j2", plan=plan, campaign=campaign, channels=channels(count), file=PAD_CAMPAIGN)
    files = {"plan.md": sheet.encode(), "presses.csv": columns_csv(expected), PAD_CAMPAIGN: _text(campaign)}
    return write_folder(out / name, with_manifest(files, name, inputs(plan.pad)))


def simulate_pad(plan: PadPlan, out: Path, seed: int, changes: Changes | None = None) -> Path:
    """Write ``out/<pad>-campaign/``: recordings of a simulated pad on a stage and by hand, and its truth."""
    name, random, count = f"{plan.pad.name}-campaign", np.random.default_rng(seed), len(plan.model.places)
    check_writable(out / name)
    force, *rises = np.exp(random.standard_normal(1 + count) * ([_SCATTER["force"]] + [_SCATTER["rise"]] * count))
    shift = _SCATTER["place_mm"] * random.standard_normal(3)
    campaign = _campaign(
        plan, changes, [PadRun(file="runs/stage.csv"), PadRun(file="runs/hand.csv", kind="hand")], True
    )
    by_hand = random_objects(plan.model, "ball", _BY_HAND, random)
    by_hand[:, 2] = plan.model.table.radius / plan.radius
    files = {PAD_CAMPAIGN: _text(campaign)}
    for run, presses in zip(campaign.runs, (plan.presses + shift, by_hand[:, [0, 1, 3]]), strict=True):
        answer = plan.model.under_balls(presses[:, :2], np.full(len(presses), plan.radius), presses[:, 2])
        held = answer.inside
        columns = np.column_stack([presses - (shift if run.kind == "stage" else 0.0), answer.force * force])[held]
        rows = np.hstack([columns, answer.rise[held] / KPA * rises])
        # Between presses the ball is clear of the domes.
        rest = np.zeros((_RESTS, rows.shape[1]))
        rest[:, 2] = -1.0
        table = np.concatenate([np.concatenate([rest, row[None]]) for row in rows])
        table[:, 3] += campaign.force_resolution_N * random.standard_normal(len(table))
        rest_kPa = plan.model.of_cells("driving_pressure") / KPA
        table[:, 4:] += rest_kPa + noise_kPa(plan.pad) * random.standard_normal((len(table), count))
        heads = ["x_mm", "y_mm", "depth_mm", "force_N", *channels(count)]
        of_kind = dict(zip(heads, table.T, strict=True))
        files[run.file] = columns_csv({key: of_kind[key] for key in heads[0 if run.kind == "stage" else 3 :]})
    truth = {"force_factor": force, "rise_factors": rises, "stage_zero_mm": shift.tolist(), "seed": seed}
    files["pad-truth.json"] = json_bytes(versioned("pad-truth", truth))
    return write_folder(out / name, with_manifest(files, name, {**inputs(plan.pad), "seed": seed}))


def noise_kPa(pad: ResolvedPad) -> float:
    """Standard deviation of a reading of the cell's gauge, kPa; where it is unknown, of the paper's."""
    scatter = reading_of(pad.scene).scatter
    return (PAPER_NOISE if scatter is None else scatter) / KPA


def _campaign(plan: PadPlan, changes: Changes | None, runs: list[PadRun], simulated: bool = False) -> PadCampaign:
    pad = plan.pad
    known = pad.library.paths("pads").get(pad.name) == Path(pad.where)
    return PadCampaign(
        pad=pad.name if known else str(Path(pad.where).absolute()),
        assignments=assignments(changes or {}),
        driving_pressure_kPa=plan.model.table.driving_pressure / KPA,
        ball_radius_mm=plan.radius,
        simulated=simulated,
        runs=runs,
    )


def _text(campaign: PadCampaign) -> bytes:
    return toml_text(campaign.model_dump(mode="python")).encode()
