"""Catalogue parts of the connector: tubes, ports, seats and mounts, each one TOML with its source. Lengths in mm."""

from typing import Annotated, Literal

from pydantic import Field

from pneutouch.spec.fields import SparseTable, Table, number

Length = Annotated[float, Field(gt=0, json_schema_extra={"unit": "mm"})]
Source = Annotated[str, Field(min_length=8)]


class Part(SparseTable):
    """Fields that every part has."""

    title: str = Field(description="Name of the part.")
    code: str = Field(description="Short form for part numbers.")
    source: Source = Field(description="Table, page or address; how far it was verified.")


class Insert(Table):
    """A threaded insert of brass that is melted into the hole of a thermoplastic body; its hole is the part's."""

    title: str = Field(description="Name in a list to buy.")
    iron: str = Field(description="Temperature of the soldering iron that sets it, with its source.")


class Tube(Part):
    """A tube as it is sold."""

    outer_diameter: Length = Field(description="Outside.")
    inner_diameter: Length = Field(description="Inside.")
    bend_radius: Length | None = Field(default=None, description="Least bend radius.")
    materials: str = Field(description="Material that it is made of.")


class Barb(Part):
    """A single hose barb for a soft tube."""

    family: Literal["barb"] = Field(description="A hose barb.")
    tubes: list[str] = Field(min_length=1, description="Tubes it takes; the first is the usual one.")
    stem_diameter: Length = Field(description="Stem behind the barb.")
    barb_diameter: Length = Field(description="Widest diameter of the barb.")
    bore_diameter: Length = Field(description="Bore through it.")
    barb_length: Length = Field(description="Length of the cone.")
    stem_length: Length = Field(description="Length of the stem.")


class Thread(Part):
    """A female thread, printed as its core hole and tapped, with a flat face for the fitting's gasket."""

    family: Literal["thread"] = Field(description="A female thread.")
    tubes: list[str] = Field(min_length=1, description="Tubes that its fittings take; the first is the usual one.")
    thread: str = Field(description="Such as M5 x 0.8.")
    core_diameter: Length = Field(description="Drill before tapping.")
    chamfer_diameter: Length = Field(description="Widest diameter of the 45 degree chamfer.")
    depth: Length = Field(description="Depth of the core hole from the face.")
    face_diameter: Length = Field(description="Boss that the gasket seals on.")
    boss_length: Length = Field(description="Length of the boss beyond the body.")
    passage_diameter: Length = Field(description="Bore behind the thread.")
    fitting_engagement: Length = Field(description="Depth that the fitting fills.")
    fitting_bore_diameter: Length = Field(description="Bore of the fitting.")


class Luer(Part):
    """A female Luer lock: a 6 % cone with two lugs."""

    family: Literal["luer"] = Field(description="A female Luer lock.")
    tubes: list[str] = Field(min_length=1, description="Tubes that its fittings take; the first is the usual one.")
    opening_diameter: Length = Field(description="Cone at its mouth.")
    taper: Length = Field(description="Diameter lost over length.")
    depth: Length = Field(description="Length of the cone.")
    body_diameter: Length = Field(description="Outside, under the lugs.")
    lug_diameter: Length = Field(description="Across the lugs.")
    lug_thickness: Length = Field(description="Along the axis, at the mouth.")
    lug_angle_deg: float = Field(gt=10, lt=170, description="Angle that each of the two lugs spans.")
    boss_length: Length = Field(description="Length of the boss beyond the body.")
    passage_diameter: Length = Field(description="Bore behind the cone.")
    fitting_engagement: Length = Field(description="Depth that the male cone fills.")
    fitting_bore_diameter: Length = Field(description="Bore of the fitting.")


class PushIn(Part):
    """A plain bore that the tube is pushed into and glued, against a stop."""

    family: Literal["push-in"] = Field(description="A bore that the tube is glued into.")
    tubes: list[str] = Field(min_length=1, max_length=1, description="The tube that it takes.")
    depth: Length = Field(description="Depth that the tube enters.")
    wall: Length = Field(description="Rigid wall around the tube.")
    boss_length: Length = Field(description="Length of the boss beyond the body.")


class ORingStub(Part):
    """A stub with an O-ring in a groove around it, which goes into a bore and seals against its wall."""

    family: Literal["o-ring"] = Field(description="A stub with an O-ring, for a bore.")
    tubes: list[str] = Field(min_length=1, description="Tubes behind the bore; the first is the usual one.")
    ring: str = Field(description="O-ring, such as ISO 3601-1, size code 010.")
    ring_diameter: Length = Field(description="O-ring, inside.")
    section: Length = Field(description="O-ring, thickness.")
    section_tolerance: Length = Field(description="Deviation of the O-ring's thickness to either side.")
    bore: Length = Field(description="Bore that the stub goes into.")
    bore_tolerance: Length = Field(description="By how much that bore may be wider.")
    groove_diameter: Length = Field(description="Floor of the groove.")
    groove_width: Length = Field(description="Width of the groove.")
    stub_diameter: Length = Field(description="Stub beside the groove.")
    tip_length: Length = Field(description="Length of the stub in front of the groove.")
    stub_length: Length = Field(description="Length of the stub.")
    passage_diameter: Length = Field(description="Bore through the stub.")


Port = Barb | Thread | Luer | PushIn | ORingStub


class Seat(Part):
    """Fields that every seat has."""

    least_flange_mm: Length = Field(description="Smallest flange width and thickness.")
    flange_over_wall: Length = Field(description="Flange width and thickness over the wall thickness.")
    ring_wall_mm: Length = Field(description="Rigid wall around the groove.")
    channel_diameter_mm: Length = Field(description="Air channel through the body.")


class GluedFlange(Seat):
    """A flange glued into a groove that holds it on three faces up to the base plane."""

    family: Literal["glued-flange"] = Field(description="A flange glued into a groove.")


class ClampedFlange(Seat):
    """A flange pressed down by a ring with screws, no glue."""

    left_out = ("insert", "gasket", "gasket_thickness", "gasket_squeeze")
    family: Literal["clamped-flange"] = Field(description="A flange pressed down by a ring.")
    screw: str = Field(description="Screw of the ring, such as M2.")
    screw_count: int = Field(ge=3, le=16, description="Number of screws.")
    clearance_diameter: Length = Field(description="Holes of the ring.")
    core_diameter: Length = Field(description="Blind holes of the connector.")
    core_depth: Length = Field(description="Depth of the blind holes.")
    head_diameter: Length = Field(description="Heads of the screws.")
    ring_thickness: Length = Field(description="Thickness of the ring.")
    squeeze: float = Field(gt=0, lt=0.5, description="Share of the flange's thickness that the ring takes up.")
    insert: Insert | None = Field(default=None, description="Left out: the blind holes are tapped.")
    gasket: str = Field(default="", description="Sheet of a gasket under the flange; left out: there is none.")
    gasket_thickness: float = Field(default=0.0, ge=0, description="Thickness of that sheet.")
    gasket_squeeze: float = Field(default=0.0, ge=0, lt=0.5, description="Share of it that the screws take up.")


class OnePiece(Seat):
    """Membrane and rigid body grown in one print; an opening to clean through and a plug glued into it."""

    family: Literal["one-piece"] = Field(description="Membrane and rigid body in one print.")
    lip_wall_mm: Length = Field(description="Rigid wall inside the flange, around the opening.")
    shoulder_width: Length = Field(description="Width of the plug's shoulder, glued into the counterbore.")
    shoulder_thickness: Length = Field(description="Thickness of the plug's shoulder.")


class CastRing(Seat):
    """A flange cast around the perforated web of a rigid ring, whose collar is glued into the connector's groove."""

    family: Literal["cast-ring"] = Field(description="A flange cast around a rigid ring.")
    collar_wall_mm: Length = Field(description="Rigid wall of the ring outside the flange.")
    lip_mm: float = Field(gt=1, description="Least silicone above, under and inside the web.")


AnySeat = GluedFlange | ClampedFlange | OnePiece | CastRing


class Mount(Part):
    """Fields that every mount has. The port points away from the dome (rear) or sideways."""

    port_side: Literal["rear", "side"] = Field(
        description="Where the port points: away from the dome (rear) or sideways (side)."
    )
    plate_thickness: Length = Field(description="Thickness of the plate.")


class PlainPlate(Mount):
    """A flat plate without holes."""

    family: Literal["plain"] = Field(description="A flat plate without holes.")


class BoltCircle(Mount):
    """Mounting holes on a circle, under the seat or outside it."""

    left_out = ("insert",)
    family: Literal["through", "blind", "edge"] = Field(
        description="Holes on a circle: through or blind (edge) outside the seat, or blind under it."
    )
    screw: str = Field(description="Screw, such as M3.")
    count: int = Field(ge=2, le=12, description="Number of holes.")
    hole_diameter: Length = Field(description="Diameter of the holes.")
    head_diameter: Length = Field(description="Heads of the screws.")
    hole_depth: Length | None = Field(default=None, description="Blind holes only.")
    insert: Insert | None = Field(default=None, description="Left out: the blind holes are tapped.")


class RobotFlange(Mount):
    """An adaptor for a robot's tool flange: through holes on its pitch circle, a centring boss, a dowel hole."""

    family: Literal["robot-flange"] = Field(description="An adaptor for a robot's tool flange.")
    screw: str = Field(description="Screw, such as M6.")
    count: int = Field(ge=3, le=12, description="Number of holes.")
    hole_diameter: Length = Field(description="Diameter of the holes.")
    head_diameter: Length = Field(description="Heads of the screws.")
    pitch_diameter: Length = Field(description="Circle of the holes.")
    plate_diameter: Length = Field(description="Outside of the plate.")
    boss_diameter: Length = Field(description="Centring boss, nominal; the fit's clearance comes off.")
    boss_height: Length = Field(description="Height of the centring boss.")
    pin_diameter: Length = Field(description="Dowel hole on the pitch circle, nominal.")


class Sleeve(Mount):
    """A sleeve that goes over a finger and is held by set screws."""

    family: Literal["sleeve"] = Field(description="A sleeve over a finger.")
    screw: str = Field(description="Set screw, such as M3.")
    finger_diameter: Length = Field(description="Where a design gives none.")
    sleeve_length: Length = Field(description="Length of the sleeve.")
    sleeve_wall: Length = Field(description="Wall of the sleeve.")
    set_screw_count: int = Field(ge=2, le=3, description="Number of set screws.")
    set_screw_core_diameter: Length = Field(description="Holes of the set screws, to be tapped.")

    def for_finger(self, diameter: float) -> "Sleeve":
        """The same sleeve for a finger of another diameter in mm, its title and code with that number."""
        old, new = f"{self.finger_diameter:g}", f"{diameter:g}"
        title, code = self.title.replace(f"{old} mm", f"{new} mm"), self.code.replace(old, new)
        return self.model_copy(update={"finger_diameter": diameter, "title": title, "code": code})


AnyMount = PlainPlate | BoltCircle | RobotFlange | Sleeve


class PerforatedRing(Table):
    """[cast_ring]: the web of the ring, which the silicone encloses, and its holes.

    Defaults are this project's own choice and untested: walls and holes are what a filament printer of 0.4 mm makes.
    """

    hole_count: int | None = number(
        None,
        unit="",
        low=3,
        high=400,
        help="Holes around the ring that silicone goes through; left out: as many as leave between two of them what "
        "they are wide.",
    )
    hole_diameter_mm: float = number(2.0, unit="mm", low=0.5, high=10, help="Diameter of these holes.")
    thickness_mm: float = number(1.6, unit="mm", low=0.4, high=10, help="Thickness of the ring within the silicone.")
    width_mm: float = number(4.0, unit="mm", low=1, high=30, help="Width of the ring within the silicone.")
