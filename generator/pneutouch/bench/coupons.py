"""Results of coupons: changes of profiles, figures and notes from gauges, step blocks, leak caps and plugs."""

import datetime
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from pneutouch.bench.statistics import Mean, dead_volume, mean
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from pneutouch.parts.coupons import COUPONS, CouponContext
from pneutouch.parts.coupons.volume_plug import WATER, cavity_size, cavity_volume
from pneutouch.results.coupons import MeasuredFigure
from pneutouch.spec.coupon import FeatureGauge, GaugeSize, LeakCap, VolumePlug
from pneutouch.spec.material import Material
from pneutouch.spec.printer import HOLE_UNDERSIZE_MM, FeatureSize, Printer
from pneutouch.units import ML
from pneutouch.wording import rounded

MARK = "measured on coupons"
"""Part of the source of every quantity that was measured on a coupon."""

DIGITS = 4
"""Significant digits of a measured quantity: more than a reading has."""


@dataclass(frozen=True, slots=True)
class ProfileChange:
    """A measured quantity of a profile: kind and name of the profile, the keys of the quantity, its content."""

    kind: Literal["materials", "printers"]
    name: str
    keys: tuple[str, ...]
    content: dict[str, Any]


@dataclass
class CouponFindings:
    """Changes of profiles, figures and notes, collected coupon by coupon."""

    changes: list[ProfileChange] = field(default_factory=list)
    figures: list[MeasuredFigure] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def change(self, kind: Literal["materials", "printers"], name: str, keys: tuple[str, ...], **content: Any) -> None:
        """Add a quantity of a profile."""
        self.changes.append(ProfileChange(kind, name, keys, content))

    def figure(
        self, about: str, name: str, value: float, spread: float | None = None, count: int | None = None
    ) -> None:
        """Add a figure."""
        self.figures.append(MeasuredFigure(about, name, value, spread, count))


@dataclass(frozen=True, slots=True)
class ReadingSource:
    """Origin of readings: ``where`` is the results file for messages, lab and date are part of every source."""

    where: str
    lab: str
    date: datetime.date

    def source(self, how: str, count: int) -> str:
        """The source of a measured quantity."""
        return f"{MARK}: {how}; n = {count}; {self.lab}, {self.date.isoformat()}"


_AXES = ("x", "y", "z")
_INSTRUMENT = 0.01
"""Resolution of a caliper, mm; no accuracy is claimed below it."""

_SLIP = 0.1
"""Relative deviation from nominal above which a length of the step block counts as a writing error."""

_FINE_SLIP, _FINE_SLIP_MM = 0.5, 0.3
"""Deviations from nominal, relative and in mm; a wall, pin, hole or slot above both counts as a writing error: our
choice, several times the tolerance that vendors state for small features."""

_ROUNDING = 1e-9
"""Tolerance in comparisons of lengths, mm."""

_SMALLEST = MappingProxyType(
    {
        "wall_soft_mm": ("wall", ("elastomer",)),
        "wall_rigid_mm": ("wall", ("rigid",)),
        "pin_soft_mm": ("pin", ("elastomer",)),
        "pin_rigid_mm": ("pin", ("rigid",)),
        "hole_mm": ("hole", ("elastomer", "rigid")),
        "gap_mm": ("slot", ("elastomer", "rigid")),
    }
)
"""For each smallest feature of a printer profile, the row of the gauge and the kinds of material that give it."""

MeasuredGauges = Sequence[tuple[str, Material, FeatureGauge]]
"""Gauges of one printer: name of the material, the material and the readings."""


def gauges(
    name: str, printer: Printer, measured: MeasuredGauges, source: ReadingSource, results: CouponFindings
) -> None:
    """Add a printer's accuracy, hole undersize and smallest features. Raises InputError for unusable readings."""
    for material_name, material, gauge in measured:
        _check_sizes(gauge, material, f"{source.where}: gauge.{name}.{material_name}")
    _accuracy(name, measured, source, results)
    _holes(name, measured, source, results)
    for key, (row, kinds) in _SMALLEST.items():
        rows = [getattr(gauge, row) for _, material, gauge in measured if material.kind in kinds]
        judged = [sizes for sizes in rows if any(size.sound is not None for size in sizes)]
        if judged:
            _least(name, key, judged, getattr(printer.smallest, key), source, results)


def _check_sizes(gauge: FeatureGauge, material: Material, where: str) -> None:
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
                problem = f"{where}.{row}: nominal_mm = {size.nominal_mm:g}: there twice"
                raise InputError(problem, remedy="put all readings in one")
            seen.add(size.nominal_mm)
            _check_slip(row, size, where)


def _check_slip(row: str, size: GaugeSize, where: str) -> None:
    nominal = size.nominal_mm
    limit = _SLIP * nominal if row in _AXES else max(_FINE_SLIP_MM, _FINE_SLIP * nominal)
    for reading in size.measured_mm:
        if abs(reading - nominal) > limit + _ROUNDING:
            share = "a tenth" if row in _AXES else f"{_FINE_SLIP_MM:g} mm and half"
            raise InputError(
                f"{where}.{row}: nominal_mm = {nominal:g}: measured_mm = {reading:g}: more than {share} off; must be "
                f"from {max(nominal - limit, 0):g} to {nominal + limit:g} mm; read in another unit, or entered in the "
                "wrong row?"
            )


def _accuracy(name: str, measured: MeasuredGauges, source: ReadingSource, results: CouponFindings) -> None:
    sizes = [size for *_, gauge in measured for axis in _AXES for size in getattr(gauge, axis) if size.measured_mm]
    if not sizes:
        return
    deviations = np.array([mean(size.measured_mm).value - size.nominal_mm for size in sizes])
    worst = max(rounded(float(np.abs(deviations).max()), DIGITS), _INSTRUMENT)
    text = source.source("greatest deviation of a length of the step block, 5 to 20 mm; low: least", len(sizes))
    low = rounded(float(np.abs(deviations).min()), DIGITS)
    results.change("printers", name, ("accuracy_mm",), value=worst, low=low, high=worst, source=text)
    results.figure(name, "accuracy, mm", worst, None, len(sizes))
    results.figure(name, "mean deviation of lengths, mm", float(deviations.mean()), None, len(sizes))


def _holes(name: str, measured: MeasuredGauges, source: ReadingSource, results: CouponFindings) -> None:
    holes = [hole for *_, gauge in measured for hole in gauge.hole if hole.measured_mm]
    if not holes:
        return
    if len(holes) < 2:
        raise InputError(
            f"gauge.{name}: 1 hole measured", file=source.where, remedy="at least 2, for a standard deviation"
        )
    smaller = [_smaller(hole, f"{source.where}: gauge.{name}.hole") for hole in holes]
    over = mean(smaller)
    how = "nominal less measured diameter of upright holes; low and high: least and greatest hole"
    value, low, high, spread = (rounded(x, DIGITS) for x in (over.value, min(smaller), max(smaller), over.spread))
    text, keys = source.source(how, over.count), ("hole_undersize_mm",)
    results.change("printers", name, keys, value=value, low=low, high=high, spread=spread, source=text)
    results.figure(name, "holes too small by, mm", over.value, over.spread, over.count)


def _smaller(hole: GaugeSize, where: str) -> float:
    """Nominal less measured diameter, mm. Raises InputError if it is outside the bounds of a printer profile."""
    average = mean(hole.measured_mm).value
    less, (low, high) = hole.nominal_mm - average, HOLE_UNDERSIZE_MM
    if not low - _ROUNDING <= less <= high + _ROUNDING:
        raise InputError(
            f"nominal_mm = {hole.nominal_mm:g}: mean of measured_mm = {average:.4g} makes hole_undersize_mm = "
            f"{less:.4g}; it must be from {low:g} to {high:g} mm; entered in the wrong row?",
            file=where,
        )
    return less


def smallest_sound(sizes: Sequence[GaugeSize]) -> float | None:
    """Smallest size that is sound together with all larger judged ones, mm; None if there is none."""
    least = None
    for size in sorted(sizes, key=lambda size: -size.nominal_mm):
        if size.sound is False:
            break
        if size.sound:
            least = size.nominal_mm
    return least


def _least(
    name: str,
    key: str,
    judged: list[list[GaugeSize]],
    shipped: FeatureSize,
    source: ReadingSource,
    results: CouponFindings,
) -> None:
    """Add the smallest feature ``key`` of a printer: the largest of those that several gauges give."""
    row, _ = _SMALLEST[key]
    leasts = [smallest_sound(sizes) for sizes in judged]
    if any(least is None for least in leasts):
        results.notes.append(f"{name}: no {row} came out together with all larger ones; {key} stays as it was")
        return
    least = max(least for least in leasts if least is not None)
    count = sum(size.sound is not None for sizes in judged for size in sizes)
    before = shipped.source.partition("recommended: ")[2] or shipped.source
    how = source.source(f"the smallest {row} that came out together with all larger ones", count)
    text, recommended = f"least: {how}; recommended: {before}", max(float(shipped.recommended), least)
    results.change("printers", name, ("smallest", key), least=least, recommended=recommended, source=text)
    results.figure(name, f"smallest {row} ({key.removesuffix('_mm')}), mm", least, None, count)


_VOLUME_ROUNDING = 1e-9
"""Tolerance in comparisons of pressures, kPa."""


def leak(name: str, cap: LeakCap, accuracy_kPa: float, source: ReadingSource, results: CouponFindings) -> None:
    """Add the leak rate, kPa/min, to ``results``. Raises InputError if a pressure rises by over ``accuracy_kPa``."""
    for run, (start, end) in enumerate(zip(cap.start_kPa, cap.end_kPa, strict=True), start=1):
        rise = end - start
        if rise > accuracy_kPa + _VOLUME_ROUNDING:
            raise InputError(
                f"run {run}: {end:g} kPa is above start_kPa = {start:g}; must be at most that, for a cap gains no "
                "pressure",
                file=source.where,
                key=f"leak-cap.{name}.end_kPa",
                remedy=f"swapped, or is gauge_accuracy_kPa = {accuracy_kPa:g} of volume-plug.{name} too small?",
            )
        if rise > 0:
            within = f"pressure rose by {rise:.2g} kPa, within the gauge's accuracy of {accuracy_kPa:g} kPa"
            results.notes.append(f"{name}: leak-cap, run {run}: {within}")
    if cap.start_kPa:
        rate = mean((60 * (np.array(cap.start_kPa) - np.array(cap.end_kPa)) / cap.seconds).tolist())
        results.figure(name, "leak, kPa/min", rate.value, rate.spread, rate.count)


def volume(
    name: str,
    scene: ResolvedDesign,
    cap: LeakCap | None,
    plug: VolumePlug,
    source: ReadingSource,
    results: CouponFindings,
) -> None:
    """Add the dead volume in mL by Boyle's law. Raises InputError unless the cap's pressures exceed the plug's."""
    cavity = cavity_measured(CouponContext(scene.connector_material, scene), plug)
    results.figure(name, "cavity of the plug, mL", cavity.value, cavity.error, cavity.count)
    if not plug.pressure_kPa:
        return
    if cap is None or not cap.pressure_kPa:
        need = "the plug's pressures need those of the cap too"
        raise InputError("empty", file=source.where, key=f"leak-cap.{name}.pressure_kPa", remedy=need)
    over_cap_kPa, over_plug_kPa = mean(cap.pressure_kPa), mean(plug.pressure_kPa)
    try:
        dead = dead_volume(cavity, over_cap_kPa, over_plug_kPa, plug.gauge_accuracy_kPa)
    except ValueError:
        must = f"the same push must raise the pressure less over the plug than over the cap, {over_cap_kPa.value:g} kPa"
        key = f"volume-plug.{name}.pressure_kPa"
        raise InputError(f"mean {over_plug_kPa.value:g} kPa", file=source.where, key=key, remedy=must) from None
    drawn_mL = assemble(scene).drawn_volume / ML
    results.figure(name, "dead volume, mL", dead.value, dead.spread)
    results.figure(name, "dead volume as drawn, mL", drawn_mL)
    results.figure(name, "air in the syringe, mL", dead.value * over_cap_kPa.value / cap.ambient_pressure_kPa)
    results.notes.append(
        f"put dead_volume_mL = {dead.value:.3f} under [pneumatics] of {name}; it is {dead.value:.3f} ± "
        f"{dead.spread:.3f}"
    )


def cavity_measured(context: CouponContext, plug: VolumePlug) -> Mean:
    """Volume of the plug's cavity in mL: by weighed water, or as drawn, with the printer's accuracy as error."""
    if plug.water_g:
        water = mean(plug.water_g)
        return Mean(water.value / WATER, water.spread / WATER, water.count)
    scene = context.design()
    (radius, height), accuracy = cavity_size(context), scene.connector_printer.accuracy_mm.nominal
    drawn_mL = cavity_volume(scene.design.membrane.dome) / ML
    # Diameter and height are each uniformly distributed within the accuracy (JCGM 100, 4.3.7).
    return Mean(drawn_mL, drawn_mL * math.hypot(accuracy / radius, accuracy / height) / math.sqrt(3), 1)
