"""Evaluation of a design: it is drawn and predicted, or refused where that is impossible."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import Resins, compared
from pneutouch.errors import BeyondLimitError, InputError, StatedPressureError, nearest
from pneutouch.evaluation.contact_object import (
    check_first_touch,
    check_object,
    check_plate,
    contact_object,
    fillings_of,
    rigid_base,
    soft_object,
)
from pneutouch.evaluation.table_s1 import sensitivity_error
from pneutouch.mechanics import Sensor, SensorPrediction, predict
from pneutouch.mechanics.gauge_reading import gauge_reading
from pneutouch.mechanics.models.choice import DEFAULT_TOLERANCE, USUAL
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.parts import Assembly, assemble
from pneutouch.spec.read import Changes
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.evaluation.dynamics import SensorBandwidth
    from pneutouch.mechanics.models.interface import Answered
    from pneutouch.mechanics.prediction import CurveOutcome
    from pneutouch.mechanics.rating import Rating
    from pneutouch.mechanics.viscous.describe import ViscousRuns
    from pneutouch.printability import Finding
    from pneutouch.results.printing import JobEstimate
    from pneutouch.results.uncertainty import UncertaintyRecord

# Print rules, uncertainty and calibrations load where they are used: figures of a drawn sensor need none of them.

CLAMPS = ("base", "flange")
"""Names of the faces at which the solid can be held."""


@dataclass(frozen=True)
class PredictionOptions:
    """Options of a prediction: the model, the membrane's closure, the clamp and the tolerance that ``auto`` must meet.

    ``aged`` requests the sensor after a year; a recipe does not carry it: what is printed is fresh.
    """

    model: str = "solid"
    closure: str = "variational"
    clamp: str = "base"
    tolerance: float = DEFAULT_TOLERANCE
    aged: bool = False


@dataclass(frozen=True)
class Evaluation:
    """A scene with its bodies and its prediction; all else is computed when it is first used."""

    scene: ResolvedDesign
    assembly: Assembly
    sensor: Sensor
    prediction: SensorPrediction
    options: PredictionOptions
    find_resins: Callable[[], Resins]

    def __repr__(self) -> str:
        return f"Evaluation({self.scene.name!r}, {self.prediction!r})"

    @cached_property
    def resins(self) -> Resins:
        """Elastomers by name that the design is compared with and the model's error is taken from."""
        return self.find_resins()

    @property
    def alike(self) -> Resins:
        """Those of `resins` that the membrane's printer, or the casting profile, makes."""
        return {name: one for name, one in self.resins.items() if self.scene.printer.mode_for(one) is not None}

    @cached_property
    def findings(self) -> list[Finding]:
        """Findings of the print rules, with the parts that end them."""
        from pneutouch.evaluation.subject import with_parts

        return with_parts(self.findings_alone, self.scene)

    @cached_property
    def findings_alone(self) -> list[Finding]:
        """Findings of the print rules; no port is drawn for their remedies, which takes longer than a prediction."""
        from pneutouch.evaluation.subject import sensor_findings
        from pneutouch.printability import SensorContext

        # What is printed is the wall as drawn, whatever wall a calibration gives the model.
        drawn = self.sensor.replace(wall_thickness=self.assembly.layout.wall)
        calibrated = self.scene.calibration is not None
        context = SensorContext(
            self.prediction, drawn, self.rating, calibrated=calibrated, gauge=self.scene.gauge, curves=self.curves
        )
        return sensor_findings(self.assembly, context)

    @cached_property
    def estimates(self) -> tuple[JobEstimate, ...]:
        """Estimates of each print job: resin, support, layers, time."""
        from pneutouch.evaluation.subject import made_of
        from pneutouch.printability.estimate import estimate

        return tuple(estimate(made_of(self.assembly)))

    def deep_findings(self) -> list[Finding]:
        """Findings of pymeshlab, an independent reader, on the meshes. Raises InputError if it is not installed."""
        from pneutouch.printability.inspection import inspect

        tolerance, solids = self.scene.mesh_tolerance, self.assembly.solids
        pairs = zip(self.assembly.bodies, solids, strict=True)
        return [finding for body, solid in pairs for finding in inspect(body, solid, tolerance)]

    @cached_property
    def uncertainty(self) -> tuple[UncertaintyRecord, ...]:
        """Uncertainty of the figures of each state, computed on first use: a sweep without it takes less time."""
        from pneutouch.evaluation.uncertainty import uncertainties

        return uncertainties(self.prediction, self.sensor, self.scene, lambda: self.resins)

    @cached_property
    def filled_uncertainty(self) -> tuple[UncertaintyRecord, ...]:
        """Uncertainty of the states given by their filling, as `uncertainty`."""
        if not self.prediction.filled:
            return ()
        from pneutouch.evaluation.filled import filled_uncertainties

        return filled_uncertainties(self.prediction, self.sensor, self.scene, list(self.resins.values()))

    @cached_property
    def as_drawn(self) -> SensorPrediction | None:
        """Prediction with the gas as drawn, if a dead volume of 0 is stated behind a tube: by the atlas, for a law
        that this does not hold by the solid. Else None, as for the model membrane, which loads no tables."""
        if not self.assembly.dead_volume_note or self.prediction.model == "membrane":
            return None
        sensor = self.sensor.replace(dead_volume=self.assembly.drawn_volume)
        plain = sensor.wall.law is None or sensor.protocol.other_contact is not None
        try:
            pressures = [state.driving_pressure for state in self.prediction.states]
            return predict(
                self.scene.name, sensor, pressures, model="atlas" if plain and pressures[0] >= 0.0 else "solid"
            )
        except InputError:
            return None

    @cached_property
    def rating(self) -> Rating:
        """The rated pressure, by the limits of the prediction's model."""
        from pneutouch.mechanics.rating import ratings

        error, scene = abs(self.prediction.error_estimate.limit_pressure_relative), self.scene
        known = scene.membrane_material, scene.printer, scene.calibration, error
        return ratings([self.prediction.limits], [self.sensor], *known)[0]

    @cached_property
    def curves(self) -> tuple[CurveOutcome, ...]:
        """Outcomes by every mixing curve of the membrane's mix; empty for a resin, and for a calibrated sensor."""
        if self.scene.calibration is not None or not self.scene.membrane_material.curves:
            return ()
        from pneutouch.evaluation.subject import curve_outcomes

        known = (self.scene.membrane_material, self.scene.printer)
        return curve_outcomes(self.sensor, *known, self.prediction, self.rating)

    @cached_property
    def bandwidth(self) -> SensorBandwidth:
        """Speed of the sensor's reading; see docs/background/dynamics.md."""
        from pneutouch.evaluation.dynamics import sensor_bandwidth

        return sensor_bandwidth(self.assembly, self.sensor, self.prediction)

    @cached_property
    def viscous_runs(self) -> ViscousRuns | str:
        """Relaxation and loops of every state, or the reason why they are not predicted."""
        from pneutouch.evaluation.relaxation import viscous_runs

        return viscous_runs(self.prediction, self.scene.membrane_material, self.sensor)


def evaluate(
    design: str | DesignSource,
    changes: Changes | None = None,
    *,
    model: str = "solid",
    closure: str = "variational",
    clamp: str = "base",
    tolerance: float = DEFAULT_TOLERANCE,
    library: Library | None = None,
    aged: bool = False,
) -> Evaluation:
    """Load, draw and predict a design given by name, by path or as a source. Raises InputError if it cannot work.

    ``tolerance`` is what ``model="auto"`` must meet. ``clamp`` is where the solid is held: at the
    "base" plane, as in the paper, or at the "flange", as printed.
    ``aged`` shifts the resin's modulus by its hardness after a year (docs/background/ageing.md).
    """
    if clamp not in CLAMPS:
        raise InputError(f"unknown.{nearest(clamp, CLAMPS)}", key="clamp", value=clamp)
    library = library or Library.default()
    scene = load_scene(design, changes, library)
    options = PredictionOptions(model, closure, clamp, tolerance, aged)
    return evaluate_scene(scene, partial(compared, library, scene.printer), options)


def evaluate_scene(scene: ResolvedDesign, find_resins: Callable[[], Resins], options: PredictionOptions) -> Evaluation:
    """Draw and predict a scene; ``find_resins`` gives the resins to compare with, when they are needed.

    Raises InputError if the scene cannot work.
    """
    return evaluate_drawn(drawn(scene, options), find_resins)


class DrawnScene(NamedTuple):
    """A scene with its bodies and sensor, the options with the chosen model, and assumptions on ageing."""

    scene: ResolvedDesign
    assembly: Assembly
    sensor: Sensor
    options: PredictionOptions
    aged: tuple[str, ...]


def drawn(scene: ResolvedDesign, options: PredictionOptions) -> DrawnScene:
    """Draw a scene and make its sensor, without a prediction. Raises InputError if it cannot work."""
    if options.model == USUAL:
        options = replace(options, model="harmonic" if scene.design.contact.off_axis else "solid")
    if scene.calibration is not None:
        from pneutouch.evaluation.calibrated import check_options

        check_options(scene, options.model, options.clamp)
    assembly = assemble(scene)
    if options.clamp == "flange" and not assembly.layout.shape.plain.upright:
        problem = f"the wall of a {assembly.layout.shape.key} does not stand upright on the base plane"
        remedy = "take `clamp` base; a flange held as printed is modelled under upright walls"
        raise InputError(problem, file=scene.where, key="clamp", value=options.clamp, remedy=remedy)
    sensor = sensor_of(assembly, options.clamp)
    notes: list[str] = []
    if options.aged:
        sensor, *notes = _aged(scene, sensor)
    check_object(scene, sensor)
    return DrawnScene(scene, assembly, sensor, options, tuple(notes))


def evaluate_drawn(
    drawn: DrawnScene, find_resins: Callable[[], Resins], answers: Mapping[str, Answered] = MappingProxyType({})
) -> Evaluation:
    """Predict a drawn scene; ``answers``: results already computed, by model. Raises InputError if it cannot work."""
    scene, assembly, sensor, options, aged = drawn
    pneumatics = scene.design.pneumatics
    pressures = [p * KPA for p in pneumatics.driving_pressures_kPa]
    try:
        prediction = predict(
            scene.name,
            sensor,
            pressures,
            model=options.model,
            closure=options.closure,
            tolerance=options.tolerance,
            answers=answers,
            fillings=fillings_of(scene),
        )
    except BeyondLimitError as error:
        raise _beyond_limit(scene, error) from None
    except InputError as error:
        if error.file is None and (error.key or "").startswith(("contact.", "pneumatics.")):
            error.file = scene.where
        raise
    known, more = None, [*aged]
    if scene.calibration is not None:
        from pneutouch.evaluation.calibrated import assumption, calibrated_error, unmeasured

        known = calibrated_error(scene.calibration)
        deepest = max(state.range_end for state in prediction.states)
        more = [assumption(scene), *unmeasured(scene, deepest), *more]
    known = known or sensitivity_error(scene.membrane_material, sensor, prediction.model, options.closure)
    prediction = replace(prediction, error_estimate=prediction.error_estimate.with_sensitivity(known))
    check_plate(scene, prediction)
    check_first_touch(scene, prediction)
    if assembly.dead_volume_note:
        more.append(f"dead volume of 0 mL is {assembly.dead_volume_note}")
    if more:
        prediction = replace(prediction, assumptions=(*prediction.assumptions, *more))
    return Evaluation(scene, assembly, sensor, prediction, options, find_resins)


def sensor_of(assembly: Assembly, clamp: str = "base") -> Sensor:
    """Sensor of an assembly for the mechanics, in mm and MPa, with the parameters of a calibration if there is one."""
    layout = assembly.layout
    design = assembly.scene.design
    sensor = _material_sensor(assembly.scene).replace(
        shape=layout.shape,
        ambient_pressure=design.pneumatics.ambient_pressure_kPa * KPA,
        dead_volume=assembly.dead_volume,
        gauge_limit=gauge_reading(assembly.scene.gauge, design.pneumatics.ambient_pressure_kPa * KPA).limit,
        plate_radius=0.5 * design.indentation.plate_diameter_mm,
        depth=design.depth_mm,
        steps=design.indentation.steps,
        waves=design.indentation.checked_waves,
        body=contact_object(assembly.scene),
        soft=soft_object(assembly.scene),
        plate_rim=design.contact.plate_rim_mm,
        friction=design.contact.friction,
        offset=design.contact.offset_mm,
        tilt=math.radians(design.contact.tilt_deg),
        shear=design.contact.shear_mm,
        base=rigid_base(assembly),
        flange=(layout.flange_width, layout.flange_thickness) if clamp == "flange" else None,
    )
    if assembly.scene.calibration is None:
        return sensor
    from pneutouch.evaluation.calibrated import calibrated_sensor

    return calibrated_sensor(sensor, assembly.scene.calibration)


def _material_sensor(scene: ResolvedDesign) -> Sensor:
    """The paper's sensor in the scene's resin. Raises InputError, on the design's key of the material, for its law."""
    try:
        return material_sensor(scene.membrane_material)
    except InputError as error:
        raise _material_error(scene, error) from None


def _material_error(scene: ResolvedDesign, error: InputError) -> InputError:
    """InputError of a material, moved to the key of the design that names the material."""
    return InputError(str(error), file=scene.where, key="membrane.material", value=scene.design.membrane.material)


def _aged(scene: ResolvedDesign, sensor: Sensor) -> tuple[Sensor, str]:
    """The sensor after a year, and the assumption on it. Raises InputError if its hardness is not known then."""
    from pneutouch.mechanics.viscous.describe import AGED, ageing_ratio

    material = scene.membrane_material
    remaining = 1.0 if scene.calibration is None else scene.calibration.remaining_year
    try:
        ratio = ageing_ratio(material) ** remaining
    except InputError as error:
        raise _material_error(scene, error) from None
    assert material.shore_a is not None and material.shore_a_one_year is not None
    hardness = f"Shore A {material.shore_a.nominal:g} to {material.shore_a_one_year.nominal:g}"
    shifted = sensor.replace(shear_modulus=ratio * sensor.wall.shear_modulus)
    return shifted, f"aged one year: {hardness}, modulus times {ratio:.3f}. {AGED}"


def _beyond_limit(scene: ResolvedDesign, error: BeyondLimitError) -> InputError:
    """InputError for a driving pressure beyond the limit point, on the key of the design file that states it."""
    pressures_kPa = scene.design.pneumatics.driving_pressures_kPa
    k = int(np.argmin([abs(p - error.pressure / KPA) for p in pressures_kPa]))
    return StatedPressureError(
        error.pressure,
        error.limit,
        "beyond the limit point, where the dome snaps; with this resin, wall and radius it must be at most "
        f"{error.limit / KPA:.2f} kPa"
        if error.pressure > 0.0
        else f"the dome buckles before; it must be at least {math.ceil(100.0 * error.limit / KPA) / 100.0:.2f} kPa",
        file=scene.where,
        key=f"pneumatics.driving_pressures_kPa[{k}]",
        value=pressures_kPa[k],
    )
