"""The sentences of a datasheet that do not depend on a calculation."""

from __future__ import annotations

from pneutouch.catalogue import Scene

PAPER = (
    "He, Herzig, Nanayakkara, Maiolino: 3D-printed soft sensors for adaptive sensing with online and offline "
    "tunable-stiffness. Soft Robotics, DOI 10.1089/soro.2021.0074"
)

LIMITS_OF_USE = (
    "Laboratory use. Not a safety component; not for fluids other than clean dry air; not for contact with "
    "food or wounds. The figures hold for slow, central contact with a flat rigid body."
)

RELIABILITY = (
    "Cycles to failure", "Tear under edge contact", "Leak rate of the glued joint", "Storage life", "Drop and shock",
)  # fmt: skip

HANDLING = (
    "Glue the flange on all three faces of its groove: the figures assume a rim that does not move.",
    "Leak test before first use: hold the highest driving pressure for ten minutes.",
    "Condition with five full-depth indentations before calibrating; re-zero after every change of driving pressure.",
    "Reset the driving pressure often: a sealed cavity drifts with temperature.",
    "Clean with water and mild soap. Keep from solvents, sunlight and sharp edges.",
)

DEFINITIONS = (
    ["Sensitivity S", "kPa/N; slope of the least-squares line of pressure rise over force, at a stated driving pressure, dead volume and range"],
    ["k = 2", "interval of a figure: value over and times e to the twofold standard uncertainty (JCGM 100); about 95 % where many sources add up"],
    ["Force range", "from first contact to the first event that ends the range, or to the stated depth"],
    ["Non-linearity", "greatest distance from that line over the full-scale pressure rise"],
    ["Stiffness", "mean slope of force over indentation in the range"],
    ["Apex height", "above the base plane; inside and outside differ by the thinned wall"],
    ["Limit point", "greatest driving pressure of the inflation curve; beyond it the dome snaps"],
)  # fmt: skip

TUNING = (
    "Tuning: sensitivity of this design from no driving pressure to its rated one, by the atlas, with its k = 2 interval "
    "(grey); circles: the predicted states."
)
SHAPES = "Half sections of the deformed wall, shaded by the greatest principal stretch; thin outlines at rest."
NO_SHAPES = "Half sections of the deformed wall are drawn by the solid alone: build with --model solid."


def tradeoff(pressure: float, dead_volume: float) -> str:
    """Caption of the trade-off chart; kPa and mL."""
    return (
        f"Trade-off at {pressure:g} kPa: the greatest force range that goes with each sensitivity, one line a resin of this "
        f"printer with the sensitivities it reaches, wall and radius free to 60 mm, {dead_volume:.3g} mL dead volume, by the atlas; no line crosses a limit."
    )


def description(scene: Scene) -> str:
    """One paragraph: what it is and how it works."""
    membrane = scene.design.membrane
    return (
        f"A soft hemispherical membrane ({membrane.inner_radius_mm:g} mm inner radius, {membrane.wall_thickness_mm:g} mm "
        f"wall, {scene.membrane_material.label}) closes an air cavity on a rigid connector ({scene.connector_material.label}). "
        "Pressing the dome raises the pressure of the trapped air, and the pressure reads the force. Stiffness and "
        "sensitivity are set offline by the resin and online by the driving pressure."
    )


def method(scene: Scene) -> tuple[str, ...]:
    """How to measure what the sheet predicts, after the paper's section 3-B and Supplement C."""
    indentation = scene.design.indentation
    step = scene.design.depth_mm / indentation.steps
    return (
        f"Press a rigid flat plate of {indentation.plate_diameter_mm:g} mm centrally, in {indentation.steps} steps of {step:.2f} mm "
        f"to {scene.design.depth_mm:.2f} mm; hold 4 s.",
        "Return to no contact, rest 30 s and reset the driving pressure between indentations.",
        "Three runs at each driving pressure; record force, cavity pressure and plate position.",
        "Sensitivity is the slope of the least-squares line, with intercept, of pressure rise over force.",
        "Measure the dead volume: close the sensor, inject a known volume of air, read the pressure.",
    )


def printing(scene: Scene) -> list[str]:
    """How to print, clean and assemble, in order."""
    lines = [
        f"Membrane: print in {scene.membrane_material.label}, dome up, rim on the tray. The sensing face then touches no "
        "support and comes out glossy; support fills the cavity and leaves through the open base. Dome down takes less "
        "support but leaves the sensing face matte.",
        f"Membrane support: {scene.printer.support}. Aim the jet through the open base; keep it moving, the wall is soft.",
        f"Connector: print in {scene.connector_material.label}, seat up. Remove support from groove, channel and barb "
        f"({scene.connector_printer.support}). Push a {scene.port.bore_diameter:g} mm drill or wire through the bore.",
        f"Fit: {scene.fit_clearance:.2f} mm a side between flange and groove, the printers' accuracies added up. "
        "Dry-fit, then fill the gap with a flexible adhesive that wets both materials; the flange's underside lies on the seat.",
        f"Tube: push {scene.port.tube_outer_diameter:g} x {scene.port.tube_inner_diameter:g} mm soft tube over the barb; "
        f"the mounting surface needs a hole of at least {scene.port.tube_outer_diameter + 1:g} mm for it.",
    ]
    if scene.membrane_material.is_digital:
        pair = " + ".join(scene.membrane_material.base_resins)
        lines.insert(
            1,
            f"Digital material: choose {scene.membrane_material.title} made of {pair}; the vendor uses the same digits for other pairs.",
        )
    return lines
