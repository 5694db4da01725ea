"""Uncertainty of a prediction, state by state: the budget at its driving pressures, with the figures of its model.

Uncertainty of a graded wall: the figures of the solid, the relative uncertainty of the even wall of its mean modulus.

The atlas covers only even walls (of one modulus). Differences of the solid would take two presses for each of six
inputs, half a second each and state, and on meshes coarse enough to be quick they are noise: at 12 cells the derivative
of the sensitivity by the wall of `designs/graded-dome.toml`, unpressurised, is +0.05, on the usual mesh -0.47. So the
derivatives are those of the even wall of the same mean modulus, -0.47 too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.contact_object import contact_notes
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.mechanics import Sensor, SensorPrediction, SensorState
from pneutouch.mechanics.models.accuracy import TREND, limit_discretisation
from pneutouch.mechanics.models.choice import stated_error
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.results.uncertainty import FigureRecord, SampledInterval, SampleRecord, UncertaintyRecord
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.wording import data_of, rounded

if TYPE_CHECKING:
    from pneutouch.mechanics.atlas.press import SensorBatch
    from pneutouch.mechanics.uncertainty.contact_model import ContactModel
    from pneutouch.mechanics.uncertainty.propagate import Budget
    from pneutouch.mechanics.uncertainty.source import UncertaintySource
    from pneutouch.spec.calibration import SensorCalibration

GAP, STEEP_GAP = 0.2, 0.45
"""Greatest distance of d ln sensitivity / d ln modulus, and by wall, of the even wall from those of the graded solid,
for the paper's sensor: with one end 6 times as stiff as the other, either one, and with the rim 13 times as stiff as
the pole (`tests/evaluation/test_graded_uncertainty.py`)."""

_WORDS: dict[str, str] = data_of(__file__)


def notes_on(sensor: Sensor) -> tuple[str, ...]:
    """Notes on the uncertainty of a graded wall and of a fitted law; empty for other walls."""
    graded = () if sensor.wall.grade is None else (_WORDS["graded"].format(gap=GAP, steep=STEEP_GAP),)
    return (*graded, _WORDS["law"]) if sensor.wall.fitted else graded


_VACUUM = "the derivatives are the atlas's, which has no states below ambient pressure"


@dataclass(frozen=True)
class SensorBudget:
    """A sensor at n driving pressures as a batch, and its budget; ``contact`` None: a plate without friction."""

    batch: SensorBatch
    budget: Budget
    contact: ContactModel | None = None


def unknown(sensor: Sensor, model: str) -> str | None:
    """Reason why the uncertainty of a model's prediction is unknown, or None if it is known.

    The atlas must cover the sensor under a plate without friction; the solid computes the effect of other contact."""
    if model == "membrane":
        return TREND
    # The atlas loads scipy, for which a prediction by the membrane alone must not pay.
    from pneutouch.mechanics.atlas.coverage import outside_atlas, under_plate

    why = outside_atlas(under_plate(sensor))
    return None if why is None else f"the sensor is outside the atlas: {why}"


class SensorSpread(NamedTuple):
    """A sensor at n driving pressures as a batch, and its sources; ``contact`` None: a plate without friction."""

    batch: SensorBatch
    sources: list[UncertaintySource]
    contact: ContactModel | None

    def combined(self) -> SensorBudget:
        """The budget that these sources give."""
        from pneutouch.mechanics.uncertainty.propagate import propagate

        return SensorBudget(self.batch, propagate(*self), self.contact)


def spread(
    sensor: Sensor,
    pressures: Sequence[float],
    material: Material,
    materials: Sequence[Material],
    printer: Printer,
    model: str,
    calibration: SensorCalibration | None = None,
    states: Sequence[SensorState] = (),
    *,
    anywhere: bool = False,
    aged: float = 1.0,
    batch: SensorBatch | None = None,
) -> SensorSpread:
    """The sources of a sensor at ascending driving pressures (MPa); the atlas covers it under a plate without friction.

    ``materials`` are all known resins: the model's error is taken from the measured ones. ``model`` gives the numerical
    error. ``states`` are those of the solid under another contact, at pressures already solved. ``anywhere`` counts an
    unknown place of contact, if the design's own is the central plate; ``aged`` is the age that counts, years.
    ``batch`` are several sensors, in place of this one at its pressures, for which everything else is the same.
    """
    from pneutouch.mechanics.atlas.coverage import under_plate
    from pneutouch.mechanics.atlas.press import batch_of
    from pneutouch.mechanics.uncertainty.sources import sources
    from pneutouch.mechanics.uncertainty.sources.model_error import model_errors

    contact = None
    anywhere = anywhere and sensor.protocol.other_contact is None
    if sensor.protocol.other_contact is not None:
        from pneutouch.mechanics.uncertainty.contact_model import ContactModel

        of_friction = None
        if calibration is not None:
            from pneutouch.evaluation.calibrated import friction_spread

            of_friction = friction_spread(calibration)
        contact = ContactModel(sensor, tuple(float(p) for p in pressures), states, fitted_spread=of_friction)
    batch = batch_of(under_plate(sensor), pressures) if batch is None else batch
    numerical = {SENSITIVITY_KEY: stated_error(model, sensor), "limit_pressure_kPa": limit_discretisation(sensor)}
    of_sensor = sources(
        batch,
        material,
        printer,
        near_paper=is_near_paper(sensor),
        errors=model_errors(material, materials),
        numerical=numerical,
        calibration=calibration,
        contact=contact,
        anywhere=anywhere,
        aged=aged,
    )
    return SensorSpread(batch, of_sensor, contact)


def why_unknown(sensor: Sensor, model: str) -> str | None:
    """`unknown`, but None for a wall too soft for the atlas if the derivatives of its tables still hold."""
    why = unknown(sensor, model)
    if why is None or model != "solid" or sensor.protocol.other_contact is not None:
        return why
    from pneutouch.mechanics.atlas.coverage import outside_atlas
    from pneutouch.mechanics.atlas.figures import wider_box

    why = outside_atlas(sensor, wider_box())
    return None if why is None else f"the sensor is outside the atlas: {why}"


def uncertainties(
    prediction: SensorPrediction,
    sensor: Sensor,
    scene: ResolvedDesign,
    resins: Callable[[], Mapping[str, Material]],
    samples: int = 0,
) -> tuple[UncertaintyRecord, ...]:
    """One record for each state, see `mechanics.uncertainty.document`, with its ``summary``; or why it is ``unknown``.

    ``resins`` gives the elastomers whose measurements the model's error is taken from. ``samples`` > 0 adds
    ``monte_carlo``: the same sources sampled that often, the 95.45 % interval of every figure.
    """
    blown = tuple(state for state in prediction.states if state.driving_pressure >= 0.0)
    known = iter(_of_blown(replace(prediction, states=blown), sensor, scene, resins, samples) if blown else ())
    sucked = UncertaintyRecord(unknown=_VACUUM)
    records = tuple(sucked if state.driving_pressure < 0.0 else next(known) for state in prediction.states)
    covered = all(one.unknown is None for one in records) and sensor.dome.shape.plain is sensor.dome.shape
    if covered or prediction.model not in ("solid", "local") or sensor.dome.flange or sensor.protocol.other_contact:
        # On a flange as printed the solid would take minutes.
        return records
    from pneutouch.evaluation.filled import driven_uncertainties

    return driven_uncertainties(prediction, sensor, scene, list(resins().values()))


def _of_blown(
    prediction: SensorPrediction,
    sensor: Sensor,
    scene: ResolvedDesign,
    resins: Callable[[], Mapping[str, Material]],
    samples: int,
) -> tuple[UncertaintyRecord, ...]:
    """`uncertainties` of states from ambient pressure on."""
    states, model = prediction.states, prediction.model
    notes_of_wall, fitted, sensor = notes_on(sensor), sensor.wall.fitted, sensor.even
    why = why_unknown(sensor, model)
    if why is not None:
        return tuple(UncertaintyRecord(unknown=why) for _ in states)
    if unknown(sensor, model) is not None:
        notes_of_wall += (_WORDS["soft"].format(sensor.gas.ambient_pressure / sensor.wall.shear_modulus),)
    from pneutouch.mechanics.atlas.figures import FIGURES
    from pneutouch.mechanics.uncertainty.document import DIGITS, NOTHING, document, gas_text, text, values_of

    pressures, materials = [state.driving_pressure for state in states], list(resins().values())
    calibrated = scene.calibration is not None
    estimate = spread(
        sensor,
        pressures,
        scene.membrane_material,
        materials,
        scene.printer,
        model,
        calibration=scene.calibration,
        states=states,
        anywhere=scene.design.contact.anywhere,
    ).combined()
    friction = None if estimate.contact is None else estimate.contact.friction
    notes_of_wall += contact_notes(sensor, estimate.contact)
    if scene.design.contact.anywhere:
        from pneutouch.evaluation.anywhere import place_unknown

        uncovered = place_unknown(prediction, sensor, states)
        notes_of_wall += () if uncovered is None else (f"the place of contact is not in the budget: {uncovered}",)
    content = []
    # The air's effects are those of the atlas's wall: a fitted law's are computed by the solid.
    airs: list[tuple[str, ...]] = [()] * len(states) if fitted else gas_text(estimate.batch)
    for row, (state, notes) in enumerate(zip(states, airs, strict=True)):
        values = values_of(prediction, state)
        entry = document(estimate.budget, row, values, (*notes_of_wall, *notes), calibrated=calibrated)
        elasticities = dict(entry.elasticities or {})
        if friction is not None and friction.elasticities is not None:
            for name, slope in zip(FIGURES, friction.elasticities[:, row], strict=True):
                if name in elasticities and np.isfinite(slope):
                    elasticities[name] = {**elasticities[name], "friction": float(slope)}
        entry = replace(
            entry,
            elasticities=elasticities,
            summary=text(estimate.budget, row, calibrated=calibrated),
            monte_carlo=_sampled(estimate, row, samples, entry.known) if samples else None,
        )
        content.append(rounded(entry, DIGITS, NOTHING))
    return tuple(content)


def _sampled(estimate: SensorBudget, row: int, samples: int, figures: Mapping[str, FigureRecord]) -> SampleRecord:
    """The 95.45 % intervals of the samples, scaled to the model's figures, and the share without a figure."""
    from pneutouch.mechanics.atlas.figures import FIGURES
    from pneutouch.mechanics.uncertainty.document import monte_carlo

    budget = estimate.budget
    drawn = monte_carlo(estimate.batch, budget.sources, row, samples, shift=budget.shift)
    intervals: dict[str, SampledInterval] = {}
    for i, name in enumerate(FIGURES):
        if name in figures and drawn.lost[i] < 1:
            scale = figures[name].value / float(budget.values[i, row])
            intervals[name] = SampledInterval(
                scale * float(drawn.low[i]), scale * float(drawn.high[i]), float(drawn.lost[i])
            )
    return SampleRecord(samples, intervals)
