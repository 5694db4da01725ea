"""The print sheet: which body takes which resin on which machine, how it is made step by step, and its order code."""

from collections.abc import Mapping

from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.parts.glue import GLUES, glue_of
from pneutouch.parts.mould.assembly import SiliconeBatch
from pneutouch.report.mould import mould_rows
from pneutouch.report.pages import filled
from pneutouch.report.section import port_steps
from pneutouch.results.printing import JobEstimate
from pneutouch.spec.part import CastRing, ClampedFlange, OnePiece, RobotFlange, Sleeve
from pneutouch.units import ML
from pneutouch.wording import counted


def making(scene: ResolvedDesign, pour: SiliconeBatch | None = None) -> list[str]:
    """Steps to make, clean and assemble a sensor, in order; ``pour``: silicone of a cast membrane, else None."""
    grown = isinstance(scene.seat, OnePiece)
    lines = _printed(scene, grown) if pour is None else casting_steps(scene, pour)
    if isinstance(scene.seat, CastRing):
        lines.insert(0, _perforated_ring(scene))
    if not grown:
        screwed = isinstance(scene.seat, ClampedFlange)
        what = "channel, screw holes and port" if screwed else "groove, channel and port"
        lines.append(
            f"Connector: print in {scene.connector_material.label}, seat up. Remove support from {what} "
            f"({scene.connector_printer.support})."
        )
    return [*lines, *_assembly(scene), port_steps(scene), *_mounting(scene)]


def making_title(pour: SiliconeBatch | None) -> str:
    """Heading of the steps on the datasheet; ``pour`` as in `making`."""
    return "Material and print" if pour is None else "How to make it"


def body_rows(sheet: SheetData) -> list[list[str]]:
    """Rows of the sensor's bodies: name, material, volume and mass, machine and mode, support."""
    rows = []
    for solid in sheet.assembly.solids:
        printer, mode = sheet.assembly.machine(solid.name)
        size, machine = f"{solid.volume / ML:.3f} mL, {solid.mass:.2f} g", f"{printer.title}, {mode.label}"
        rows.append([solid.name, solid.material.label, size, machine, printer.support])
    return rows


def _printed(scene: ResolvedDesign, grown: bool) -> list[str]:
    """Steps to print and clean a membrane; ``grown``: in one piece with the connector."""
    lines = [_print_membrane(scene, grown)]
    if scene.membrane_material.is_digital:
        pair = " + ".join(scene.membrane_material.base_resins)
        lines.append(
            f"Digital material: choose {scene.membrane_material.title} made of {pair}; the vendor uses the same digits "
            "for other pairs."
        )
    opening = "the opening" if grown else "the open base"
    lines.append(
        f"Membrane support: {scene.printer.support}. Aim the jet through {opening}; keep it moving, the wall is soft."
    )
    return lines


def casting_steps(scene: ResolvedDesign, pour: SiliconeBatch) -> list[str]:
    """Steps to cast a membrane: release, weigh, mix, degas, pour, cure and demould."""
    silicone = scene.membrane_material
    casting = silicone.casting
    assert casting is not None
    parts = zip("ABC", pour.parts_g, strict=False)
    masses = " and ".join(f"{mass:.2f} g of part {name}" for name, mass in parts)
    ratio = ":".join(f"{part:g}" for part in casting.parts_by_mass)
    pot, cure = casting.pot_life_min.text(), casting.cure_h.text()
    around = isinstance(scene.seat, CastRing)
    basis = (
        f"{pour.volume_mL:.1f} mL, {pour.cavities} x (cavity {pour.cavity_mL:.2f} + channels {pour.channels_mL:.2f} + "
        f"overflow {pour.overflow_mL:.2f} mL) and {pour.loss_mL:.1f} mL left in the cup"
    )
    insert = (
        "Put the perforated ring into the mould's ring, dry and without release agent; file it where it stands out of "
        "either face, for it must let the mould close. "
        if around
        else ""
    )
    flange = "pull the perforated ring straight off the core's foot" if around else "peel the flange off all round"
    return [
        "Mould: print its parts; they lie in their files as they are printed. Drill what came out narrow, clean, dry. "
        f"{casting.release[0].upper()}{casting.release[1:]}, on every face that the silicone "
        f"touches. These stop its cure: {', '.join(casting.inhibited_by)}; wear nitrile gloves, not latex.",
        f"Weigh {masses} of {silicone.title} into one cup, {ratio} by mass, {pour.mass_g:.2f} g together: {basis}.",
        f"Mix 3 min and scrape sides and bottom. Degas under vacuum until the froth has fallen, about 5 min. From the "
        f"start of mixing it flows for {pot} min at room temperature.",
        f"{insert}Pour in a thin stream into cap and ring, the ring in the cap, and lower the core slowly; or close "
        "the mould and press the silicone in with a syringe at one place. The core stands on the ring, the base on the "
        "core's foot; fasten it, base up. Silicone without bubbles must stand in every vent.",
        f"Cure for {cure} h at room temperature, vents up; a cup with the rest of the batch shows whether it is cured.",
        f"Demould: open the mould, {flange}, then roll the dome off the core. Cut sprue and vents "
        "off flush. Wash with soap and dry: release agent spoils every joint.",
    ]


def _print_membrane(scene: ResolvedDesign, grown: bool) -> str:
    soft, rigid = scene.membrane_material.label, scene.connector_material.label
    up = scene.design.print.orientation == "dome-up"
    if grown:
        stands = "dome up" if up else "turned over, dome down"
        return (
            f"Membrane and connector: one print, {stands}, the membrane in {soft}, the connector in {rigid}; load both "
            "bodies as one assembly. Support fills the cavity and leaves through the opening behind it. Plug: print "
            "apart."
        )
    if not up:
        return (
            f"Membrane: print in {soft}, turned over, dome down and rim up. Support stands under the dome, so that the "
            "sensing face comes out matte; the cavity needs none."
        )
    return (
        f"Membrane: print in {soft}, dome up, rim on the tray. The sensing face then touches no "
        "support and comes out glossy; support fills the cavity and leaves through the open base."
    )


def _assembly(scene: ResolvedDesign) -> list[str]:
    """Steps to join membrane and rigid bodies, for each kind of seat."""
    seat, fit = scene.seat, f"Fit: {scene.fit_clearance:.2f} mm a side"
    if isinstance(seat, ClampedFlange):
        return [
            f"Ring: print in {scene.connector_material.label}, cone up. {fit} around the flange. Lay the flange on the "
            f"plate and the ring on the flange; drive {seat.screw_count} {seat.screw} screws crosswise until the "
            f"ring's skirt meets the plate: it then squeezes the flange by {seat.squeeze:.0%}. No glue."
        ]
    if isinstance(seat, OnePiece):
        return [
            f"Plug: print in {scene.connector_material.label}. {fit} in the opening. When the cavity is clean and dry, "
            "glue the plug's shoulder into the counterbore; keep glue off the gap above it, which is part of the air "
            "space."
        ]
    glue = glue_of(scene)
    if isinstance(scene.seat, CastRing):
        assert glue is not None
        return [
            f"{fit} around the ring's collar. Dry-fit. Lay a bead of {GLUES['silicone-adhesive'].title} around the "
            f"spigot and on the groove's floor under the flange: it seals, the ring carries. Wet underside and outside "
            f"of the collar with {GLUES[glue].title}, rigid on rigid, and press the ring down until it stands on the "
            "floor; keep this glue off the silicone, which it does not bond."
        ]
    what = "a flexible adhesive that wets both materials" if glue is None else GLUES[glue].title
    return [
        f"{fit} between flange and groove, the printers' accuracies added up. Dry-fit, then fill the gap with {what}; "
        "the flange's underside lies on the seat."
    ]


def _perforated_ring(scene: ResolvedDesign) -> str:
    """Steps to make the ring that a flange is cast around."""
    cavities = scene.design.mould.cavities
    number = "" if cavities == 1 else f"; make {cavities}, one for each cavity"
    return (
        f"Ring, perforated: print in {scene.connector_material.label}, lying flat{number}. Remove support from under "
        f"its web ({scene.connector_printer.support}), open every hole, degrease with isopropyl alcohol, dry. Silicone "
        "does not bond it: it holds by the holes."
    )


def _mounting(scene: ResolvedDesign) -> list[str]:
    mount = scene.mount
    if isinstance(mount, RobotFlange):
        return [
            f"Mount: centring boss into the robot's flange, dowel in its hole, {mount.count} {mount.screw} screws from "
            "the dome's side."
        ]
    if isinstance(mount, Sleeve):
        return [
            f"Mount: push the sleeve over the {mount.finger_diameter:g} mm finger; tap and drive "
            f"{mount.set_screw_count} {mount.screw} set screws."
        ]
    return []


def part_number(scene: ResolvedDesign) -> str:
    """Part number, such as PNT-R0925-T150-TP-B4-GF-M3."""
    return "-".join(code for code, _ in code_fields(scene))


def code_fields(scene: ResolvedDesign) -> list[tuple[str, str]]:
    """Each field of the part number with its meaning."""
    membrane = scene.design.membrane
    return [
        ("PNT", f"pneumatic touch sensor, {membrane.dome.adjective}"),
        (f"R{100 * membrane.inner_radius_mm:04.0f}", f"inner radius {membrane.inner_radius_mm:g} mm"),
        (f"T{100 * membrane.wall_thickness_mm:03.0f}", f"wall {membrane.wall_thickness_mm:g} mm"),
        (scene.membrane_material.code, scene.membrane_material.label),
        (scene.port.code, scene.port.title),
        (scene.seat.code, scene.seat.title),
        (scene.mount.code, scene.mount.title),
    ]


def print_sheet(sheet: SheetData, left_out: Mapping[str, str]) -> str:
    """Markdown for the operator, who chooses resins at the machine; ``left_out``: reason by file not written."""
    scene, assembly, mould = sheet.scene, sheet.assembly, sheet.assembly.mould
    glue_mL = assembly.glue_volume / ML
    return filled(
        "print-sheet.md.j2",
        sheet=sheet,
        scene=scene,
        number=part_number(scene),
        bodies=[
            (body, solid.material.label, *assembly.machine(body.name), solid.mass)
            for body, solid in zip(assembly.bodies, assembly.solids, strict=True)
        ],
        left_out=left_out,
        deviation=max(assembly.deviation(body) for body in assembly.bodies),
        calibration=scene.calibration,
        parts=[]
        if mould is None
        else [
            (body, mould.counts[body.name], solid.mass) for body, solid in zip(mould.printed, mould.solids, strict=True)
        ],
        facts=[] if mould is None else mould_rows(mould),
        steps=making(scene, sheet.pour),
        jobs=[(job, _swaths(job), _time(job.time_min)) for job in sheet.estimates],
        notes=dict.fromkeys(f"{job.job}: {note}" for job in sheet.estimates for note in job.assumptions),
        glue_mL=glue_mL,
    )


def _swaths(job: JobEstimate) -> str:
    layers = "" if job.layers is None else f"{job.layers}"
    return layers if job.swaths is None else f"{layers} x {counted(job.swaths, 'swath')}"


def _time(time_min: float | None) -> str:
    if time_min is None:
        return "not known"
    minutes = round(time_min)
    return f"{minutes} min" if minutes < 100 else f"{time_min / 60:.1f} h"
