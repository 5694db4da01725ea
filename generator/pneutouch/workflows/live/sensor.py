"""Sensors and pads that can be read live, and their simulated devices."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol

from pneutouch.bench.indents import protocol
from pneutouch.bench.simulate.curve import stopped
from pneutouch.bench.simulate.runs import SimulationTruth, within
from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.reader import reader_grid
from pneutouch.evaluation.reader_tables import reader_tables
from pneutouch.evaluation.resins import pressed, tested_kPa
from pneutouch.export.reader.reading import ForceReader
from pneutouch.formats import versioned
from pneutouch.mechanics.models.choice import model_options
from pneutouch.results.plan import PlannedRun
from pneutouch.results.record import plain
from pneutouch.spec.read import Changes
from pneutouch.spec.values import plain_number
from pneutouch.units import KPA
from pneutouch.workflows.live.protocol import DeviceName
from pneutouch.workflows.live.readers import DomeReader, LiveReader
from pneutouch.workflows.live.simulated import RATE_HZ, DeviceRow, SimulatedDevice, SimulatedRig

SIMULATED = "simulated"
_FASTEST = 100.0


class LiveRig(Protocol):
    """A simulated rig with a sensor or a pad."""

    def idle(self) -> Iterator[DeviceRow]:
        """Rows without end, with touches now and then."""

    def run(self, run: PlannedRun) -> Iterator[DeviceRow]:
        """Rows of a run of a plan."""


@dataclass(frozen=True)
class LiveSensor:
    """A sensor or pad that can be read live: its name, its reader, whether every sample is read, and its simulated rig
    at a driving pressure, kPa (None: the usual one)."""

    name: str
    reader: LiveReader
    each: bool
    rig: Callable[[float | None], LiveRig]

    def device(self, pressure_kPa: float | None, faster: float) -> SimulatedDevice:
        """Its simulated device. Raises InputError for a driving pressure that it does not bear."""
        return SimulatedDevice(DeviceName(self.name, self.reader.cells), self.rig(pressure_kPa).idle, RATE_HZ, faster)


def live_sensor(design: str | DesignSource, changes: Changes | None = None) -> LiveSensor:
    """The reader of a design, by the cheapest model that is good enough. Raises InputError as `reader_grid`."""
    evaluation = evaluate(design, changes, **model_options("auto", None))
    tables = reader_tables(evaluation, reader_grid(evaluation))
    reader = DomeReader(ForceReader(versioned("reader", plain(tables))))
    return LiveSensor(evaluation.scene.name, reader, True, lambda pressure_kPa: _rig(evaluation, pressure_kPa))


def _rig(evaluation: Evaluation, pressure_kPa: float | None) -> SimulatedRig:
    """Simulated rig at a driving pressure, the design's first for None. Raises InputError beyond the limit point."""
    sensor, truth = evaluation.sensor, SimulationTruth().rig
    at = (tested_kPa(evaluation.scene)[0] if pressure_kPa is None else pressure_kPa) * KPA
    height = sensor.dome.shape.height
    depth = max(protocol("saturation", height).depths)
    curves = pressed(evaluation.scene.name, sensor, [at], depth, "auto")
    (curve,) = stopped(curves, truth.force_range, truth.pressure_range).curves
    return SimulatedRig(curve, truth, RATE_HZ, lambda kind: within(protocol(kind, height), curve.reach))


def faster_of(port: str) -> float | None:
    """Speed of a simulated device's clock over ours; None for a port of the machine.

    ``simulated`` goes as ours, ``simulated:20`` 20 times as fast. Raises InputError for another number."""
    name, colon, number = port.partition(":")
    if name != SIMULATED:
        return None
    try:
        faster = plain_number(number) if colon else 1.0
    except ValueError:
        faster = 0.0
    if not 1.0 <= faster <= _FASTEST:
        problem = f"must be a number from 1 to {_FASTEST:g} after the colon"
        raise InputError(problem, key="port", value=port, remedy="such as simulated:20, or simulated alone")
    return faster
