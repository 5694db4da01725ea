"""A simulated device at a pseudo-terminal: the predicted sensor on the simulated rig, with noise, leak and touches.

It speaks the lines of the sketch. Left alone it is touched now and then; a run of a plan it plays as its rig would.
"""

import contextlib
import os
import threading
import time
import tty
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.indents import CLEARANCE, RunProtocol
from pneutouch.bench.simulate.curve import PressCurve
from pneutouch.bench.simulate.rig import RigModel
from pneutouch.bench.simulate.runs import simulate_leak, simulate_run
from pneutouch.results.plan import PlannedRun
from pneutouch.spec.campaign import RunKind
from pneutouch.units import KPA
from pneutouch.workflows.live.protocol import DeviceName, DeviceSample, name_line, sample_line

RATE_HZ = 100.0
"""Samples a second, as the sketch sends them."""

_PAUSE_S = 0.004
_FREE_S, _PRESS_S = (2.5, 6.0), (0.6, 2.5)
_RAMP_S = 0.3
_DEEPEST = 0.9
_FIRST_FREE_S = 3.5
"""Time between touches and length of one, seconds from and to; of its way in or out; greatest share of the range; and
time before the first, so that a zero can be taken: our choice."""

_FILLED_S = 600.0
"""Time after which it is filled anew, as its leak goes on for as long as somebody watches: our choice."""

_GRID = 400
_BLOCK = 256
"""Samples that are made at once."""


DeviceRow = tuple[float, ...]
"""Travel mm, force N, and pressures of the cells, kPa."""


class SimulatedRig:
    """Readings of the predicted sensor at ``rate`` Hz; ``curve`` is its press, ``protocol`` gives that of a kind of run
    within its range."""

    def __init__(
        self, curve: PressCurve, rig: RigModel, rate: float, protocol: Callable[[RunKind], RunProtocol], seed: int = 0
    ) -> None:
        self._curve, self._rig, self._rate, self._protocol, self._seed = curve, rig, rate, protocol, seed

    def idle(self) -> Iterator[DeviceRow]:
        """Rows without end: touches now and then."""
        curve, random, start = self._curve, np.random.default_rng(self._seed), 0
        drift, (noise_N, noise) = self._rig.drift(curve.driving), self._rig.noise(self._rate)
        grid = np.linspace(0.0, curve.reach, _GRID)
        force, rise = curve.at(grid)
        for travel in touches(curve.reach, self._rate, random):
            at = np.maximum(travel, 0.0)
            seconds = (start + np.arange(len(at))) / self._rate
            pressure = curve.driving + drift * (seconds % _FILLED_S) + np.interp(at, grid, rise)
            read = self._rig.stepped(pressure + noise * random.standard_normal(len(at)))
            pressed = np.interp(at, grid, force) + noise_N * random.standard_normal(len(at))
            start += len(at)
            yield from zip(travel.tolist(), pressed.tolist(), (read / KPA).tolist(), strict=True)

    def run(self, run: PlannedRun) -> Iterator[DeviceRow]:
        """Rows of a run of a plan from where its record begins to its planned end. Where the range ends before a depth,
        the object stays away for the rest of the run."""
        random, rig = np.random.default_rng([self._seed, run.number]), replace(self._rig, missed=0.0)
        if run.kind == "leak":
            record = simulate_leak(self._curve.driving, run.steps[-1].seconds, rig, self._rate, random)
        else:
            record = simulate_run(self._curve, self._protocol(run.kind), rig, self._rate, random)
        begun = next(k for k, step in enumerate(run.steps) if step.action == "record")
        planned = round(sum(step.seconds for step in run.steps[begun:]) * self._rate) + 1
        rest = simulate_leak(
            self._curve.driving, max(planned - record.time.size, 0) / self._rate, rig, self._rate, random
        )
        columns = record.position, record.force, record.pressure / KPA
        yield from zip(*(one.tolist() for one in columns), strict=True)
        for force, pressure_kPa in zip(rest.force.tolist(), (rest.pressure / KPA).tolist(), strict=True):
            yield -CLEARANCE, force, pressure_kPa


def touches(reach: float, rate: float, random: np.random.Generator) -> Iterator[Array]:
    """Travels of an object, mm, below zero without contact: a pause and a touch at a time."""
    free = _FIRST_FREE_S
    while True:
        depth, press = reach * _DEEPEST * random.uniform(0.2, 1.0), random.uniform(*_PRESS_S)
        knots = np.cumsum([0.0, free, _RAMP_S, press, _RAMP_S])
        travels = np.array([-CLEARANCE, -CLEARANCE, depth, depth, -CLEARANCE])
        yield np.interp(np.arange(round(knots[-1] * rate)) / rate, knots, travels)
        free = random.uniform(*_FREE_S)


class SimulatedDevice:
    """A device at a pseudo-terminal, ``port``; its clock goes ``faster`` times as fast as ours."""

    def __init__(
        self, name: DeviceName, rows: Callable[[], Iterator[DeviceRow]], rate: float, faster: float = 1.0
    ) -> None:
        self._name, self._rows, self._rate, self._faster = name, rows(), rate, faster
        self._master, slave = os.openpty()
        tty.setraw(slave)
        self.port = os.ttyname(slave)
        self._slave = slave
        os.set_blocking(self._master, False)
        self._number = 0
        self._lock, self._ended = threading.Lock(), threading.Event()
        self._began, self._day = time.monotonic(), time.time()
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def play(self, rows: Iterator[DeviceRow], after: Callable[[], Iterator[DeviceRow]]) -> int:
        """Send these rows next, and then those of ``after``; returns the number of the first one."""
        with self._lock:
            self._rows = _then(rows, after)
            return self._number

    def made(self, number: int) -> float:
        """Time of day, s, at which a sample was made."""
        return self._day + number / self._rate / self._faster

    def _work(self) -> None:
        while not self._ended.wait(_PAUSE_S):
            self._answer()
            due = int((time.monotonic() - self._began) * self._rate * self._faster) - self._number
            while due > 0:
                self._send(min(due, _BLOCK))
                due -= _BLOCK

    def _answer(self) -> None:
        with contextlib.suppress(BlockingIOError, OSError):
            if b"?" in os.read(self._master, 64):
                os.write(self._master, name_line(self._name))

    def _send(self, count: int) -> None:
        lines = bytearray()
        with self._lock:
            for _ in range(count):
                position, force, *pressures_kPa = next(self._rows)
                time_ms = 1e3 * self._number / self._rate
                lines += sample_line(DeviceSample(self._number, time_ms, tuple(pressures_kPa), force, position))
                self._number += 1
        left = memoryview(lines)
        while left and not self._ended.is_set():
            try:
                left = left[os.write(self._master, left) :]
            except BlockingIOError:
                # Nobody reads fast enough: the device's buffer is full, and it waits.
                time.sleep(_PAUSE_S)
            except OSError:
                return

    def close(self) -> None:
        """End the device."""
        self._ended.set()
        self._thread.join()
        for one in (self._master, self._slave):
            os.close(one)


def _then(rows: Iterator[DeviceRow], after: Callable[[], Iterator[DeviceRow]]) -> Iterator[DeviceRow]:
    yield from rows
    yield from after()
