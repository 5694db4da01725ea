"""The print sheet: which body takes which resin on which machine, how it is made step by step, and its order code."""

import math
from collections.abc import Mapping, Sequence

from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.mechanics.prediction import SensorState
from pneutouch.parts import Assembly
from pneutouch.parts.connector import gasket_radii
from pneutouch.parts.glue import GLUES, glue_of, glue_volume
from pneutouch.parts.mould.assembly import SiliconeBatch
from pneutouch.report.mould import mould_rows
from pneutouch.report.pages import filled
from pneutouch.results.printing import JobEstimate
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.units import ML
from pneutouch.wording import counted

LEAK = 0.01
"""Share of the range's pressure rise that may leak in a minute: own choice; a press of ten seconds loses 0.2 %."""


def steps(sheet: SheetData) -> list[str]:
    """Steps to make, clean and assemble the sensor of a sheet, in order."""
    return making(sheet.assembly, sheet.pour, sheet.rating.pressure_kPa, _straight(sheet))


def making(
    assembly: Assembly, pour: SiliconeBatch | None = None, rated_kPa: float = math.inf, state: SensorState | None = None
) -> list[str]:
    """Steps to make, clean and assemble a sensor, in order; ``pour``: silicone of a cast membrane, else None.

    It is tested for leaks at its greatest driving pressure, a vacuum as its pressure, but at most at the rated one;
    with a ``state`` that has figures, by `LEAK` of the pressure rise of its range."""
    scene, stands = assembly.scene, assembly.stands_up
    known = {"scene": scene, "stands": stands, "pour": pour, "glue": glue_of(scene), "glues": GLUES}
    known |= {"gasket": gasket_radii(assembly.layout), "layout": assembly.layout}
    text = filled("making.j2", **known, fill_kPa=fill_kPa(scene, rated_kPa), fall=_fall(state))
    return [line for line in text.splitlines() if line]


def _straight(sheet: SheetData) -> SensorState | None:
    """The last state of a sheet that has figures; None if none has."""
    return next((state for state in reversed(sheet.prediction.states) if state.figures is not None), None)


def fill_kPa(scene: ResolvedDesign, rated_kPa: float) -> float:
    """Pressure of the leak test."""
    return min(max(map(abs, scene.design.pneumatics.driving_pressures_kPa)) or 1.0, rated_kPa)


def _fall(state: SensorState | None) -> tuple[float, float] | None:
    """Fall of the pressure in a minute (kPa) that is allowed, and the force (N) as which it reads."""
    figures = None if state is None else state.figures
    return figures and (LEAK * figures.sensitivity * figures.force_high, LEAK * figures.force_high)


def leak_tools(volume_mL: float, fill_kPa: float, fall_kPa: float | None) -> str:
    """Tools that fill a gas volume to a pressure and show its fall: a syringe of twice the air, for the wall gives way,
    and a gauge with ten steps to the fall that is allowed."""
    air_mL = volume_mL * fill_kPa / 101.325
    syringe_mL = next((size for size in (5, 10, 20, 60) if size >= 2.0 * air_mL), 60)
    range_kPa, step = 10 * math.ceil(0.15 * fill_kPa), "" if not fall_kPa else f", readable to {fall_kPa / 10:.1g} kPa"
    gauge = f"a gauge to {range_kPa} kPa{step} (the sensor's own, if it does)"
    return f"a syringe of {syringe_mL} mL, a valve, {gauge}, a tee and ends that take the tube"


def making_title(pour: SiliconeBatch | None) -> str:
    """Heading of the steps on the datasheet; ``pour`` as in `making`."""
    return "Material and print" if pour is None else "How to make it"


def body_rows(sheet: SheetData) -> list[list[str]]:
    """Rows of the sensor's bodies: name, material, volume and mass, machine and mode."""
    rows = []
    for solid in sheet.assembly.solids:
        printer, mode = sheet.assembly.machine(solid.name)
        size, machine = f"{solid.volume / ML:.3f} mL, {solid.mass:.2f} g", f"{printer.title}, {mode.label}"
        rows.append([solid.name, solid.material.label, size, machine])
    return rows


def part_number(scene: ResolvedDesign) -> str:
    """Part number, such as PNT-R0925-T150-TP-B4-GF-M3."""
    return "-".join(code for code, _ in code_fields(scene))


def code_fields(scene: ResolvedDesign) -> list[tuple[str, str]]:
    """Each field of the part number with its meaning."""
    membrane, shape = scene.design.membrane, scene.design.membrane.dome
    named = [(shape.key.upper(), shape.further or "as drawn")] if no_hemisphere(shape.plain) else []
    return [
        ("PNT", f"pneumatic touch sensor, {shape.adjective}"),
        *named,
        (f"R{100 * membrane.inner_radius_mm:04.0f}", f"inner radius {membrane.inner_radius_mm:g} mm"),
        (f"T{100 * membrane.wall_thickness_mm:03.0f}", f"wall {shape.stated_wall}"),
        (scene.membrane_material.code, scene.membrane_material.label),
        (scene.port.code, scene.port.title),
        (scene.seat.code, scene.seat.title),
        (scene.mount.code, scene.mount.title),
    ]


def print_sheet(sheet: SheetData, job_files: Sequence[str], left_out: Mapping[str, str]) -> str:
    """Markdown for the operator, who loads ``job_files`` and chooses resins at the machine; ``left_out``: reason by
    file not written."""
    scene, assembly, mould = sheet.scene, sheet.assembly, sheet.assembly.mould
    glue_mL = glue_volume(scene, assembly.layout) / ML
    mixed = f"-{assembly.job('membrane').replace(' ', '-')}."
    masses = {item.name: item.mass_g for job in sheet.estimates for item in job.items}
    return filled(
        "print-sheet.md.j2",
        sheet=sheet,
        scene=scene,
        number=part_number(scene),
        bodies=[
            (body, solid.material.label, *assembly.machine(body.name), solid.mass)
            for body, solid in zip(assembly.bodies, assembly.solids, strict=True)
        ],
        job_files=[f"`{file}`" for file in job_files if not (scene.membrane_material.is_uncoded and mixed in file)],
        left_out=left_out,
        deviation=max(assembly.solid(body.name).deviation(body) for body in assembly.bodies),
        calibration=scene.calibration,
        parts=[] if mould is None else [(body, mould.counts[body.name], masses[body.name]) for body in mould.printed],
        facts=[] if mould is None else mould_rows(mould),
        steps=steps(sheet),
        jobs=[(job, _swaths(job), _time(job.time_min)) for job in sheet.estimates],
        plate_mm=assembly.layout.plate_high - assembly.layout.plate_low,
        circle_mm=2 * assembly.layout.bolt_circle_radius,
        in_all=_time(math.fsum(math.nan if job.time_min is None else job.time_min for job in sheet.estimates)),
        notes=dict.fromkeys(f"{job.job}: {note}" for job in sheet.estimates for note in job.assumptions),
        glue_mL=glue_mL,
        leak_tools=leak_tools(
            (assembly.layout.shape.cavity_volume + assembly.drawn_volume) / ML,
            fill_kPa(scene, sheet.rating.pressure_kPa),
            fall[0] if (fall := _fall(_straight(sheet))) else None,
        ),
        glue=GLUES[glue].title
        if (glue := glue_of(scene))
        else "a flexible adhesive that wets both materials, such as polyurethane",
    )


def _swaths(job: JobEstimate) -> str:
    layers = "" if job.layers is None else f"{job.layers}"
    return layers if job.swaths is None else f"{layers} x {counted(job.swaths, 'swath')}"


def _time(time_min: float | None) -> str:
    if time_min is None or math.isnan(time_min):
        return "not known"
    minutes = round(time_min)
    return f"{minutes} min" if minutes < 100 else f"{time_min / 60:.1f} h"
