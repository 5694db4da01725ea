"""Records of a sensor, the input of the mechanics, in mm, N and MPa; they know no files and no printers."""

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from pneutouch.mechanics.laws import Hyperelastic, hyperelastic, neo_hookean, stiffened
from pneutouch.shape.dome import DomeShape

if TYPE_CHECKING:
    from pneutouch.mechanics.soft.body import SoftBody
    from pneutouch.mechanics.solid.indenter import RigidObject


@dataclass(frozen=True)
class RigidBase:
    """The plane z = 0 on which the dome stands, and a ring around it that opens upwards at 45 degrees; in mm.

    opening: radius of the hole in the plane inside the dome, where it lies at the floor of the shape.  flange: radius
    from which on the outer wall can meet the plane, outside a flange that belongs to the solid; 0: everywhere.
    ring, ring_height: radius of the ring's inner edge at z = 0, and its height; no ring at height 0.
    """

    opening: float = 0.0
    flange: float = 0.0
    ring: float = 0.0
    ring_height: float = 0.0

    def __post_init__(self) -> None:
        sizes = vars(self)
        if not all(np.isfinite(size) and size >= 0.0 for size in sizes.values()):
            stated = ", ".join(f"{name} {size}" for name, size in sizes.items())
            raise ValueError(f"{stated}: the sizes of a base must be finite and not negative")


_PLANE = RigidBase()


@dataclass(frozen=True, slots=True)
class Dome:
    """The unloaded membrane. ``flange`` is the width and thickness of a flange that is clamped as printed; None: the
    wall is clamped at the base plane, as in the paper. ``base`` is the body on which the wall can lie down next to its
    clamp and inside; None: the wall passes through the base plane."""

    shape: DomeShape
    flange: tuple[float, float] | None = None
    base: RigidBase | None = _PLANE

    @property
    def inner_radius(self) -> float:
        """Radius of the inner face at the base plane, mm."""
        return self.shape.inner_radius

    @property
    def wall_thickness(self) -> float:
        """Thickness of the wall, mm."""
        return self.shape.wall_thickness


@dataclass(frozen=True, slots=True)
class WallMaterial:
    """The elastic wall. ``break_stretch`` is the stretch at which the resin may break; None if unknown.

    ``law`` is the name of a hyperelastic law and its constants; None: the wall is neo-Hookean with ``shear_modulus``.
    With a law, ``shear_modulus`` is the modulus of the neo-Hookean wall that stands for it in the atlas.
    ``largest_stretch`` is the uniaxial stretch up to which the law was fitted; None if unknown. ``grade`` has arc
    positions, 0 pole to 1 rim, and moduli there over ``shear_modulus``, linear in between; None: homogeneous.
    """

    shear_modulus: float
    poisson_ratio: float
    break_stretch: float | None = None
    law: tuple[str, tuple[float, ...]] | None = None
    grade: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    largest_stretch: float | None = None

    @property
    def hyperelastic(self) -> Hyperelastic:
        """The hyperelastic law. Raises InputError for constants that give no stable solid."""
        if self.law is None:
            return neo_hookean(self.shear_modulus, self.poisson_ratio)
        return hyperelastic(*self.law, self.poisson_ratio)

    @property
    def fitted(self) -> bool:
        """True for a law that was fitted to measured curves, and beside it the neo-Hookean ``shear_modulus``."""
        return self.law is not None and self.largest_stretch is not None


@dataclass(frozen=True, slots=True)
class GasCircuit:
    """The gas behind the membrane: absolute ``ambient_pressure``, ``dead_volume``, upper end of the gauge's range."""

    ambient_pressure: float
    dead_volume: float
    gauge_limit: float

    def injected(self, pressure: Any, volume: Any, at_rest: float) -> Any:
        """Gas that fills a vented cavity of volume ``at_rest`` to a pressure and volume, mm3 at ambient pressure."""
        absolute = pressure + self.ambient_pressure
        return absolute * (volume + self.dead_volume) / self.ambient_pressure - at_rest - self.dead_volume


class Filling(NamedTuple):
    """A quantity that fixes an inflated state in place of its pressure, unique where one pressure has two states: the
    gas ``injected`` into the vented sensor, mm3 at ambient pressure, or the height of the ``apex`` outside, mm."""

    kind: Literal["injected", "apex"]
    value: float


@dataclass(frozen=True, slots=True)
class IndentationProtocol:
    """The test: a plate or an object moved from first contact to the indentation ``depth`` in ``steps`` equal steps.

    The solid checks the stability of the press for 1 to ``waves`` waves around the axis; 0: no check. ``body`` replaces
    the flat plate; ``plate_rim`` is the radius of its rim, None if not stated; ``friction`` is Coulomb's coefficient,
    inf for a surface that grips. The object's axis is at the distance ``offset`` from the dome's; a plate leans by
    ``tilt`` (rad), upwards on the side of the offset; after the press the object moves by ``shear`` to that side.
    ``soft``: what the object is made of; None: it is rigid.
    """

    plate_radius: float
    depth: float
    steps: int
    waves: int = 0
    body: "RigidObject | None" = None
    plate_rim: float | None = None
    friction: float = 0.0
    offset: float = 0.0
    tilt: float = 0.0
    shear: float = 0.0
    soft: "SoftBody | None" = None

    @property
    def off_axis(self) -> str | None:
        """Reason in words why the contact is not axisymmetric (offset, lying body, tilt or shear); None if it is."""
        if self.offset:
            return f"the object stands {self.offset:g} mm off the axis"
        if self.body is not None and self.body.lying:
            return f"the object is no body of revolution: {self.body.label}"
        if self.tilt:
            return f"the plate leans by {np.degrees(self.tilt):.4g}°"
        return f"the object moves {self.shear:g} mm sideways after pressing" if self.shear else None

    @property
    def other_contact(self) -> str | None:
        """Difference in words from a central, frictionless plate, the only contact of membrane and atlas; or None."""
        if self.off_axis is not None:
            return self.off_axis
        if self.soft is not None:
            return f"the object is a {self.soft.label}"
        if self.body is not None:
            return f"the object is a {self.body.label}, not a plate"
        if self.friction > 0.0:
            return f"the contact has friction ({self.friction:g})"
        return None if self.plate_rim is None else "the radius of the plate's rim is stated"


@dataclass(frozen=True, slots=True)
class ResponseCorrection:
    """Factors on the contact force and the pressure rise of atlas and solid, from a calibration.

    Attributes:
        driving_pressures: Driving pressures of the factors, MPa, ascending; empty: nothing is corrected.
        force_factors, rise_factors: The factors; their logarithms are linear in between and constant beyond.
    """

    driving_pressures: tuple[float, ...] = ()
    force_factors: tuple[float, ...] = ()
    rise_factors: tuple[float, ...] = ()

    def at(self, driving_pressure: float) -> tuple[float, float]:
        """Factors on force and rise at a driving pressure, MPa."""
        if not self.driving_pressures:
            return 1.0, 1.0
        logs = (np.log(factors) for factors in (self.force_factors, self.rise_factors))
        force, rise = (float(np.exp(np.interp(driving_pressure, self.driving_pressures, log))) for log in logs)
        return force, rise

    def sensitivity_factor(self, driving_pressure: float) -> float:
        """Factor on the sensitivity, rise factor over force factor, at a driving pressure (MPa)."""
        force, rise = self.at(driving_pressure)
        return rise / force


@dataclass(frozen=True, slots=True)
class Sensor:
    """A dome with the material of its wall, its gas, the indentation test and the correction by a calibration."""

    dome: Dome
    wall: WallMaterial
    gas: GasCircuit
    protocol: IndentationProtocol
    correction: ResponseCorrection = ResponseCorrection()

    def replace(self, **changes: Any) -> "Sensor":
        """The sensor with changed fields of its parts and shape, such as ``replace(depth=5.0, steps=10)``.

        Raises TypeError for a name that is not a field of any part.
        """
        shape = changes.get("shape", self.dome.shape)
        sizes = {field: changes.pop(field) for field in shape.__dataclass_fields__ if field in changes}
        changes["shape"] = dataclasses.replace(shape, **sizes)
        parts = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        for name, part in parts.items():
            new = {field: changes.pop(field) for field in part.__dataclass_fields__ if field in changes}
            parts[name] = dataclasses.replace(part, **new)
        return dataclasses.replace(self, **{**parts, **changes})

    @property
    def even(self) -> "Sensor":
        """The sensor as the atlas takes it: its mean modulus everywhere, the neo-Hookean wall for a fitted law, and a
        sharp corner at its root."""
        even = self if self.wall.grade is None else self.replace(grade=None)
        if even.dome.shape.plain is not even.dome.shape:
            even = even.replace(shape=even.dome.shape.plain)
        return even.replace(law=None) if self.wall.fitted else even

    def of_modulus(self, shear_modulus: float) -> "Sensor":
        """The sensor with another shear modulus (MPa); the stresses of a law change in the same proportion."""
        law = self.wall.law
        if law is not None:
            law = stiffened(*law, shear_modulus / self.wall.shear_modulus)
        return self.replace(shear_modulus=shear_modulus, law=law)
