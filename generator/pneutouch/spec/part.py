"""Catalogue parts of the connector: tubes, ports, seats and mounts, each one TOML with its source. Lengths in mm."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from pneutouch.spec.fields import Table

Length = Annotated[float, Field(gt=0)]
Source = Annotated[str, Field(min_length=8)]


class Part(Table):
    """What every part has."""

    title: str
    code: str = Field(description="Short form for part numbers.")
    source: Source


class Tube(Part):
    """A tube as it is sold."""

    outer_diameter: Length
    inner_diameter: Length
    bend_radius: Length | None = Field(default=None, description="Least bend radius.")
    materials: str = Field(description="What it is made of.")


class Barb(Part):
    """A single hose barb for a soft tube."""

    family: Literal["barb"]
    tubes: list[str] = Field(min_length=1, description="Tubes it takes; the first is the usual one.")
    stem_diameter: Length
    barb_diameter: Length
    bore_diameter: Length
    barb_length: Length
    stem_length: Length


class Thread(Part):
    """A female thread, printed as its core hole and tapped, with a flat face for the fitting's gasket."""

    family: Literal["thread"]
    tubes: list[str] = Field(min_length=1)
    thread: str = Field(description="Such as M5 x 0.8.")
    core_diameter: Length = Field(description="Drill before tapping.")
    chamfer_diameter: Length = Field(description="Widest diameter of the 45 degree chamfer.")
    depth: Length = Field(description="Depth of the core hole from the face.")
    face_diameter: Length = Field(description="Boss that the gasket seals on.")
    boss_length: Length
    passage_diameter: Length = Field(description="Bore behind the thread.")
    fitting_engagement: Length = Field(description="Depth that the fitting fills.")
    fitting_bore_diameter: Length


class Luer(Part):
    """A female Luer lock: a 6 % cone with two lugs."""

    family: Literal["luer"]
    tubes: list[str] = Field(min_length=1)
    opening_diameter: Length = Field(description="Cone at its mouth.")
    taper: Length = Field(description="Diameter lost over length.")
    depth: Length = Field(description="Length of the cone.")
    body_diameter: Length = Field(description="Outside, under the lugs.")
    lug_diameter: Length = Field(description="Across the lugs.")
    lug_thickness: Length = Field(description="Along the axis, at the mouth.")
    lug_angle_deg: float = Field(gt=10, lt=170, description="Angle that each of the two lugs spans.")
    boss_length: Length
    passage_diameter: Length
    fitting_engagement: Length = Field(description="Depth that the male cone fills.")
    fitting_bore_diameter: Length


class PushIn(Part):
    """A plain bore that the tube is pushed into and glued, against a stop."""

    family: Literal["push-in"]
    tubes: list[str] = Field(min_length=1, max_length=1)
    depth: Length = Field(description="Depth that the tube enters.")
    wall: Length = Field(description="Rigid wall around the tube.")
    boss_length: Length


Port = Barb | Thread | Luer | PushIn


class Seat(Part):
    """What every seat has."""

    least_flange_mm: Length = Field(description="Smallest flange width and thickness.")
    flange_over_wall: Length = Field(description="Flange width and thickness over the wall thickness.")
    ring_wall_mm: Length = Field(description="Rigid wall around the groove.")
    channel_diameter_mm: Length = Field(description="Air channel through the body.")


class GluedFlange(Seat):
    """A flange glued into a groove that holds it on three faces up to the base plane."""

    family: Literal["glued-flange"]


class ClampedFlange(Seat):
    """A flange pressed down by a ring with screws, no glue."""

    family: Literal["clamped-flange"]
    screw: str
    screw_count: int = Field(ge=3, le=16)
    clearance_diameter: Length = Field(description="Holes of the ring.")
    core_diameter: Length = Field(description="Blind holes of the connector.")
    core_depth: Length
    head_diameter: Length
    ring_thickness: Length
    squeeze: float = Field(gt=0, lt=0.5, description="Share of the flange's thickness that the ring takes up.")


class OnePiece(Seat):
    """Membrane and rigid body grown in one print; an opening to clean through and a plug glued into it."""

    family: Literal["one-piece"]
    lip_wall_mm: Length = Field(description="Rigid wall inside the flange, around the opening.")
    shoulder_width: Length = Field(description="Width of the plug's shoulder, glued into the counterbore.")
    shoulder_thickness: Length


class CastRing(Seat):
    """A flange cast around the perforated web of a rigid ring, whose collar is glued into the connector's groove."""

    family: Literal["cast-ring"]
    collar_wall_mm: Length = Field(description="Rigid wall of the ring outside the flange.")
    lip_mm: float = Field(gt=1, description="Least silicone above, under and inside the web.")


AnySeat = GluedFlange | ClampedFlange | OnePiece | CastRing


class Mount(Part):
    """What every mount has. The port points away from the dome (rear) or sideways."""

    port_side: Literal["rear", "side"]
    plate_thickness: Length


class PlainPlate(Mount):
    """A flat plate without holes."""

    family: Literal["plain"]


class BoltCircle(Mount):
    """Mounting holes on a circle: through holes outside the seat, or blind holes under it."""

    family: Literal["through", "blind"]
    screw: str
    count: int = Field(ge=2, le=12)
    hole_diameter: Length
    head_diameter: Length
    hole_depth: Length | None = Field(default=None, description="Blind holes only.")


class RobotFlange(Mount):
    """An adaptor for a robot's tool flange: through holes on its pitch circle, a centring boss, a dowel hole."""

    family: Literal["robot-flange"]
    screw: str
    count: int = Field(ge=3, le=12)
    hole_diameter: Length
    head_diameter: Length
    pitch_diameter: Length
    plate_diameter: Length
    boss_diameter: Length = Field(description="Centring boss, nominal; the fit's clearance comes off.")
    boss_height: Length
    pin_diameter: Length = Field(description="Dowel hole on the pitch circle, nominal.")


class Sleeve(Mount):
    """A sleeve that goes over a finger and is held by set screws."""

    family: Literal["sleeve"]
    screw: str
    finger_diameter: Length = Field(description="Where a design gives none.")
    sleeve_length: Length
    sleeve_wall: Length
    set_screw_count: int = Field(ge=2, le=3)
    set_screw_core_diameter: Length

    def for_finger(self, diameter: float) -> Sleeve:
        """The same sleeve for a finger of another diameter in mm, its title and code with that number."""
        old, new = f"{self.finger_diameter:g}", f"{diameter:g}"
        title, code = self.title.replace(f"{old} mm", f"{new} mm"), self.code.replace(old, new)
        return self.model_copy(update={"finger_diameter": diameter, "title": title, "code": code})


AnyMount = PlainPlate | BoltCircle | RobotFlange | Sleeve

PORTS: dict[str, type[Part]] = {"barb": Barb, "thread": Thread, "luer": Luer, "push-in": PushIn}
SEATS: dict[str, type[Part]] = {
    "glued-flange": GluedFlange,
    "clamped-flange": ClampedFlange,
    "one-piece": OnePiece,
    "cast-ring": CastRing,
}
MOUNTS: dict[str, type[Part]] = {
    "plain": PlainPlate,
    "through": BoltCircle,
    "blind": BoltCircle,
    "robot-flange": RobotFlange,
    "sleeve": Sleeve,
}
"""Models by family: a file states its family, and with it its keys."""
