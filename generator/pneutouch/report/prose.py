"""The sentences of a datasheet: fixed ones, and those filled in from the design."""

from math import isfinite

from pneutouch.catalogue import ResolvedDesign
from pneutouch.spec.contact import ContactTable
from pneutouch.wording import SIMULATED, counted, data_of

WORDS = data_of(__file__)
"""Fixed sentences, and heads of tables, by the part of a sheet in which they stand."""


def front_error(errors: tuple[float, float]) -> str:
    """Median and greatest relative difference between trade-off fronts and the solid, in words."""
    if not all(map(isfinite, errors)):
        return "not checked by it"
    median, greatest = errors
    return f"half of the places checked within {100 * median:.1f} % of it, all within {100 * greatest:.1f} %"


def description(scene: ResolvedDesign) -> str:
    """One paragraph on the sensor and the way it works."""
    membrane, dome = scene.design.membrane, scene.design.membrane.dome
    fillet = membrane.root_fillet_mm and f"root fillet {membrane.root_fillet_mm:g} mm"
    sizes = "".join(f"{words}, " for words in (dome.further, fillet) if words)
    return (
        f"A soft {dome.adjective} membrane ({membrane.inner_radius_mm:g} mm inner radius, "
        f"{sizes}{dome.stated_wall} wall, "
        f"{scene.membrane_material.label}) closes an air cavity on a rigid "
        f"connector ({scene.connector_material.label}). Pressing the dome raises the pressure of the trapped air, and "
        "the pressure reads the force. Stiffness and sensitivity are set offline by the resin and online by the "
        "driving pressure."
    )


def contact_body(scene: ResolvedDesign) -> tuple[str, str, str]:
    """Size, unit and kind of what presses the sensor, for the table of operating conditions."""
    contact = scene.design.contact
    if contact.is_plate:
        return f"Ø{scene.design.indentation.plate_diameter_mm:g}", "mm", _rigid(contact, "plate", "flat, ")
    sizes = {"ball": contact.ball_radius_mm, "cone": contact.cone_tip_radius_mm, "ring": contact.ring_radius_mm}
    sizes |= {"edge": contact.edge_radius_mm, "cylinder": contact.cylinder_radius_mm}
    if contact.object in sizes:
        return f"R{sizes[contact.object]:g}", "mm", _rigid(contact, contact.label)
    widest = max(corner[0] for corner in contact.profile_mm or [])
    return f"Ø{2 * widest:g}", "mm", _rigid(contact, "body with the profile that the section shows")


def _rigid(contact: ContactTable, name: str, shape: str = "") -> str:
    """Words for an object and, if it is rigid, its place: friction before its name, or after it for a coefficient."""
    if contact.softness:
        return f"{contact.label}, {contact.hold}"
    place = f", {contact.place}" if contact.off_axis else ""
    if 0.0 < contact.friction < float("inf"):
        return f"rigid {shape.replace(', ', ' ')}{name}, {contact.hold}{place}"
    return f"rigid, {shape}{contact.hold} {name}{place}"


def presser(scene: ResolvedDesign) -> str:
    """Words for the object that presses the sensor, such as ``rigid ball of 5 mm radius``."""
    contact = scene.design.contact
    if contact.softness:
        return contact.label
    size = f" of {scene.design.indentation.plate_diameter_mm:g} mm" if contact.is_plate else ""
    return f"rigid {contact.label}{size}"


def limits_of_use(scene: ResolvedDesign) -> str:
    """Sentences on the limits of use, and on the contact for which the figures hold."""
    contact = scene.design.contact
    body = "flat rigid body" if contact.is_plate and not contact.softness else presser(scene)
    hold = f" ({contact.hold})" if contact.friction else ""
    use = WORDS["datasheet"]["limits_of_use"]
    return f"{use} The figures hold for slow, {contact.kind_of_place} contact with a {body}{hold}."


def method(scene: ResolvedDesign) -> tuple[str, ...]:
    """Method to measure the predicted figures, after the paper's section 3-B and Supplement C."""
    indentation = scene.design.indentation
    step = scene.design.depth_mm / indentation.steps
    return (
        f"Press a {presser(scene)} {scene.design.contact.where}, in {indentation.steps} steps of "
        f"{step:.2f} mm to {scene.design.depth_mm:.2f} mm; hold 4 s.",
        "Return to no contact, rest 30 s and reset the driving pressure between indentations.",
        "Three runs at each driving pressure; record force, cavity pressure and plate position.",
        "Sensitivity is the slope of the least-squares line, with intercept, of pressure rise over force.",
        "Measure the dead volume: close the sensor, inject a known volume of air, read the pressure.",
    )


def status(scene: ResolvedDesign) -> str:
    """Sentence on the origin of the figures: the design alone, or measured or simulated runs of one specimen."""
    calibration = scene.calibration
    if calibration is None:
        return "Predicted. No unit has been built or tested."
    source = calibration.source
    if source.simulated:
        return f"{SIMULATED}: calibrated on simulated runs of sensor {source.sensor}. No unit has been tested."
    return f"Predicted for sensor {source.sensor} alone, calibrated on {counted(source.curves, 'measured curve')}."
