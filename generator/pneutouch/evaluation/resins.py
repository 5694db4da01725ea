"""One design in several resins: the subjects of a campaign's plan and simulation."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from pneutouch.bench.simulate.curve import PressCurves, press_curves
from pneutouch.bench.simulate.runs import SimulationTruth
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import elastomers
from pneutouch.errors import BeyondLimitError, InputError, nearest
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.gauge import reading_of
from pneutouch.mechanics import Sensor, predict
from pneutouch.mechanics.paper_sensor import logarithmic_change
from pneutouch.mechanics.rating import Rating, ratings
from pneutouch.parts import assemble
from pneutouch.spec.campaign import AS_DESIGNED
from pneutouch.spec.read import Changes
from pneutouch.units import KPA

TRUTH = SimulationTruth()

ALL = ("all",)
"""Value of ``resins`` that stands for the resins of the paper's Table S1."""


@dataclass(frozen=True)
class SimulatedResin:
    """A resin's scene and nominal sensor, and the simulator's true parameters for its printer, gauge and ageing."""

    name: str
    scene: ResolvedDesign
    sensor: Sensor
    truth: SimulationTruth

    @cached_property
    def rating(self) -> Rating:
        """The rated pressure; see `rating_of`."""
        return rating_of(self.scene, self.sensor)


def rating_of(scene: ResolvedDesign, sensor: Sensor) -> Rating:
    """The rated pressure of a scene's sensor, by the limits of the cheapest model that is good enough. The limits are
    those of free inflation, where the object does not count: one off the axis is replaced by the central plate."""
    if sensor.protocol.off_axis is not None:
        central = {"body": None, "offset": 0.0, "tilt": 0.0, "shear": 0.0}
        return rating_of(scene, sensor.replace(**central))
    limits = predict("", sensor, [0.0], model="auto").limits
    return ratings([limits], [sensor], scene.membrane_material, scene.printer, scene.calibration)[0]


def resins_of(
    design: str | DesignSource,
    changes: Changes | None,
    resins: Sequence[str],
    truth: SimulationTruth = TRUTH,
    library: Library | None = None,
) -> list[SimulatedResin]:
    """The design in each of ``resins``; in its own if none is given, in Table S1's for `ALL`. Raises InputError."""
    library = library or Library.default()
    given = load_scene(design, changes, library)
    known = elastomers(library, given.printer.is_casting)
    names = list(resins) or [resin_of(given)]
    if tuple(names) == ALL:
        names = sorted(
            (name for name, material in known.items() if material.measured is not None),
            key=lambda name: known[name].shear_modulus_MPa.nominal,  # type: ignore[union-attr]
        )
    simulated = []
    for name in names:
        if name not in known and name != AS_DESIGNED:
            raise InputError(f"no such elastomer.{nearest(name, known)}", key="resins", value=name)
        if names.count(name) > 1:
            raise InputError("named twice", key="resins", value=name, remedy="must be there once")
        own_resin = {} if name == AS_DESIGNED else {"membrane.material": name}
        scene = load_scene(design, {**(changes or {}), **own_resin}, library)
        material = scene.membrane_material
        new, old = material.shore_a, material.shore_a_one_year
        ageing = 0.0 if new is None or old is None else logarithmic_change(new.nominal, old.nominal)
        scatter = replace(truth.scatter, wall=scene.printer.accuracy_mm.nominal, ageing=ageing)
        rig = truth.rig if scene.gauge is None else truth.rig.with_gauge(reading_of(scene))
        read = replace(truth, scatter=scatter, rig=rig)
        simulated.append(SimulatedResin(name, scene, sensor_of(assemble(scene)), read))
    return simulated


def resin_of(scene: ResolvedDesign) -> str:
    """Name that a campaign gives the membrane of a design: its resin, or `AS_DESIGNED` for a mix."""
    chosen = scene.design.membrane.material
    return chosen if isinstance(chosen, str) else AS_DESIGNED


def pressed(resin: str, sensor: Sensor, pressures: Sequence[float], depth: float, model: str) -> PressCurves:
    """Curves of `press_curves` at ascending pressures, MPa, to a depth, mm. Raises InputError with the greatest allowed
    pressure for one beyond the limit point."""
    try:
        return press_curves(sensor, pressures, depth, model)
    except BeyondLimitError as error:
        raise InputError(
            f"{resin}: driving pressure {error.pressure / KPA:g} kPa is beyond the limit point, where the dome snaps; "
            f"it must be less than {error.limit / KPA:.2f} kPa"
        ) from None


def from_ambient(pressures_kPa: Sequence[float]) -> str:
    """The assignment of a design's driving pressures without vacuum, for the command line."""
    kept = sorted({0.0, *(pressure_kPa for pressure_kPa in pressures_kPa if pressure_kPa >= 0.0)})
    return f"pneumatics.driving_pressures_kPa=[{', '.join(f'{pressure_kPa:g}' for pressure_kPa in kept)}]"


def tested_kPa(scene: ResolvedDesign) -> list[float]:
    """The driving pressures of a design, for runs on a rig and for a reader. Raises InputError for a vacuum."""
    pressures_kPa = scene.design.pneumatics.driving_pressures_kPa
    if pressures_kPa[0] < 0.0:
        raise InputError(
            "runs on a rig and readers are of pressures from 0 kPa",
            file=scene.where,
            key="pneumatics.driving_pressures_kPa[0]",
            value=pressures_kPa[0],
            remedy=f"give those alone: `set` '{from_ambient(pressures_kPa)}'",
        )
    return pressures_kPa
