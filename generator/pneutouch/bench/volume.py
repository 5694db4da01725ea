"""Caps and plugs: leak rate and dead volume of one design."""

import math

import numpy as np

from pneutouch.bench.finding import CouponFindings, ReadingSource
from pneutouch.bench.statistics import Mean, dead_volume, mean
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from pneutouch.parts.coupons import CouponContext
from pneutouch.parts.coupons.volume_plug import WATER, cavity_size, cavity_volume
from pneutouch.spec.coupon import LeakCap, VolumePlug
from pneutouch.units import ML

_ROUNDING = 1e-9
"""Differences of pressures may miss a limit by this, kPa."""


def leak(name: str, cap: LeakCap, accuracy_kPa: float, source: ReadingSource, results: CouponFindings) -> None:
    """Leak rate, kPa/min. Raises InputError if pressure rises by more than the gauge's ``accuracy_kPa``."""
    for run, (start, end) in enumerate(zip(cap.start_kPa, cap.end_kPa, strict=True), start=1):
        rise = end - start
        if rise > accuracy_kPa + _ROUNDING:
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
    """Dead volume in mL by Boyle's law. Raises InputError if the cap's pressures are missing or contradict."""
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
    assembly = assemble(scene)
    drawn_mL = assembly.drawn_volume / ML
    results.figure(name, "dead volume, mL", dead.value, dead.spread)
    results.figure(name, "dead volume as drawn, mL", drawn_mL)
    results.figure(name, "air in the syringe, mL", dead.value * over_cap_kPa.value / cap.ambient_pressure_kPa)
    results.notes.append(
        f"put dead_volume_mL = {dead.value:.3f} under [pneumatics] of {name}; it is {dead.value:.3f} ± "
        f"{dead.spread:.3f}"
    )


def cavity_measured(context: CouponContext, plug: VolumePlug) -> Mean:
    """The cavity's volume in mL: weighed, or as drawn with the printer's accuracy on its diameter and height."""
    if plug.water_g:
        water = mean(plug.water_g)
        return Mean(water.value / WATER, water.spread / WATER, water.count)
    scene = context.design()
    (radius, height), accuracy = cavity_size(context), scene.connector_printer.accuracy_mm.nominal
    drawn_mL = cavity_volume(scene.design.membrane.inner_radius_mm) / ML
    # Diameter and height are each uniformly distributed within the accuracy (JCGM 100, 4.3.7).
    return Mean(drawn_mL, drawn_mL * math.hypot(accuracy / radius, accuracy / height) / math.sqrt(3), 1)
