"""The print sheet: which body takes which resin, on which machine, in which orientation, and how to clean it."""

from collections.abc import Mapping

from pneutouch.body import Body
from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.report.making import making
from pneutouch.report.mould import mould_rows
from pneutouch.report.ordering import part_number
from pneutouch.units import ML
from pneutouch.wording import counted


def print_sheet(sheet: SheetData, left_out: Mapping[str, str]) -> str:
    """Markdown for the operator. Print files carry names and colours; the resin is chosen at the machine.

    ``left_out`` are files that were not written, and why.
    """
    scene, assembly = sheet.scene, sheet.assembly
    rows = []
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        machine, mode = assembly.machine(body.name)
        rows.append(
            f"| {body.name} | stl/{body.name}.stl | {solid.material.label} | {machine.title} | {mode.label} | "
            f"{_size(body)} | {solid.mass:.2f} g |"
        )
    deviation = max(assembly.deviation(body) for body in assembly.bodies)
    findings = "\n".join([f"- {f.severity}: {f.body}: {f.message}; {f.fix}." for f in sheet.findings] or ["- none"])
    table = "\n".join(rows)
    missing = "".join(f"Not written: `{name}`. {why}.\n\n" for name, why in left_out.items())
    steps = "\n".join(f"{k}. {line}" for k, line in enumerate(making(scene, sheet.pour), start=1))
    return f"""\
# Print sheet: {_escaped(scene.design.document.title)}

{part_number(scene)}, revision {scene.design.document.revision}, input {sheet.input_hash}

| body | file | material | machine | mode | size, mm | mass |
|---|---|---|---|---|---|---|
{table}

All files share one frame, in millimetres, all coordinates positive. `{scene.name}.3mf` holds the bodies as one \
assembly with material names and display colours; colours carry no meaning and the machine's software may ignore \
the names: **choose the resin of each body by hand**.

{missing}Chord tolerance {1e3 * scene.mesh_tolerance:g} µm, the finest step of the machines; greatest measured \
distance between mesh and exact surface {1e3 * deviation:.1f} µm.

{_calibrated(scene)}{_mould(sheet)}## Steps

{steps}

## What it takes

{_takes(sheet)}

## Findings of the rules

{findings}
"""


def _calibrated(scene: ResolvedDesign) -> str:
    """Note on the sensor that a calibrated design stands for; nothing of the print follows from a calibration."""
    if scene.calibration is None:
        return ""
    source = scene.calibration.source
    return (
        f"Calibration `{scene.design.calibration}`: the figures of the datasheet are those of sensor "
        f"{_escaped(source.sensor)} as it was measured ({_escaped(source.campaign or 'unnamed campaign')}). The bodies "
        "are those of the design as drawn; a sensor printed again is another specimen and has to be calibrated itself."
        "\n\n"
    )


def _mould(sheet: SheetData) -> str:
    """The parts of the mould of a cast membrane, and what there is to state of it."""
    mould = sheet.assembly.mould
    if mould is None:
        return ""
    rows = [
        f"| {body.name} | {mould.counts[body.name]} | mould/{body.name}.stl | {_size(body)} | {solid.mass:.1f} g |"
        for body, solid in zip(mould.printed, mould.solids, strict=True)
    ]
    table = "\n".join(["| part | number | file | size, mm | mass each |", "|---|---|---|---|---|", *rows])
    facts = "\n".join(f"- {name}: {text}." for name, text in mould_rows(mould))
    return (
        "## Mould\n\nThe files lie as they are printed; the 3MF in `mould/` holds all parts on build plates.\n\n"
        f"{table}\n\n{facts}\n\n"
    )


def _takes(sheet: SheetData) -> str:
    """Resin, support, layers and a rough time of each job, with their basis."""
    rows, notes = [], []
    for job in sheet.estimates:
        resins = ", ".join(f"{name} {volume:.2f} mL" for name, volume in job.resins.items())
        layers = "" if job.layers is None else f"{job.layers}"
        swaths = "" if job.swaths is None else f" x {counted(job.swaths, 'swath')}"
        rows.append(
            f"| {job.name} | {job.mode} | {resins} | {job.support / ML:.2f} mL | {layers}{swaths} | "
            f"{_time(job.seconds)} |"
        )
        notes += [f"- {job.name}: {note}." for note in job.assumptions]
    glue_mL = sheet.assembly.glue_volume / ML
    glue = f"Glue: about {glue_mL:.2f} mL fills the gaps.\n\n" if glue_mL else ""
    head = "| job | mode | resin | support | layers | time, rough |\n|---|---|---|---|---|---|\n"
    return head + "\n".join(rows) + "\n\n" + glue + "\n".join(dict.fromkeys(notes))


def _time(seconds: float | None) -> str:
    if seconds is None:
        return "not known"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 100 else f"{seconds / 3600:.1f} h"


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")


def _size(body: Body) -> str:
    bounds = body.bounds
    return " x ".join(f"{length:.1f}" for length in bounds[1] - bounds[0])
