"""The table of the dome in a design file: its shape, sizes and resin."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import AfterValidator, Field, model_validator

from pneutouch.spec.contact import LARGEST, corners
from pneutouch.spec.fields import FieldsError, OneOf, SparseTable, number
from pneutouch.spec.grade import ResinOrMix

if TYPE_CHECKING:
    from pneutouch.shape.dome import DomeShape


def _shapes() -> list[str]:
    # The shapes load NumPy, which a list of names does not need.
    from pneutouch.shape import SHAPES

    return list(SHAPES)


SHAPE_SIZES = (
    "root_fillet_mm",
    "wall_stations",
    "rise_mm",
    "side_mm",
    "cavity_depth_mm",
    "boss_radius_mm",
    "boss_height_mm",
    "grooves",
    "profile_mm",
)
"""Keys of the sizes that not every shape has; left out, a size is the shape's usual one."""


class Membrane(SparseTable):
    """[membrane]: the soft dome (paper, section 2-B)."""

    left_out = ("shape", *SHAPE_SIZES)

    shape: Annotated[str, OneOf(_shapes)] = Field(default="hemisphere", description="Shape of the unloaded dome.")
    rise_mm: float | None = number(
        None,
        unit="mm",
        low=0.1,
        high=200,
        help="Height of the inner face over its rim (cap, ellipsoid), of a thimble's end, or of waves.",
    )
    side_mm: float | None = number(
        None, unit="mm", low=0.1, high=200, help="Height of the cylinder below the end of a thimble."
    )
    cavity_depth_mm: float | None = number(
        None,
        unit="mm",
        low=0.1,
        high=100,
        help="Depth of the cavity behind the rim (disc, corrugated, torus, profile).",
    )
    boss_radius_mm: float | None = number(
        None, unit="mm", low=0.1, high=100, help="Radius of the top of a boss on a disc; left out: no boss."
    )
    boss_height_mm: float | None = number(
        None, unit="mm", low=0.1, high=50, help="Height of a boss on a disc; its flank leans by 45 degrees."
    )
    grooves: int | None = number(None, unit="", low=1, high=3, help="Round grooves of a corrugated disc.")
    profile_mm: Annotated[list[list[float]], AfterValidator(corners)] | None = Field(
        default=None,
        json_schema_extra={"unit": "mm", "low": -LARGEST, "high": LARGEST},
        description="Inner face of a profile: points [r, z] or [r, z, radius] from rim to pole, rounded to the radius.",
    )
    inner_radius_mm: float = number(9.25, unit="mm", low=1, high=100, help="Inner radius R0 of the unloaded dome.")
    wall_thickness_mm: float = number(1.5, unit="mm", low=0.05, high=50, help="Wall thickness t0 of the unloaded dome.")
    wall_stations: list[list[float]] | None = Field(
        default=None,
        max_length=5,
        json_schema_extra={"unit": "", "low": 0, "high": 5},
        description="[share, factor of wall_thickness_mm, 0.2 to 5] along the arc from 0, the pole, to 1, the rim.",
    )
    root_fillet_mm: float | None = number(
        None,
        unit="mm",
        low=0.1,
        high=10,
        help="Radius of the fillet between the outside of the dome and its flange; left out: a sharp corner.",
    )
    material: ResinOrMix = Field(
        default="TangoPlus",
        json_schema_extra={"registry": "materials"},
        description="Resin of the dome, the offline stiffness; or a mix such as { from, to, fraction = 0.2 }.",
    )

    @model_validator(mode="after")
    def _wall_below_radius(self) -> "Membrane":
        if self.wall_thickness_mm >= self.inner_radius_mm:
            raise FieldsError(
                f"wall_thickness_mm = {self.wall_thickness_mm:g} must be less than "
                f"inner_radius_mm = {self.inner_radius_mm:g}",
                "wall_thickness_mm",
                "inner_radius_mm",
            )
        return self

    @property
    def sizes(self) -> Mapping[str, Any]:
        """The further sizes of the shape that are given, by the name of its field."""
        given = {key: getattr(self, key) for key in SHAPE_SIZES}
        return {key.removesuffix("_mm"): size for key, size in given.items() if size is not None}

    @model_validator(mode="after")
    def _possible_shape(self) -> "Membrane":
        if self.shape != "hemisphere" or self.sizes:
            self.dome  # noqa: B018 -- a shape that cannot be made raises FieldsError
        return self

    @property
    def dome(self) -> "DomeShape":
        """The unloaded dome. Raises FieldsError for sizes that the shape does not have or cannot have."""
        from pneutouch.shape import ShapeError, shape_of

        try:
            return shape_of(self.shape, self.inner_radius_mm, self.wall_thickness_mm, self.sizes)
        except ShapeError as error:
            raise FieldsError(str(error), *error.keys) from None
