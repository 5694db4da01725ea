"""The tables of docs/background/viscous.md and docs/background/ageing.md, from the code as it is."""

from __future__ import annotations

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.viscous.describe import (
    LOOP_SPEEDS,
    RAMP_SPEED,
    ageing_ratio,
    loop_by_solid,
    relaxation_by_solid,
)
from pneutouch.mechanics.viscous.prony import prony_series
from pneutouch.mechanics.viscous.runs import loop, relaxation
from pneutouch.spec.material import Material
from pneutouch.units import KPA

PAPER_RESINS = ("TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985", "FLX9995")
PRESSURES = (0.0, 22.0)
DRIVEN = np.linspace(0.0, 22.0, 12) * KPA


def resin(library: Library, name: str) -> Material:
    material = library.load("materials", name)
    assert isinstance(material, Material)
    return material


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _runs(sensor: Sensor, material: Material, depth: float) -> list[list[str]]:
    """Cells of each pressure and source: losses, then both measures at each speed."""
    series, pressures = prony_series(material), [p * KPA for p in PRESSURES]
    by_solid = sensor.protocol.other_contact is not None
    hold, cycle = (relaxation_by_solid, loop_by_solid) if by_solid else (relaxation, loop)
    held = hold(sensor, series, pressures, depth, RAMP_SPEED)
    loops = [cycle(sensor, series, pressures, depth, v) for v in LOOP_SPEEDS]
    found = []
    for i, pressure in enumerate(PRESSURES):
        for j in range(len(series)):
            run = held[i][j]
            lost = (
                [run.ended, "-", "-"]
                if run.ended
                else [f"{100 * x:.1f} %" for x in (run.drop(run.force)[0], *run.drop(run.rise))]
            )
            wide = [one[i][j] for one in loops]
            cells = [w.ended if w.ended else " / ".join(f"{100 * x:.1f}" for x in w.hysteresis()) + " %" for w in wide]
            found.append([f"{pressure:g}", "ABC"[j], *lost, *cells])
    return found


def agilus_table(library: Library) -> list[str]:
    """The paper's dome in Agilus30, by depth, pressure and source."""
    material = resin(library, "Agilus30")
    sensor = material_sensor(material)
    head = [
        "depth",
        "driving, kPa",
        "data",
        "force, 1 to 600 s",
        "pressure rise",
        "a decade",
        *(f"hysteresis at {v:g} mm/s, width / area" for v in LOOP_SPEEDS),
    ]
    rows = [_row(head), _row(["---"] * len(head))]
    for share in (0.25, 0.5, 0.75):
        rows += [_row([f"{share:g} R0", *cells]) for cells in _runs(sensor, material, share * sensor.dome.inner_radius)]
    return rows


def friction_table(library: Library) -> list[str]:
    """The paper's dome in Agilus30, at half of R0, by pressure, source A or B and friction, by the solid but without
    any."""
    material = resin(library, "Agilus30")
    material = material.model_copy(update={"relaxation": material.relaxation[:2]})
    sensor = material_sensor(material)
    head = [
        "state, data",
        "friction",
        "force lost, 1 to 600 s",
        "pressure rise lost",
        *(f"{'hysteresis ' if v == LOOP_SPEEDS[0] else ''}at {v:g} mm/s" for v in LOOP_SPEEDS),
    ]
    names = {0.0: "0", 0.3: "0.3", 0.6: "0.6", np.inf: "grip"}
    depth = 0.5 * sensor.dome.inner_radius
    runs = {name: _runs(sensor.replace(friction=value), material, depth) for value, name in names.items()}
    rows = [_row(head), _row(["---", "---", *["---:"] * 4])]
    for cells in zip(*runs.values(), strict=True):
        for name, (pressure, data, force, rise, _, *loops) in zip(runs, cells, strict=True):
            rows.append(_row([f"{pressure} kPa, {data}", name, force, rise, *loops]))
    return rows


def wall_table(library: Library) -> list[str]:
    """The same dome with other walls, at half of R0, no pressure and 5 mm/s: what the wall's share of the load does."""
    material = resin(library, "Agilus30")
    rows = [_row(["wall, mm", "pressure rise lost, A", "B", "C", "hysteresis, A", "B", "C"]), _row(["---"] * 7)]
    for wall in (0.75, 1.5, 2.25, 3.0):
        sensor = material_sensor(material).replace(wall_thickness=wall)
        cells = _runs(sensor, material, 0.5 * sensor.dome.inner_radius)[:3]
        wide = [cell[-1].split(" /")[0] + " %" for cell in cells]
        rows.append(_row([f"{wall:g}", *(cell[3] for cell in cells), *wide]))
    return rows


def ageing_shift_as_measured(material: Material, ratio: float) -> tuple[float, float]:
    """Mean change of the sensitivity curve, and of its size, over the mean aged curve: as Supplement E normalises."""
    fresh = material_sensor(material)
    old = fresh.replace(shear_modulus=ratio * fresh.wall.shear_modulus)
    before, after = (respond(batch_of(one, DRIVEN), one.protocol.steps).lines.sensitivity for one in (fresh, old))
    return float((after - before).mean() / after.mean()), float(np.abs(after - before).mean() / after.mean())


def needed(material: Material, measured: float) -> str:
    """The moduli over the fresh one, nearest to it either way, that would change the sensitivity as measured."""
    fresh = material_sensor(material)
    ratios = np.append(np.geomspace(1 / 3, 3, 89), 1.0)
    moved = [batch_of(fresh.replace(shear_modulus=r * fresh.wall.shear_modulus), DRIVEN) for r in ratios]
    curves = respond(SensorBatch.join(moved), fresh.protocol.steps).lines.sensitivity.reshape(len(ratios), -1)
    size = np.abs(curves - curves[-1]).mean(axis=1) / curves.mean(axis=1)
    known = np.isfinite(size)
    enough = ratios[known & (np.nan_to_num(size) >= measured)]
    ends = [enough[enough < 1].max(initial=0.0), enough[enough > 1].min(initial=np.inf)]
    said = [f"{end:.2f}" for end in ends if 0 < end < np.inf]
    return " or ".join(said) if said else f"none from {ratios[known].min():.2f} to {ratios[known].max():.2f}"


def ageing_table(library: Library) -> list[str]:
    """The resins whose aged sensors the paper measured."""
    head = [
        "resin",
        "Shore A, fresh to a year",
        "modulus by Gent",
        "sensitivity by that",
        "its size",
        "measured (sign not given)",
        "of it explained",
        "modulus ratio that would do it",
    ]
    rows = [_row(head), _row(["---"] * len(head))]
    for name in ("TangoPlus", "FLX9950", "FLX9970"):
        material = resin(library, name)
        ratio = ageing_ratio(material)
        signed, size = ageing_shift_as_measured(material, ratio)
        measured = material.measured.sensitivity_change_one_year_percent.nominal
        rows.append(
            _row(
                [
                    material.title,
                    f"{material.shore_a.nominal:g} to {material.shore_a_one_year.nominal:g}",
                    f"{ratio - 1:+.1%}",
                    f"{signed:+.1%}",
                    f"{size:.1%}",
                    f"{measured:.1f} %",
                    f"{100 * size / measured:.0%}",
                    needed(material, measured / 100),
                ]
            )
        )
    return rows
