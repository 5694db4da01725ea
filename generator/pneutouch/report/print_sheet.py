"""The print sheet: which body takes which resin, on which machine, in which orientation, and how to clean it."""

from __future__ import annotations

from pneutouch.body import Body
from pneutouch.report import prose
from pneutouch.report.ordering import part_number
from pneutouch.report.sheet import Sheet


def print_sheet(sheet: Sheet) -> str:
    """Markdown for the operator. Print files carry names and colours; the resin is chosen at the machine."""
    scene, assembly = sheet.scene, sheet.assembly
    rows = [
        f"| {body.name} | stl/{body.name}.stl | {solid.material.label} | {machine.title} | {mode.name}, "
        f"{mode.layer_height_um:g} µm | {_size(body)} | {solid.mass:.2f} g |"
        for body, solid, machine, mode in zip(
            assembly.bodies, assembly.solids,
            (scene.printer, scene.connector_printer), (scene.membrane_mode, scene.connector_mode), strict=True,
        )
    ]  # fmt: skip
    deviation = max(assembly.deviation(body) for body in assembly.bodies)
    findings = [f"- {f.severity}: {f.body}: {f.message}; {f.fix}." for f in sheet.findings] or ["- none"]
    return "\n".join([
        f"# Print sheet: {_escaped(scene.design.document.title)}", "",
        f"{part_number(scene)}, revision {scene.design.document.revision}, input {sheet.input_hash}", "",
        "| body | file | material | machine | mode | size, mm | mass |",
        "|---|---|---|---|---|---|---|", *rows, "",
        f"All files share one frame, in millimetres, all coordinates positive. `{scene.name}.3mf` holds the bodies as one "
        "assembly with material names and display colours; colours carry no meaning and the machine's software may ignore "
        "the names: **choose the resin of each body by hand**.", "",
        f"Chord tolerance {1e3 * scene.mesh_tolerance:g} µm, the finest step of the machines; greatest measured distance "
        f"between mesh and exact surface {1e3 * deviation:.1f} µm.", "",
        "## Steps", "", *(f"{k}. {line}" for k, line in enumerate(prose.printing(scene), start=1)), "",
        "## Findings of the rules", "", *findings, "",
    ])  # fmt: skip


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")


def _size(body: Body) -> str:
    bounds = body.bounds
    return " x ".join(f"{length:.1f}" for length in bounds[1] - bounds[0])
