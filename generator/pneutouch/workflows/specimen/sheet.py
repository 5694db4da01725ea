"""The print sheet of a specimen: resins, orientation, cleaning, layers with their frequencies, findings."""

from collections.abc import Mapping

from pneutouch.printability import Finding
from pneutouch.units import grams
from pneutouch.workflows.specimen.draw import SpecimenBodies
from pneutouch.workflows.specimen.truth import frequencies, title


def sheet(drawn: SpecimenBodies, findings: list[Finding], input_hash: str, left_out: Mapping[str, str]) -> str:
    """Markdown for the operator. Print files carry names and colours; the resin is chosen at the machine.

    ``left_out`` are files that were not written, and why.
    """
    scene, document = drawn.scene, drawn.scene.specimen.document
    speed = scene.specimen.scan.speed_mm_per_s
    listed = [f"- {f.severity}: {f.rule}: {f.body}: {f.message}; {f.fix}." for f in findings] or ["- none"]
    steps = (f"{k}. {line}" for k, line in enumerate(_steps(drawn), start=1))
    parts = (
        f"# Print sheet: {_escaped(document.title)}",
        f"Texture specimen {scene.name}, revision {document.revision}, input {input_hash}",
        "\n".join(_bodies(drawn)),
        f"Machine: {scene.printer.title}, {scene.mode.label}. All bodies are **one "
        "job**: "
        f"load them as one assembly (`{scene.name}.3mf`, or all STL files together), never one by one. They share "
        "one frame, "
        "in millimetres, all coordinates positive. Colours carry no meaning: **choose the resin of each body by "
        "hand**.",
        *(f"Not written: `{name}`. {why}." for name, why in left_out.items()),
        "## Layers",
        f"Depths are from the scanned surface to the pattern's top; frequencies at {speed:g} mm/s.",
        "\n".join(_layers(drawn)),
        "## Steps",
        "\n".join(steps),
        "## Findings of the rules",
        "\n".join(listed),
    )
    return "\n\n".join(parts) + "\n"


def _bodies(drawn: SpecimenBodies) -> list[str]:
    rows = ["| body | file | material | size, mm | volume, mm3 | mass |", "|---|---|---|---|---|---|"]
    for body in drawn.bodies:
        size = " x ".join(f"{length:.1f}" for length in body.bounds[1] - body.bounds[0])
        mass = grams(body.volume, body.material.density_g_per_cm3.nominal)
        rows.append(
            f"| {body.name} | stl/{body.name}.stl | {body.material.label} | {size} | {body.volume:.1f} | {mass:.2f} g |"
        )
    return rows


def _layers(drawn: SpecimenBodies) -> list[str]:
    top = drawn.scene.block.high[2]
    rows = [
        "| layer | kind | pitch, mm | frequency, Hz | depth, mm | along the path, mm | volume, mm3 | share of its "
        "box |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for number, (layer, pattern) in enumerate(zip(drawn.scene.specimen.layer, drawn.patterns, strict=True)):
        low, high = pattern.box.low, pattern.box.high
        pitches = ", ".join(f"{pitch:.4g}" for pitch in pattern.pitches)
        hertz = ", ".join(f"{frequency:.3g}" for frequency in frequencies(drawn, pattern))
        rows.append(
            f"| {_escaped(title(layer, number))} | {layer.kind} | {pitches} | {hertz} | {top - high[2]:.4g} | "
            f"{low[0]:.4g} to {high[0]:.4g} | {pattern.mesh.volume:.1f} | "
            f"{pattern.mesh.volume / pattern.box.volume:.3f} |"
        )
    return rows


def _steps(drawn: SpecimenBodies) -> list[str]:
    scene = drawn.scene
    under = "the frame" if scene.frame is not None else "the bottom"
    marked = " The cut corner of the frame is at x = y = 0, the start of the path." if scene.frame is not None else ""
    return [
        f"Orient it as in the file: {under} on the tray, the scanned surface up. Set the surface finish to glossy: "
        "no support "
        f"then touches the scanned surface.{marked}",
        f"Assign {', '.join(f'{body.material.label} to {body.name}' for body in drawn.bodies)}.",
        f"Remove support from the sides: {scene.printer.support}. The patterns are embedded: nothing has to come out "
        "from inside.",
        "Keep a high-pressure jet off the soft surface; rinse, dry, and let it rest lying flat.",
        "Scan along x from the start of the path; specimen.json holds where each pattern begins and ends.",
    ]


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")
