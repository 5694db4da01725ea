"""Gauges and step blocks: what one printer makes of small features and of lengths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pneutouch.bench.finding import CouponFindings, MeasuredFigure, ProfileChange, ReadingSource, rounded
from pneutouch.bench.statistics import mean
from pneutouch.errors import InputError
from pneutouch.parts.coupons import COUPONS, CouponContext
from pneutouch.spec.coupon import Gauge, GaugeSize
from pneutouch.spec.material import Material
from pneutouch.spec.printer import HOLE_UNDERSIZE_MM, Printer

_AXES = ("x", "y", "z")
_INSTRUMENT = 0.01
"""mm: what a caliper resolves; no accuracy is claimed below it."""

_SLIP = 0.1
"""A length of the block more than this share off its nominal is taken for a slip of the pen."""

_FINE_SLIP, _FINE_SLIP_MM = 0.5, 0.3
"""So is a wall, pin, hole or slot that is off by more than this share and by more than this many mm: our own choice, some
times what vendors state for small features."""

_ROUNDING = 1e-9
"""Differences of lengths may miss a limit by this, mm."""

MeasuredGauges = Sequence[tuple[str, Material, Gauge]]
"""Gauges of one printer: name of the material, the material and the readings."""


def gauges(name: str, printer: Printer, measured: MeasuredGauges, said: ReadingSource, found: CouponFindings) -> None:
    """Accuracy, holes and smallest features of a printer. Raises InputError for sizes that the gauge does not have."""
    for material_name, material, gauge in measured:
        _check_sizes(gauge, material, f"{said.where}: gauge.{name}.{material_name}")
    _accuracy(name, measured, said, found)
    _holes(name, measured, said, found)
    for key, row, kinds in (
        ("wall_soft_mm", "wall", ("elastomer",)), ("wall_rigid_mm", "wall", ("rigid",)),
        ("pin_soft_mm", "pin", ("elastomer",)), ("pin_rigid_mm", "pin", ("rigid",)),
        ("hole_mm", "hole", ("elastomer", "rigid")), ("gap_mm", "slot", ("elastomer", "rigid")),
    ):  # fmt: skip
        rows = [getattr(gauge, row) for _, material, gauge in measured if material.kind in kinds]
        _least(name, key, row, rows, getattr(printer.smallest, key).model_dump(exclude_none=True), said, found)


def _check_sizes(gauge: Gauge, material: Material, where: str) -> None:
    known: dict[str, list[float]] = {}
    for nominal in COUPONS["gauge"].nominals(CouponContext(material)):
        known.setdefault(nominal.feature, []).append(nominal.value or 0.0)
    for row, sizes in known.items():
        seen: set[float] = set()
        for size in getattr(gauge, row):
            if size.nominal_mm not in sizes:
                has = ", ".join(f"{value:g}" for value in sizes)
                raise InputError(f"{where}.{row}: nominal_mm = {size.nominal_mm:g}: not on the gauge, which has {has}")
            if size.nominal_mm in seen:
                raise InputError(
                    f"{where}.{row}: nominal_mm = {size.nominal_mm:g}: there twice; put all readings in one"
                )
            seen.add(size.nominal_mm)
            _check_slip(row, size, where)


def _check_slip(row: str, size: GaugeSize, where: str) -> None:
    nominal = size.nominal_mm
    limit = _SLIP * nominal if row in _AXES else max(_FINE_SLIP_MM, _FINE_SLIP * nominal)
    for reading in size.measured_mm:
        if abs(reading - nominal) > limit + _ROUNDING:
            share = "a tenth" if row in _AXES else f"{_FINE_SLIP_MM:g} mm and half"
            raise InputError(
                f"{where}.{row}: nominal_mm = {nominal:g}: measured_mm = {reading:g}: more than {share} off; must be from "
                f"{max(nominal - limit, 0):g} to {nominal + limit:g} mm; read in another unit, or entered in the wrong row?"
            )


def _accuracy(name: str, measured: MeasuredGauges, said: ReadingSource, found: CouponFindings) -> None:
    sizes = [size for *_, gauge in measured for axis in _AXES for size in getattr(gauge, axis) if size.measured_mm]
    if not sizes:
        return
    deviations = np.array([mean(size.measured_mm).value - size.nominal_mm for size in sizes])
    worst = max(rounded(float(np.abs(deviations).max())), _INSTRUMENT)
    content = {
        "value": worst, "low": rounded(float(np.abs(deviations).min())), "high": worst,
        "source": said.source("greatest deviation of a length of the step block, 5 to 20 mm; low: least", len(sizes)),
    }  # fmt: skip
    found.changes.append(ProfileChange("printers", name, ("accuracy_mm",), content))
    found.figures.append(MeasuredFigure(name, "accuracy, mm", worst, None, len(sizes)))
    found.figures.append(
        MeasuredFigure(name, "mean deviation of lengths, mm", float(deviations.mean()), None, len(sizes))
    )


def _holes(name: str, measured: MeasuredGauges, said: ReadingSource, found: CouponFindings) -> None:
    holes = [hole for *_, gauge in measured for hole in gauge.hole if hole.measured_mm]
    if not holes:
        return
    if len(holes) < 2:
        raise InputError(f"{said.where}: gauge.{name}: 1 hole measured; at least 2, so that a spread can be told")
    smaller = [_smaller(hole, f"{said.where}: gauge.{name}.hole") for hole in holes]
    over = mean(smaller)
    content = {
        "value": rounded(over.value), "low": rounded(min(smaller)), "high": rounded(max(smaller)),
        "spread": rounded(over.spread),
        "source": said.source("nominal less measured diameter of upright holes; low and high: least and greatest hole", over.count),
    }  # fmt: skip
    found.changes.append(ProfileChange("printers", name, ("hole_undersize_mm",), content))
    found.figures.append(MeasuredFigure(name, "holes too small by, mm", over.value, over.spread, over.count))


def _smaller(hole: GaugeSize, where: str) -> float:
    """By how much a hole is too small, mm. Raises InputError where no printer profile may say so."""
    average = mean(hole.measured_mm).value
    less, (low, high) = hole.nominal_mm - average, HOLE_UNDERSIZE_MM
    if not low - _ROUNDING <= less <= high + _ROUNDING:
        raise InputError(
            f"{where}: nominal_mm = {hole.nominal_mm:g}: mean of measured_mm = {average:.4g} makes hole_undersize_mm = "
            f"{less:.4g}; it must be from {low:g} to {high:g} mm; entered in the wrong row?"
        )
    return less


def smallest_sound(sizes: Sequence[GaugeSize]) -> float | None:
    """The smallest that came out together with all larger ones, mm; None where the largest did not, or nothing is said."""
    least = None
    for size in sorted(sizes, key=lambda size: -size.nominal_mm):
        if size.sound is False:
            break
        if size.sound:
            least = size.nominal_mm
    return least


def _least(
    name: str, key: str, row: str, rows: list[list[GaugeSize]], shipped: dict[str, Any], said: ReadingSource, found: CouponFindings
) -> None:  # fmt: skip
    """The worse of several gauges counts."""
    told = [sizes for sizes in rows if any(size.sound is not None for size in sizes)]
    if not told:
        return
    leasts = [smallest_sound(sizes) for sizes in told]
    if any(least is None for least in leasts):
        found.notes.append(f"{name}: no {row} came out together with all larger ones; {key} stays as it was")
        return
    least = max(least for least in leasts if least is not None)
    count = sum(size.sound is not None for sizes in told for size in sizes)
    was = str(shipped["source"])
    recommended = was.partition("recommended: ")[2] or was
    content = {
        "least": least, "recommended": max(float(shipped["recommended"]), least),
        "source": f"least: {said.source(f'the smallest {row} that came out together with all larger ones', count)}; recommended: {recommended}",
    }  # fmt: skip
    found.changes.append(ProfileChange("printers", name, ("smallest", key), content))
    found.figures.append(MeasuredFigure(name, f"smallest {row} ({key.removesuffix('_mm')}), mm", least, None, count))
