"""Recordings of an own rig with known truth: how the plate moves, what the instruments add, how the file is written.

``python -m tests.bench.recordings FOLDER`` writes all of them.
"""

from __future__ import annotations

import datetime
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path

import numpy as np

from pneutouch.bench.simulate.curve import PressCurve, press_curves
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.response import figures
from pneutouch.units import KPA

DEEP, CLEAR, ZERO = 6.5, -1.0, 41.3
"""Greatest travel after contact, the plate's clear place, and the rig's reading at first contact, mm."""
STEP = 0.5
HEADER = "time_s,position_mm,force_N,pressure_kPa"


@cache
def truth() -> PressCurve:
    """The pressed paper's sensor without driving pressure."""
    return press_curves(evaluate("paper-dome", model="atlas").sensor, [0.0], 6.9, model="atlas").curves[0]


def depths(steps: int = 13) -> np.ndarray:
    return np.linspace(DEEP / steps, DEEP, steps)


def true_figures(at: np.ndarray) -> dict[str, float]:
    """Figures of the truth from first contact over travels in mm."""
    travel = np.append(0.0, at)
    force, rise = truth().at(travel)
    got = figures(travel, force, rise / KPA)
    assert got is not None
    return {"sensitivity_kPa_per_N": got.sensitivity, "stiffness_N_per_mm": got.stiffness, "force_range_N": force[-1]}


def moved(legs: list[tuple[float, float]], rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and travels between even moves: seconds, and the travel at their end."""
    knots = np.cumsum([0.0, *(seconds for seconds, _ in legs)])
    time = np.arange(0.0, knots[-1], 1 / rate)
    return time, np.interp(time, knots, [CLEAR, *(travel for _, travel in legs)])


def presses(count: int) -> list[tuple[float, float]]:
    return [(2.0, CLEAR)] + count * [(7.5, DEEP), (7.5, CLEAR), (2.0, CLEAR)]


def stairs(*, back: bool) -> list[tuple[float, float]]:
    up = [leg for depth in depths() for leg in ((0.3, depth), (4.0, depth))]
    down = [leg for depth in depths()[-2::-1] for leg in ((0.3, depth), (4.0, depth))]
    return [(3.0, CLEAR), *up, *(down if back else []), *([(0.5, CLEAR), (3.0, CLEAR)] if back else [])]


def steps(overshoot: float = 0.0) -> list[tuple[float, float]]:
    legs = [(3.0, CLEAR)]
    for depth in depths():
        seconds = (depth - CLEAR) / 5
        legs += [(seconds, depth + overshoot), (0.1, depth), (4.0, depth), (seconds, CLEAR), (4.0, CLEAR)]
    return legs


@dataclass(frozen=True)
class Recording:
    """A recording: its moves, instruments and spelling. ``kind`` is what it shows, ``at`` the travels of its figures."""

    legs: list[tuple[float, float]] | None = field(default_factory=lambda: presses(3))
    kind: str = "loop"
    at: Callable[[], np.ndarray] = lambda: depths(25)
    noise: float = 0.02
    tare: float = 0.13
    ambient: float = 0.0
    drift: float = 0.0
    spoil: Callable[[np.ndarray], np.ndarray] = lambda samples: samples
    header: str = HEADER
    write: Callable[[np.ndarray, str], str] | None = None
    seed: int = 0

    def samples(self) -> np.ndarray:
        """(4, n): s, mm, N, kPa."""
        rng = np.random.default_rng(self.seed)
        if self.legs is None:
            time = np.arange(0.0, 30.0, 1 / 500)
            travel = CLEAR + (DEEP - CLEAR) * (1 - np.cos(2 * np.pi * time / 10)) / 2
        else:
            time, travel = moved(self.legs, 500)
        force, rise = truth().at(np.clip(travel, 0.0, None))
        return self.spoil(
            np.stack(
                [
                    time,
                    travel + ZERO + rng.normal(0, 0.003, time.size),
                    force + self.tare + rng.normal(0, self.noise, time.size),
                    rise / KPA + self.ambient + self.drift * time / 60 + rng.normal(0, 0.03, time.size),
                ]
            )
        )

    def text(self) -> str:
        return (self.write or plain)(self.samples(), self.header)


def plain(samples: np.ndarray, header: str) -> str:
    return header + "\n" + "\n".join(",".join(f"{value:.5f}" for value in row) for row in samples.T) + "\n"


def stamped(samples: np.ndarray, header: str, clock: str = "10:00:00", form: str = "%Y-%m-%dT%H:%M:%S.%f+00:00") -> str:
    begin = datetime.datetime.fromisoformat(f"2026-01-05T{clock}+00:00")
    times = [(begin + datetime.timedelta(seconds=float(second))).strftime(form) for second in samples[0]]
    rows = [
        ",".join([time, *(f"{value:.5f}" for value in row)]) for time, row in zip(times, samples[1:].T, strict=True)
    ]
    return header + "\n" + "\n".join(rows) + "\n"


def by_hand(samples: np.ndarray, header: str) -> str:
    return plain(samples[[0, 2, 3]], "time_s,force_N,pressure_kPa")


def without(*parts: tuple[int, int]) -> Callable[[np.ndarray], np.ndarray]:
    """Samples that are missing in the file."""

    def cut(samples: np.ndarray) -> np.ndarray:
        kept = np.ones(samples.shape[1], bool)
        for begin, end in parts:
            kept[begin:end] = False
        return samples[:, kept]

    return cut


def spiked(samples: np.ndarray, force: float) -> np.ndarray:
    """A sample of the rest that no plate makes."""
    samples[2, 400] = force
    return samples


READ = {
    "triangular": Recording(),
    "single press": Recording(presses(1)),
    "sine": Recording(None),
    "stairs without return": Recording(stairs(back=False), "steps", depths),
    "stairs with return": Recording(stairs(back=True), "steps", depths),
    "steps": Recording(steps(), "steps", depths),
    "hold": Recording([(3.0, CLEAR), (1.5, DEEP), (60.0, DEEP), (1.5, CLEAR), (3.0, CLEAR)], "relaxation"),
    "milliseconds": Recording(
        spoil=lambda s: s * np.array([[1e3], [1], [1], [1]]), header=HEADER.replace("time_s", "time_ms")
    ),
    "timestamps": Recording(header=HEADER.replace("time_s", "timestamp"), write=stamped),
    "times of day, past midnight": Recording(write=partial(stamped, clock="23:59:50", form="%H:%M:%S.%f")),
    "footer": Recording(write=lambda s, h: plain(s, h) + "# end of the test, 3 cycles, 42\n"),
    "drift": Recording(drift=-0.005),
    "gaps": Recording(spoil=without((5000, 9000), (12000, 15000))),
    "noise": Recording(noise=0.15),
    "slow": Recording([(4.0, CLEAR), (15.0, DEEP), (15.0, CLEAR), (2.0, CLEAR)]),
    "shallow second press": Recording([*presses(1), (6.5, 5.5), (6.5, CLEAR), (2.0, CLEAR)]),
    "touches before": Recording([(2.0, CLEAR), *2 * [(2.0, 1.0), (2.0, CLEAR), (2.0, CLEAR)], *presses(1)]),
    "stopped in the second press": Recording([*presses(1), (4.0, 3.0)]),
    "a peak after stairs": Recording([*stairs(back=True), (7.5, DEEP), (7.5, CLEAR), (2.0, CLEAR)], "steps", depths),
    "overshoot": Recording(steps(overshoot=0.12), "steps", depths),
    "short hold": Recording([(2.0, CLEAR), (7.5, DEEP), (2.0, DEEP), (7.5, CLEAR), (2.0, CLEAR)]),
    "long hold after a short rest": Recording(
        [(1.5, CLEAR), (0.5, DEEP), (400.0, DEEP), (0.5, CLEAR), (1.5, CLEAR)], "relaxation"
    ),
    "hold of ten seconds": Recording(
        [(3.0, CLEAR), (1.5, DEEP), (10.0, DEEP), (1.5, CLEAR), (3.0, CLEAR)], "relaxation"
    ),
    "spike": Recording(spoil=lambda s: spiked(s, 60.0)),
}
"""Recordings that give figures without a word more."""


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, recording in READ.items():
        (folder / f"{name.replace(' ', '-')}.csv").write_text(recording.text())


if __name__ == "__main__":
    main()
