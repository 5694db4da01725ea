"""What ``tests.ratios`` measures: for each ratio the work, and the job that its time is divided by."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from benchmarks.store import LIBRARY, ROOT

from pneutouch.catalogue import load_scene
from pneutouch.units import KPA

Pair = tuple[Callable[[], object], Callable[[], object]]


def check_of_a_sensor(folder: Path) -> Pair:
    from pneutouch.evaluation.subject import subject_of
    from pneutouch.parts import assemble
    from pneutouch.printability import check
    from tests.parts.overlap import overlap_volume

    scene = load_scene("stiff-dome", None, LIBRARY)
    subject = subject_of(assemble(scene))

    def bodies() -> None:
        made = assemble(scene).bodies
        for one, other in itertools.combinations(made, 2):
            overlap_volume(one, other)

    return lambda: check(subject), lambda: [bodies() for _ in range(10)]


def trays(folder: Path) -> Pair:
    from tests.running import in_process

    example = str(ROOT / "docs/examples/seven-resins.toml")

    def tray(*words: str) -> None:
        assert in_process(["tray", *words], folder).returncode == 0

    return lambda: tray(example), lambda: tray("paper-dome", "--copies", "3")


def struts(folder: Path) -> Pair:
    from pneutouch.parts.specimen import Box, complement
    from pneutouch.parts.specimen.struts import Lattice, fill
    from tests.parts.specimen.shapes import STEP
    from tests.parts.specimen.test_speed import batch_of_hulls

    counts = (10, 4, 4)
    lattice, box = Lattice.of("bcc", 4.0, 0.35, STEP), Box((0.0, 0.0, 0.0), tuple(4.0 * n for n in counts))
    hulls = batch_of_hulls("bcc", lattice, counts)
    assert len(hulls) > 1000
    return lambda: complement(box, fill(lattice, box)), lambda: _batch(hulls)


def _batch(bodies: list, subtract: bool = False) -> int:
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(bodies, OpType.Subtract if subtract else OpType.Add).num_tri()


def bars(folder: Path) -> Pair:
    from manifold3d import Manifold

    from pneutouch.parts.specimen import Box, complement
    from tests.parts.specimen.shapes import bars_by_hand

    block = Box((0.0, 0.0, 0.0), (30_000.0, 20.0, 8.0))
    made = bars_by_hand(10_000, 3.0, 1.5, Box((0.0, 0.0, 7.0), (30_000.0, 20.0, 8.0)))
    unit = Manifold.cube((1.5, 20.0, 1.0))
    plain = [Manifold.cube((30_000.0, 20.0, 8.0)), *(unit.translate((3.0 * k, 0.0, 7.0)) for k in range(10_000))]
    return lambda: complement(block, made), lambda: _batch(plain, subtract=True)


def family(folder: Path) -> Pair:
    from pneutouch.parts.specimen import Box
    from tests.parts.specimen.shapes import bars_by_hand, context, drawn

    box = Box((0.0, 0.0, 7.0), (1000.0, 20.0, 8.0))
    return (
        lambda: drawn(context(1000, 20, 8), "bars", pitch_mm=2.0, width_mm=1.0, height_mm=1.0),
        lambda: bars_by_hand(500, 2.0, 1.0, box),
    )


def wavelets(folder: Path) -> Pair:
    from pneutouch.texture.scalogram import scalogram
    from pneutouch.texture.signal import Signal

    signal = Signal(0.0, 1e-4, np.random.default_rng(1).standard_normal(300_000))
    return lambda: scalogram(signal, 0.4, 8.0, per_octave=18), lambda: np.fft.rfft(signal.pressure)


def budgets(folder: Path) -> Pair:
    from pneutouch.mechanics.atlas.press import batch_of
    from pneutouch.mechanics.atlas.respond import respond
    from pneutouch.mechanics.paper_sensor import material_sensor
    from tests.mechanics.uncertainty.designs import budget_for, materials

    batch = batch_of(material_sensor(materials(LIBRARY)["TangoPlus"]), np.linspace(0.0, 0.015, 200).tolist())
    batch = replace(batch, wall_thickness=np.linspace(1.0, 2.0, 200))
    return lambda: budget_for(LIBRARY, batch, "TangoPlus", True), lambda: respond(batch)


def relaxation_and_loops(folder: Path) -> Pair:
    from pneutouch.mechanics.atlas.press import batch_of
    from pneutouch.mechanics.atlas.respond import respond
    from pneutouch.mechanics.viscous.runs import loop, relaxation
    from tests.mechanics.viscous.test_follow import SENSOR, A

    def work() -> None:
        relaxation(SENSOR, [A], [0.0], 4.625, 5.0)
        for speed in (0.5, 5.0):
            loop(SENSOR, [A], [0.0], 4.625, speed)

    return work, lambda: respond(batch_of(SENSOR, [0.0]), 14)


def _one_of_the_solid() -> Callable[[], object]:
    """The paper's sensor at one pressure, each time with another dead volume: mesh, inflation and press."""
    from benchmarks.scenes import PAPER

    from pneutouch.mechanics import predict

    sensors = (PAPER.replace(dead_volume=1e-6 * number) for number in itertools.count(1))
    return lambda: predict("", next(sensors), [0.012], model="solid")


def order_zero(folder: Path, friction: float = 0.0) -> Pair:
    from pneutouch.mechanics.models.choice import model_named
    from pneutouch.mechanics.paper_sensor import material_sensor

    pressed = material_sensor(LIBRARY.load("materials", "TangoPlus")).replace(friction=friction)
    pressures = np.array([0.0, 12.0, 22.0]) * KPA
    harmonic, solid = model_named("harmonic"), model_named("solid")
    return lambda: harmonic.answer_one(pressed, pressures), lambda: solid.answer_one(pressed, pressures)


def atlas_batch(folder: Path) -> Pair:
    from pneutouch.mechanics.atlas.respond import respond
    from tests.mechanics.atlas.sampled import random_batch

    return partial(respond, random_batch(1000, 1)), _one_of_the_solid()


def atlas_single(folder: Path) -> Pair:
    from pneutouch.mechanics.atlas.respond import respond
    from tests.mechanics.atlas.sampled import random_batch

    return partial(respond, random_batch(1, 1)), _one_of_the_solid()


def sway(folder: Path) -> Pair:
    from benchmarks.scenes import PAPER

    from pneutouch.mechanics import predict

    def solved(waves: int) -> Callable[[], object]:
        return lambda: predict("", PAPER.replace(waves=waves), [0.0, 0.005, 0.012, 0.022], model="solid")

    return solved(8), solved(0)


def reading(folder: Path) -> Pair:
    import pandas as pd

    from pneutouch.bench.curve import curve_of
    from pneutouch.bench.reading import PLATE, read_blocks
    from pneutouch.bench.source import identify
    from pneutouch.spec.campaign import CampaignRun, ColumnMap, Rig
    from tests.bench.test_reading_speed import long_file

    path = long_file(folder / "long.csv", 15.0)
    assert path.stat().st_size > 90e6
    run = CampaignRun(file="x", sensor="A", resin="r", driving_pressure_kPa=12)
    return lambda: curve_of(run, read_blocks(identify(path, ColumnMap(), PLATE), Rig()), Rig()), lambda: pd.read_csv(
        path
    )


def fit_of_curves(folder: Path) -> Pair:
    from pneutouch.bench.calibrate.fit import fit
    from pneutouch.bench.calibrate.observations import Observations
    from pneutouch.bench.calibrate.parameters import NAMES
    from pneutouch.mechanics.atlas.press import batch_of
    from pneutouch.mechanics.atlas.respond import respond
    from tests.bench.calibrate.sensors import DESIGNED, chosen, curves, other
    from tests.bench.calibrate.test_fit import TRUTH

    pressures = np.linspace(0, 22, 10)
    seen = curves(other(**TRUTH), pressures, 4, np.random.default_rng(1))
    assert len(seen) == 40
    batch = batch_of(DESIGNED, [p * KPA for p in pressures])
    parameters = chosen(LIBRARY, *NAMES)
    return lambda: fit(Observations(seen), DESIGNED, parameters), lambda: [respond(batch) for _ in range(100)]


def voxels(folder: Path) -> Pair:
    from pneutouch.parts import assemble
    from pneutouch.workflows.build_voxels import plan_voxels, write_voxels

    plan = plan_voxels(assemble(load_scene("graded-dome", None, LIBRARY)), mode="High Mix", library=LIBRARY)
    grid, rng = plan.job.raster, np.random.default_rng(1)
    return (
        lambda: write_voxels(plan, folder, "abc"),
        lambda: [rng.random((len(grid.y), len(grid.x))) for _ in range(len(grid.z))],
    )
