"""Readings that a planned campaign gives if the prediction holds, and limits of rig and sensor that it exceeds."""

from collections.abc import Mapping

import numpy as np

from pneutouch.bench.indents import CLEARANCE, RunProtocol
from pneutouch.bench.simulate.curve import PressCurve, PressCurves, line_pressure, sensor_pressure
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.resins import tested_kPa
from pneutouch.mechanics.rating import Rating
from pneutouch.results.plan import ExpectedPoint, InjectedVolume, PlannedInjection, PlanViolation
from pneutouch.spec.campaign import Rig
from pneutouch.units import KPA, ML

RESOLVED = 3.0
"""Force in resolutions of the force sensor below which a first step is not detected (IUPAC's limit of detection)."""

ROUND = tuple(ML * digit * 10.0**power for power in (-2, -1, 0, 1) for digit in (1, 2, 5))
"""Round volumes that a syringe can push, mm3."""

MORE = 0.1 * ML
"""Additional dead volume whose effect is also stated, mm3: 20 mm of a 2.5 mm bore, our choice."""

_OF_RATED, _OF_RANGE = 0.5, 0.8
"""Shares of the rated pressure, for the sensor, and of the gauge's range, for the line, that pushed air may reach: our
choice, so that neither is strained by the test."""

_LEAK_SHARE = 0.01
"""Share of the first step's rise that a leak may take during one indentation: our choice."""


def points(curve: PressCurve, depths: tuple[float, ...]) -> tuple[ExpectedPoint, ...]:
    """Expected force, pressure rise and cavity pressure at plate travels, mm; None beyond the predicted range."""
    known = [depth for depth in depths if curve.covers(depth)]
    force, rise = curve.at(np.minimum(known, curve.reach)) if known else (np.zeros(0), np.zeros(0))
    driving_kPa = curve.driving / KPA
    read: dict[float, tuple[float, float, float]] = {
        depth: (float(f), float(r) / KPA, driving_kPa + float(r) / KPA)
        for depth, f, r in zip(known, force, rise, strict=True)
    }
    return tuple(ExpectedPoint(depth, *read.get(depth, (None, None, None))) for depth in depths)


def curve_warnings(
    resin: str, rating: Rating, curve: PressCurve, tests: Mapping[str, RunProtocol], rig: Rig
) -> list[PlanViolation]:
    """Warnings on limits that runs at one driving pressure would exceed; ``tests`` are their protocols by kind."""
    driving_kPa = curve.driving / KPA
    depths = tuple(sorted({depth for test in tests.values() for depth in test.depths}))
    expected = points(curve, depths)
    violations = []

    def over(rule: str, key: str, limit: float, text: str) -> None:
        read = [(place, getattr(point, key)) for place, point in enumerate(expected)]
        beyond = [(place, value) for place, value in read if value is not None and value > limit]
        if beyond:
            (first, least), (_, most) = beyond[0], beyond[-1]
            stop = f"stop at {depths[first - 1]:g} mm" if first else "leave this pressure out"
            report(rule, depths[first], text.format(limit=limit, least=least, most=most, stop=stop))

    def report(rule: str, depth: float | None, text: str) -> None:
        kinds = "" if depth is None else f" ({', '.join(k for k, t in tests.items() if max(t.depths) >= depth)})"
        at = "" if depth is None else f", from {depth:.2f} mm on{kinds}"
        violations.append(PlanViolation(rule, f"{resin}, {driving_kPa:g} kPa{at}: {text}", resin, driving_kPa, depth))

    over(
        "force range",
        "force_N",
        rig.force_range_N,
        "expected force of {least:.1f} to {most:.1f} N passes the force sensor's {limit:g} N; {stop}, or state a "
        "larger sensor as force_range_N of the rig in `rig`",
    )
    over(
        "pressure range",
        "cavity_pressure_kPa",
        rig.pressure_range_kPa,
        "expected cavity pressure of {least:.1f} to {most:.1f} kPa passes the gauge's {limit:g} kPa; {stop}, or state "
        "a wider gauge as pressure_range_kPa of the rig in `rig`",
    )
    lost = [depth for depth in depths if not curve.covers(depth)]
    if lost and curve.ends is not None:
        report(
            "range end",
            lost[0],
            f"predicted range ends at {curve.ends[1]:.2f} mm ({curve.ends[0]}): stop there, or no figure uses the rest",
        )
    if rating.severity(curve.driving) is not None:
        remedy = rating.remedy_for(curve.driving)
        raised = "" if remedy is None else f", or to raise it, {remedy}"
        lower = f"take at most that, as by `pneumatics.driving_pressures_kPa`=0,{rating.pressure_kPa:.1f}"
        report("rated pressure", None, f"{rating.excess(curve.driving)}, {rating.basis}; {lower}{raised}")
    first = expected[0].force_N
    if first is not None and first < RESOLVED * rig.force_resolution_N:
        report(
            "force resolution",
            None,
            f"expected force of {first:.3f} N at the first step, {depths[0]:g} mm, is below {RESOLVED:g} resolutions "
            f"of {rig.force_resolution_N:g} N: state a finer sensor as force_resolution_N of the rig in `rig`",
        )
    return violations


def travel_warnings(depths: tuple[float, ...], rig: Rig) -> list[PlanViolation]:
    """Warning if the stage's travel is too short for the deepest step and its clearance; else none."""
    need = max(depths) + CLEARANCE
    if need <= rig.travel_mm:
        return []
    text = (
        f"the deepest step and its clearance need {need:.2f} mm; the stage has {rig.travel_mm:g} mm: state "
        "a longer one as travel_mm of the rig in `rig`"
    )
    return [PlanViolation("travel", text, "", None, max(depths))]


def refuse_above_limits(resin: str, rating: Rating, scene: ResolvedDesign) -> None:
    """Raise InputError if the sensor as designed meets a limit at one of the design's driving pressures."""
    for k, pressure_kPa in enumerate(tested_kPa(scene)):
        if rating.severity(pressure_kPa * KPA) == "error":
            raise InputError(
                f"{resin}: {rating.excess(pressure_kPa * KPA)}",
                file=scene.where,
                key=f"pneumatics.driving_pressures_kPa[{k}]",
                value=pressure_kPa,
                remedy=f"must be at most {rating.pressure_kPa:.1f} kPa, the rated pressure: {rating.basis}",
            )


def injection(pressed: PressCurves, rating: Rating, rig: Rig) -> PlannedInjection:
    """Pressures (kPa) after round volumes of room air, into closed line and unpressed sensor; None if unknown."""
    sensor, ambient = pressed.sensor, pressed.sensor.gas.ambient_pressure
    volumes = np.array(ROUND)
    bare = sensor_pressure(volumes, pressed.inflation, 0.0, ambient)
    ceiling = min(_OF_RATED * rating.pressure, _OF_RANGE * rig.pressure_range_kPa * KPA)
    # The sensor with no dead volume reads most: it decides what may be pushed.
    fits = np.flatnonzero(np.nan_to_num(bare, nan=np.inf) <= ceiling)
    into_sensor = None if not fits.size else float(volumes[fits[-1]])
    line_volume_mL = line_kPa = None
    if sensor.gas.dead_volume > 0:
        line = line_pressure(volumes, sensor.gas.dead_volume, ambient)
        fits = np.flatnonzero(line <= _OF_RANGE * rig.pressure_range_kPa * KPA)
        if fits.size:
            line_volume_mL, line_kPa = float(volumes[fits[-1]]) / ML, float(line[fits[-1]]) / KPA
    return PlannedInjection(
        dead_volume_mL=sensor.gas.dead_volume / ML,
        cavity_volume_mL=float(pressed.inflation.volume[0]) / ML,
        sensor_volume_mL=None if into_sensor is None else into_sensor / ML,
        sensor=() if into_sensor is None else _rows(pressed, into_sensor),
        more_dead_volume_mL=MORE / ML,
        line_volume_mL=line_volume_mL,
        line_pressure_kPa=line_kPa,
    )


def _rows(pressed: PressCurves, most: float) -> tuple[InjectedVolume, ...]:
    sensor = pressed.sensor
    volumes = np.linspace(0.2, 1.0, 5) * most
    stated_kPa, bare_kPa, more_kPa = (
        sensor_pressure(volumes, pressed.inflation, dead, sensor.gas.ambient_pressure) / KPA
        for dead in (sensor.gas.dead_volume, 0.0, sensor.gas.dead_volume + MORE)
    )
    rows = zip(volumes / ML, stated_kPa, bare_kPa, more_kPa, strict=True)
    return tuple(InjectedVolume(*map(float, row)) for row in rows)


def leak_limit(rise_kPa: float, test: RunProtocol) -> float:
    """Greatest leak, kPa/min: `_LEAK_SHARE` of the first step's expected rise (kPa) during its indentation."""
    seconds = test.hold + 2 * (test.depths[0] + CLEARANCE) / test.speed
    return 60.0 * _LEAK_SHARE * rise_kPa / seconds
