"""The leak of a sensor as it was measured: by the leak-test cap, or by the leak runs of a campaign."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.bench.finding import CouponFindings, ReadingSource
from pneutouch.bench.volume import leak
from pneutouch.errors import InputError
from pneutouch.formats import check_format
from pneutouch.mechanics.sealed_gas import SealedGas, conductance_of_cap
from pneutouch.parts import Assembly
from pneutouch.spec.coupon import LeakCap, read_results
from pneutouch.spec.files import read_bytes
from pneutouch.units import KPA

_MOST_BYTES = 100_000_000


@dataclass(frozen=True)
class LeakSource:
    """A measured leak: fall of the pressure in kPa/min at a gauge pressure in kPa, and where it was measured.

    ``cap``: behind the leak-test cap, in the gas of connector and tube alone; else on the sensor itself.
    """

    rate_kPa_per_min: float
    pressure_kPa: float
    cap: bool
    where: str

    def conductance(self, gas: SealedGas, assembly: Assembly) -> float:
        """Conductance of the leak, mm3/s: see `mechanics.sealed_gas`."""
        rate = self.rate_kPa_per_min * KPA / 60.0
        if self.cap:
            volume = gas.dead_volume or assembly.internal_volume + assembly.tube_volume
        else:
            volume = float(np.interp(self.pressure_kPa * KPA, gas.pressure, gas.capacity))
        return max(0.0, conductance_of_cap(rate, self.pressure_kPa * KPA, volume))


def read_leak(path: Path, design: str) -> LeakSource:
    """The leak of a design from a results file of coupons (TOML) or the folder or figures.json of `characterize`.

    Raises InputError for other files, for another design and where no leak was measured.
    """
    if path.is_dir():
        path = path / "figures.json"
    return _of_campaign(path, design) if path.suffix.lower() == ".json" else _of_cap(path, design)


def _of_cap(path: Path, design: str) -> LeakSource:
    results = read_results(path)
    cap: LeakCap | None = results.leak_cap.get(design)
    if cap is None:
        known = ", ".join(results.leak_cap)
        remedy = f"it holds leak-cap of {known}" if known else "measure the coupon leak-cap: docs/howto/coupons.md"
        raise InputError("no leak of this design", file=path, key=f"leak-cap.{design}", remedy=remedy)
    findings = CouponFindings()
    try:
        leak(design, cap, 0.0, ReadingSource(str(path), results.lab, results.date), findings)
    except ValueError as error:
        raise InputError(str(error), file=path, key=f"leak-cap.{design}.start_kPa") from None
    if not findings.figures:
        raise InputError("empty", file=path, key=f"leak-cap.{design}.start_kPa", remedy="fill in the readings")
    mean_kPa = float(np.mean(cap.start_kPa + cap.end_kPa))
    if mean_kPa <= 0:
        raise InputError("no pressure to lose", file=path, key=f"leak-cap.{design}.start_kPa", value=cap.start_kPa)
    return LeakSource(findings.figures[0].value, mean_kPa, True, f"leak-cap in {path}")


def _of_campaign(path: Path, design: str) -> LeakSource:
    try:
        content: Any = json.loads(read_bytes(path, _MOST_BYTES, "figures.json"))
        check_format("figures", content, path)
        measured, rows = content["design"], [row for row in content["injections"] if row["unit"] == "kPa/min"]
        rates = [(float(row["value"]), float(row["figure"].split(",")[1].split()[0])) for row in rows]
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, OverflowError, RecursionError):
        raise InputError("not as characterize writes it", file=path, remedy="give a folder of its results") from None
    if measured != design:
        raise InputError(f"measured {measured}, not this design", file=path, key="design", value=measured)
    if not np.isfinite(rates).all():
        raise InputError("a leak that is no finite number", file=path, key="injections", remedy="characterize again")
    rates = [(rate, pressure_kPa) for rate, pressure_kPa in rates if pressure_kPa > 0]
    if not rates:
        raise InputError("holds no leak run above 0 kPa", file=path, remedy="plan one: docs/howto/measuring.md")
    # The conductance is rate over pressure: its mean over the runs at their mean pressure.
    mean_kPa = float(np.mean([pressure_kPa for _, pressure_kPa in rates]))
    share = float(np.mean([rate / pressure_kPa for rate, pressure_kPa in rates]))
    return LeakSource(share * mean_kPa, mean_kPa, False, f"leak runs in {path}")
