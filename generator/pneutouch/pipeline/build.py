"""Build a design: print files, prediction, datasheet, print sheet and manifest, in one folder."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.body import Body
from pneutouch.errors import RuleBrokenError
from pneutouch.export.scene import glb, stl, viewer_html
from pneutouch.export.step import step
from pneutouch.export.threemf import threemf
from pneutouch.pipeline.evaluate import Evaluation
from pneutouch.pipeline.files import MANIFEST, check_writable, digest, json_bytes, write_folder
from pneutouch.pipeline.uncertainty import prediction_document, unknown
from pneutouch.report import Sheet, datasheet, print_sheet
from pneutouch.spec.design import Design
from pneutouch.spec.material import Material
from pneutouch.units import KPA

Progress = Callable[[str], None]

STEPS = ("rules", "meshes", "3MF", "STL", "GLB", "STEP", "datasheet", "files")
"""The steps that a build reports, in order."""

_LIBRARIES = ("numpy", "manifold3d", "trimesh", "lib3mf", "cadquery", "matplotlib", "jinja2", "typst")


def build(evaluation: Evaluation, out: Path, progress: Progress = lambda step: None) -> Path:
    """Write everything a design gives into ``out/<name>/`` and return that folder.

    Raises RuleBrokenError, with nothing written, where a rule is broken. The same input gives the same bytes.
    """
    scene, assembly = evaluation.scene, evaluation.assembly
    folder = out / scene.name
    check_writable(folder)
    progress("rules")
    refuse(evaluation)
    progress("meshes")
    bodies = tuple(body.moved(assembly.print_offset) for body in assembly.bodies)
    files: dict[str, bytes] = {"prediction.json": json_bytes(prediction_document(evaluation))}
    progress("3MF")
    files[f"{scene.name}.3mf"] = threemf(scene.name, bodies, _metadata(evaluation))
    progress("STL")
    files |= {f"stl/{body.name}.stl": stl(body) for body in bodies}
    progress("GLB")
    files[f"{scene.name}.glb"] = glb(bodies)
    progress("STEP")
    files[f"{scene.name}.step"] = step(scene.name, assembly.solids, assembly.print_offset)
    progress("datasheet")
    sheet = _sheet(evaluation)
    files |= datasheet(sheet, evaluation.sensor, viewer_html(bodies))
    files["print-sheet.md"] = print_sheet(sheet).encode()
    progress("files")
    files[MANIFEST] = json_bytes(_manifest(evaluation, bodies, files))
    write_folder(folder, files)
    return folder


def _sheet(evaluation: Evaluation) -> Sheet:
    """What the datasheet is made from; the air and the charts only where the atlas knows the sensor."""
    prediction, sensor = evaluation.prediction, evaluation.sensor
    sheet = Sheet(
        evaluation.scene, evaluation.assembly, prediction, evaluation.findings, input_hash(evaluation),
        _resins(evaluation), evaluation.uncertainty,
    )  # fmt: skip
    if unknown(sensor, prediction.model) is not None:
        return sheet
    # Through the atlas these load scipy, which a prediction by the membrane must not pay for.
    from pneutouch.pipeline.design_charts import air, tradeoff, tuning

    tuned = tuning(evaluation, sheet.rated_pressure() * KPA)
    if tuned is not None:
        tuned = replace(tuned, published=tuple(sheet.published().items()))
    return replace(sheet, gas=air(evaluation), tradeoff=tradeoff(evaluation), tuning=tuned)


def refuse(evaluation: Evaluation) -> None:
    """Raise RuleBrokenError where a finding is an error."""
    errors = [finding for finding in evaluation.findings if finding.severity == "error"]
    if errors:
        lines = [f"{evaluation.scene.where}: {f.rule}: {f.message}; {f.fix}" for f in errors]
        raise RuleBrokenError("\n".join(lines))


def inputs(evaluation: Evaluation) -> dict[str, Any]:
    """Everything that the result follows from: design, materials, printers and parts, as data."""
    scene = evaluation.scene
    models = {
        "design": scene.design,
        "membrane_material": scene.membrane_material,
        "connector_material": scene.connector_material,
        "printer": scene.printer,
        "connector_printer": scene.connector_printer,
        "port": scene.port,
        "seat": scene.seat,
        "mount": scene.mount,
    }
    return {
        "model": evaluation.prediction.model,
        "closure": evaluation.prediction.closure,
        "clamp": "base" if evaluation.sensor.flange is None else "flange",
        **{key: model.model_dump(mode="json") for key, model in models.items()},
        "compared_resins": {name: m.model_dump(mode="json") for name, m in _resins(evaluation).items()},
        "error_estimate": evaluation.prediction.error_estimate,
    }


def _resins(evaluation: Evaluation) -> dict[str, Material]:
    """The resins that the datasheet compares."""
    materials = evaluation.library.all("materials", Material)
    return {name: material for name, material in materials.items() if material.kind == "elastomer"}


def input_hash(evaluation: Evaluation) -> str:
    """First twelve digits of the SHA-256 of the inputs and the version."""
    return digest(json_bytes({"inputs": inputs(evaluation), "version": __version__}))[:12]


def design_text(design: Design) -> str:
    """The whole design, defaults included, as JSON."""
    return json_bytes(design.model_dump(mode="json")).decode()


def _metadata(evaluation: Evaluation) -> dict[str, str]:
    scene = evaluation.scene
    return {
        "Title": scene.design.document.title,
        "Application": f"pneutouch {__version__}",
        "Description": f"Pneumatic touch sensor {scene.name}: assembly of membrane and connector",
        "design": design_text(scene.design),
        "versions": json_bytes(_versions()).decode(),
        "input-hash": input_hash(evaluation),
        "mesh-tolerance-mm": f"{scene.mesh_tolerance:g}",
    }


def _versions() -> dict[str, str]:
    return {"pneutouch": __version__, **{name: importlib.metadata.version(name) for name in _LIBRARIES}}


def _manifest(evaluation: Evaluation, bodies: tuple[Body, ...], files: dict[str, bytes]) -> dict[str, Any]:
    assembly = evaluation.assembly
    return {
        "name": evaluation.scene.name,
        "inputs": inputs(evaluation),
        "input_hash": input_hash(evaluation),
        "versions": _versions(),
        "print_frame_offset_mm": assembly.print_offset.tolist(),
        "mesh": {
            body.name: {
                "tolerance_mm": evaluation.scene.mesh_tolerance,
                "measured_deviation_mm": round(assembly.deviation(original), 6),
                "triangles": len(body.triangles),
                "volume_mm3": round(body.volume, 3),
                "exact_volume_mm3": round(solid.volume, 3),
            }
            for body, original, solid in zip(bodies, assembly.bodies, assembly.solids, strict=True)
        },
        "findings": [finding.document() for finding in evaluation.findings],
        "files": {name: {"sha256": digest(content), "bytes": len(content)} for name, content in sorted(files.items())},
    }
