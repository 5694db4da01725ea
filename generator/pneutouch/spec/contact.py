"""[contact] of a design file: the object that presses the sensor, and its friction."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, PlainSerializer, WithJsonSchema, model_validator

from pneutouch.spec.fields import EntryError, FieldsError, Table, number
from pneutouch.wording import data_of

ContactKind = Literal["plate", "ball", "cone", "ring", "profile", "edge", "cylinder"]

_OBJECTS = data_of(__file__)

SIZES: dict[ContactKind, tuple[str, ...]] = {kind: tuple(one["keys"]) for kind, one in _OBJECTS.items()}
"""Keys that each object needs; those of the plate have defaults."""

LYING: tuple[ContactKind, ...] = ("edge", "cylinder")
"""Objects that lie straight across the plane of symmetry; the others are bodies of revolution."""

_MOVABLE: tuple[ContactKind, ...] = ("plate", "ball", *LYING)
"""Objects that can stand off the axis and move sideways."""

NODULE = ("nodule_depth_mm", "nodule_radius_mm", "nodule_modulus_MPa")
SOFTNESS = ("object_modulus_MPa", "object_poisson_ratio", "object_thickness_mm", *NODULE)
"""Keys of a soft object; only the first is needed."""

_COVER = 1.5
"""Least depth of a nodule's middle over its radius: closer to the surface the field at it is not even."""

LARGEST = 250.0
"""Greatest radius of an object, mm: that of the greatest plate."""

_MOST_FRICTION = 10.0
_MOST_CORNERS = 40
_MOST_SHEAR = 50.0


def _coefficient(value: float) -> float:
    if not (0.0 <= value <= _MOST_FRICTION or value == float("inf")):
        raise ValueError(f"friction = {value:g} must be from 0 to {_MOST_FRICTION:g}, or inf for a surface that grips")
    return value


def corners(points: list[list[float]]) -> list[list[float]]:
    """Check a profile's points [r, z] or [r, z, corner radius], mm. Raises ValueError for too many or too large."""
    if not 2 <= len(points) <= _MOST_CORNERS:
        raise ValueError(f"profile_mm has {len(points)} points; give 2 to {_MOST_CORNERS}")
    for index, corner in enumerate(points):
        if len(corner) not in (2, 3):
            raise EntryError("a point is [r, z] or [r, z, radius], mm", index, corner)
        r, z, radius = (*corner, 0.0)[:3]
        if not (0.0 <= r <= LARGEST and abs(z) <= LARGEST and 0.0 <= radius <= LARGEST):
            problem = f"r and the radius must be from 0 to {LARGEST:g} mm, z from {-LARGEST:g} to {LARGEST:g} mm"
            raise EntryError(problem, index, corner)
    return points


Friction = Annotated[
    float,
    BeforeValidator(lambda value: float("inf") if value == "inf" else value),
    AfterValidator(_coefficient),
    PlainSerializer(lambda value: "inf" if value == float("inf") else value, when_used="json"),
    WithJsonSchema({"anyOf": [{"type": "number", "minimum": 0, "maximum": _MOST_FRICTION}, {"const": "inf"}]}),
]
"""A coefficient of friction; in JSON, which has no infinity, a surface that grips is the text "inf"."""


class ContactTable(Table):
    """[contact]: the object that presses the sensor, straight down, and may then move sideways; centrally where it has
    no offset and no tilt."""

    object: ContactKind = Field(
        default="plate", description="What presses the sensor: plate, ball, cone, ring, profile, edge or cylinder."
    )
    plate_diameter_mm: float | None = number(
        None, unit="mm", low=1, high=500, help="Diameter of the flat plate; left out: that of [indentation]."
    )
    plate_rim_mm: float | None = number(
        None, unit="mm", low=0.01, high=50, help="Radius of the plate's rim; left out: a thirtieth of its radius."
    )
    ball_radius_mm: float | None = number(None, unit="mm", low=0.05, high=LARGEST, help="Radius of the ball.")
    cone_half_angle_deg: float | None = number(
        None, unit="deg", low=30, high=85, help="Angle between the cone's axis and its flank."
    )
    cone_tip_radius_mm: float | None = number(
        None, unit="mm", low=0.05, high=LARGEST, help="Radius that the cone's tip is rounded to."
    )
    ring_radius_mm: float | None = number(
        None, unit="mm", low=0.1, high=LARGEST, help="Radius of the circle on which the ring touches a plane."
    )
    ring_section_radius_mm: float | None = number(
        None, unit="mm", low=0.05, high=LARGEST, help="Radius of the ring's round section."
    )
    edge_radius_mm: float | None = number(
        None, unit="mm", low=0.05, high=LARGEST, help="Radius of the nose of a bar that presses with its edge."
    )
    cylinder_radius_mm: float | None = number(
        None, unit="mm", low=0.05, high=LARGEST, help="Radius of a lying cylinder."
    )
    profile_mm: Annotated[list[list[float]], AfterValidator(corners)] | None = Field(
        default=None,
        json_schema_extra={"unit": "mm", "low": -LARGEST, "high": LARGEST},
        description="Underside of a body of one's own: points [r, z] or [r, z, radius] from the axis outwards, z "
        "upwards, joined by lines and each rounded to its radius.",
    )

    object_modulus_MPa: float | None = number(
        None, unit="MPa", low=0.001, high=1e4, help="Young's modulus of a soft plate or ball; left out: it is rigid."
    )
    object_poisson_ratio: float = number(
        0.49, unit="", low=0, high=0.5, help="Poisson's ratio of a soft object; those of silicones are close to 0.5."
    )
    object_thickness_mm: float | None = number(
        None, unit="mm", low=0.2, high=500, help="Thickness of a soft layer on a rigid ground; left out: it is deep."
    )
    nodule_depth_mm: float | None = number(
        None, unit="mm", low=0.5, high=200, help="Depth of the middle of a stiffer ball in a deep soft block."
    )
    nodule_radius_mm: float | None = number(None, unit="mm", low=0.1, high=100, help="Radius of that ball.")
    nodule_modulus_MPa: float | None = number(
        None, unit="MPa", low=0.001, high=1e5, help="Young's modulus of that ball, greater than the block's."
    )
    friction: Friction = Field(
        default=0.0,
        allow_inf_nan=True,
        description="Coefficient of friction between sensor and object, from 0 to 10; inf for a surface that grips.",
    )
    offset_mm: float = number(
        0.0, unit="mm", low=0, high=LARGEST, help="How far a plate, ball, edge or cylinder stands off the dome's axis."
    )
    tilt_deg: float = number(
        0.0, unit="deg", low=0, high=45, help="How far a plate leans about its middle, towards its offset upwards."
    )
    anywhere: bool = Field(
        default=False,
        description="Whether object and place of contact are unknown in use: their effect on the force read is counted "
        "in the interval.",
    )
    shear_mm: float = number(
        0.0,
        unit="mm",
        low=-_MOST_SHEAR,
        high=_MOST_SHEAR,
        help="How far a plate, ball, edge or cylinder moves sideways after pressing, at the same height, towards its "
        "offset; needs friction.",
    )
    base: bool = Field(
        default=True,
        description="Whether the wall lies down on the connector next to its clamp and inside, without friction; "
        "where not, it passes through, and the solid alone answers it.",
    )

    @model_validator(mode="after")
    def _has_its_sizes(self) -> "ContactTable":
        missing = [key for key in SIZES[self.object] if getattr(self, key) is None]
        if missing:
            raise FieldsError(f'object = "{self.object}" needs {" and ".join(missing)}', "object", *missing)
        if "object" not in self.model_fields_set:
            for kind, keys in SIZES.items():
                for key in keys:
                    if getattr(self, key) is not None:
                        raise FieldsError(
                            f'{key} is the size of another object; give object = "{kind}" as well', "object", key
                        )
        if self.object == "ring":
            radius, section = self.ring_radius_mm, self.ring_section_radius_mm
            if radius is not None and section is not None and section >= radius:
                raise FieldsError(
                    f"ring_section_radius_mm = {section:g} must be less than ring_radius_mm = {radius:g}: "
                    "a ring without a hole is a ball",
                    "ring_radius_mm",
                    "ring_section_radius_mm",
                )
        return self

    @model_validator(mode="after")
    def _gives_way(self) -> "ContactTable":
        given = [key for key in SOFTNESS[1:] if getattr(self, key) != type(self).model_fields[key].default]
        if self.object_modulus_MPa is None:
            if given:
                raise FieldsError(f"{given[0]} is of a soft object; give object_modulus_MPa as well", *given)
            return self
        if self.object not in ("plate", "ball") or self.plate_rim_mm is not None:
            problem = "a soft object is a plate without a stated rim (a block or a layer), or a ball"
            raise FieldsError(problem, "object", "object_modulus_MPa", "plate_rim_mm")
        if self.object == "ball" and self.object_thickness_mm is not None:
            problem = "object_thickness_mm of a ball: a soft ball is one body; only a plate is a layer"
            raise FieldsError(problem, "object", "object_thickness_mm")
        if problem := self._bad_nodule():
            raise FieldsError(problem, *NODULE)
        other = [key for key in ("friction", "offset_mm", "tilt_deg", "shear_mm", "anywhere") if getattr(self, key)]
        if other:
            at = f"object_modulus_MPa with {other[0]} = {getattr(self, other[0])}"
            problem = f"{at}: a soft object presses on the axis, without friction"
            raise FieldsError(problem, "object_modulus_MPa", *other)
        return self

    def _bad_nodule(self) -> str:
        """Fault of the nodule of a soft object, in words; empty if it has none."""
        depth, radius, modulus = (getattr(self, key) for key in NODULE)
        if depth is radius is modulus is None:
            return ""
        if depth is None or radius is None or modulus is None:
            return f"a nodule needs {', '.join(NODULE)}"
        if self.object != "plate" or self.object_thickness_mm is not None:
            return "a nodule lies in a deep block: a plate without object_thickness_mm"
        if depth < _COVER * radius:
            return f"nodule_depth_mm = {depth:g} must be at least {_COVER:g} times nodule_radius_mm = {radius:g}"
        stiffer = modulus > (self.object_modulus_MPa or 0.0)
        return "" if stiffer else f"nodule_modulus_MPa = {modulus:g} must be greater than object_modulus_MPa"

    @model_validator(mode="after")
    def _stands_off_the_axis(self) -> "ContactTable":
        if self.offset_mm and self.object not in _MOVABLE:
            raise FieldsError(
                f"offset_mm = {self.offset_mm:g}: a {self.object} presses centrally; only a plate or a ball, an edge "
                "or a cylinder can stand off the axis",
                "object",
                "offset_mm",
            )
        if self.tilt_deg and not self.is_plate:
            raise FieldsError(
                f"tilt_deg = {self.tilt_deg:g}: only a plate can lean, not {self._article}", "object", "tilt_deg"
            )
        if self.shear_mm and self.object not in _MOVABLE:
            raise FieldsError(
                f"shear_mm = {self.shear_mm:g}: only a plate or a ball, an edge or a cylinder moves sideways, not "
                f"{self._article}",
                "object",
                "shear_mm",
            )
        if self.shear_mm and not self.friction:
            raise FieldsError(
                f"shear_mm = {self.shear_mm:g} without friction: the object would slide; give friction above 0, "
                "such as 0.6, or inf",
                "friction",
                "shear_mm",
            )
        return self

    @property
    def off_axis(self) -> dict[str, float | str]:
        """Keys, with values, that make the contact other than axisymmetric; empty if it is axisymmetric."""
        keys = ("offset_mm", "tilt_deg", "shear_mm", *(("object",) if self.is_lying else ()))
        return {key: getattr(self, key) for key in keys if getattr(self, key)}

    @property
    def _article(self) -> str:
        """Object with its article: ``a plate``, ``an edge``."""
        return f"{'an' if self.object == 'edge' else 'a'} {self.object}"

    @property
    def is_lying(self) -> bool:
        """True for an edge or a cylinder, which lies straight across the plane of symmetry."""
        return self.object in LYING

    @property
    def place(self) -> str:
        """Place at which the object presses, its lean and its movement then, in words; empty if it is central, level
        and comes straight down."""
        moved = [f"then moved {self.shear_mm:g} mm sideways"] if self.shear_mm else []
        return ", ".join([*([self._stand] if self._stand else []), *moved])

    @property
    def _stand(self) -> str:
        """Place at which the object presses, and its lean, in words; empty if it is central and level."""
        parts = [f"{self.offset_mm:g} mm off the axis"] if self.offset_mm else []
        parts += [f"leaning by {self.tilt_deg:g}°"] if self.tilt_deg else []
        parts += ["across the middle of the dome"] if self.is_lying and not self.offset_mm else []
        return " and ".join(parts)

    @property
    def kind_of_place(self) -> str:
        """Adjective for the place of contact: ``central`` or ``off-axis``."""
        return "off-axis" if self._stand else "central"

    @property
    def where(self) -> str:
        """Place of contact as an adverb: ``centrally``, ``2 mm off the axis``."""
        return self._stand or "centrally"

    @property
    def is_plate(self) -> bool:
        """True if a flat plate presses the sensor."""
        return self.object == "plate"

    @property
    def is_atlas_plate(self) -> bool:
        """True for the contact of the models membrane and atlas: a rigid central plate, usual rim, no friction."""
        usual = self.is_plate and self.plate_rim_mm is None and self.object_modulus_MPa is None
        return usual and not self.friction and not self.off_axis

    @property
    def label(self) -> str:
        """Object in words, with its sizes; a plate without them, a soft one with what it is made of."""
        widest = max((corner[0] for corner in self.profile_mm or ()), default=0.0)
        label = str(_OBJECTS[self.object]["label"]).format(**self.sizes(), diameter_mm=2 * widest)
        if self.object_modulus_MPa is None:
            return label
        stuff = [f"{self.object_modulus_MPa:g} MPa"]
        stuff += [] if self.object_thickness_mm is None else [f"{self.object_thickness_mm:g} mm on a rigid ground"]
        if self.nodule_radius_mm is not None:
            stuff.append(f"with a nodule of {self.nodule_radius_mm:g} mm radius, {self.nodule_depth_mm:g} mm deep")
        return f"soft {'block' if self.is_plate else label} ({', '.join(stuff)})"

    @property
    def hold(self) -> str:
        """The friction in words."""
        if self.friction == float("inf"):
            return "gripping"
        return f"friction coefficient {self.friction:g}" if self.friction else "frictionless"

    @property
    def words(self) -> str:
        """Object, friction and, if it is not axisymmetric, place of contact in words."""
        return ", ".join([self.label, self.hold, *([self.place] if self.off_axis else [])])

    @property
    def softness(self) -> dict[str, float]:
        """Keys of a soft object with their values; empty for a rigid one."""
        if self.object_modulus_MPa is None:
            return {}
        return {key: value for key in SOFTNESS if (value := getattr(self, key)) is not None}

    def sizes(self) -> dict[str, Any]:
        """Keys in `SIZES` of this object with their values; empty for a plate."""
        return {key: getattr(self, key) for key in SIZES[self.object]}
