"""Sensors that the atlas covers, and the sensors that take the place of others: under a plate, and in a fit."""

from pneutouch.mechanics.atlas.figures import wider_box
from pneutouch.mechanics.atlas.table import Atlas, shipped
from pneutouch.mechanics.sensor import RigidBase, Sensor, WallMaterial
from pneutouch.shape.hemisphere import no_hemisphere

_BULGE, _RING_FROM, _RING_ROUND = 0.0107, 0.6, 0.04
"""For `meets_ring`, in R0: outward bulge of the wall next to its base times the wall ratio, depth at which it begins,
and distance inside its edge at which the ring of the solid begins."""


def outside_atlas(sensor: Sensor, atlas: Atlas | None = None) -> str | None:
    """Reason why the atlas (None: the shipped one) does not cover a sensor; None if it does. Limits: `AtlasRecipe`.

    A ring that clamps the flange does not exclude a sensor: the atlas neglects the ring (`meets_ring`).
    """
    recipe = (atlas or shipped()).recipe
    dome, wall = sensor.dome, sensor.wall
    ratio, depth = dome.wall_thickness / dome.inner_radius, sensor.protocol.depth / dome.inner_radius
    gas, nu = sensor.gas.ambient_pressure / wall.shear_modulus, recipe.poisson_ratio
    inside = recipe.thinnest * (1 - 1e-9) <= ratio <= recipe.thickest * (1 + 1e-9)
    reasons = [
        (sensor.protocol.other_contact is not None, str(sensor.protocol.other_contact)),
        (wall.grade is not None, "the wall is graded along its arc"),
        (wall.law is not None, "the resin has a law of its own, not the neo-Hookean one"),
        (wall.poisson_ratio != nu, f"Poisson ratio {wall.poisson_ratio:g}, not {nu:g}"),
        (no_hemisphere(dome.shape) is not None, str(no_hemisphere(dome.shape))),
        (dome.flange is not None, "the flange is held as printed, not the base plane"),
        (dome.base is None, "the wall passes through its base plane"),
        (_on_ring(sensor), "the plate comes down on the ring around the flange"),
        (not inside, f"wall {ratio:.3g} R0, not {recipe.thinnest:g} to {recipe.thickest:g}"),
        (depth > recipe.deepest * (1 + 1e-9), f"depth {depth:.3g} R0, more than {recipe.deepest:g}"),
        (
            gas > recipe.stiffest,
            f"the wall is too soft: the ambient pressure is {gas:.3g} times its modulus, more than {recipe.stiffest:g}",
        ),
    ]
    return next((why for applies, why in reasons if applies), None)


def resin_outside_atlas(wall: WallMaterial, ambient_pressure: float, atlas: Atlas | None = None) -> str | None:
    """Reason why the atlas (None: the shipped one) covers no dome of a resin; None if some. Pressure in MPa."""
    recipe = (atlas or shipped()).recipe
    # A fitted law has a neo-Hookean modulus next to it, which finds designs; the solid then confirms them by the law.
    own_law = wall.law is not None and wall.largest_stretch is None
    if own_law or wall.poisson_ratio != recipe.poisson_ratio:
        return "the atlas covers neither its law nor its Poisson ratio"
    too_soft = ambient_pressure > recipe.stiffest * wall.shear_modulus
    return "it is too soft for the atlas in so high an ambient pressure" if too_soft else None


def meets_ring(sensor: Sensor) -> bool:
    """True if the wall can reach the ring that clamps its flange, which is part of the solid but not of the atlas.

    The wall bulges farthest without driving pressure: next to its base by at most 0.0107 R0^2/t0 at the atlas's
    greatest depth, not at all at 0.6 R0 (solid, walls from 0.065 to 0.33 R0, ambient pressure 0.3 mu). The ring of the
    solid is rounded over half a cell, 0.04 R0, before its edge.
    """
    dome, base = sensor.dome, sensor.dome.base
    if base is None or base.ring_height == 0.0:
        return False
    wall, depth = dome.wall_thickness / dome.inner_radius, sensor.protocol.depth / dome.inner_radius
    deep = max(0.0, depth - _RING_FROM) / (shipped().recipe.deepest - _RING_FROM)
    gap = base.ring / dome.inner_radius - 1.0 - wall
    return deep > 0.0 and gap < _BULGE * deep / wall + _RING_ROUND


def _on_ring(sensor: Sensor) -> bool:
    """True if the plate would reach the ring around the flange within the depth, were the dome not inflated."""
    dome, base = sensor.dome, sensor.dome.base
    if base is None or sensor.protocol.plate_radius <= base.ring:
        return False
    return dome.shape.outer_height - sensor.protocol.depth < base.ring_height


def under_plate(sensor: Sensor) -> Sensor:
    """The sensor pressed by a frictionless plate, of at least twice R0 in radius if it replaces another object.

    An offset, tilt or shear and an object that lies across the dome are kept: corrections are axisymmetric.
    """
    protocol = sensor.protocol
    if protocol.other_contact is None or (protocol.body is not None and protocol.body.lying):
        return sensor
    plate = protocol.plate_radius if protocol.body is None else max(protocol.plate_radius, 2 * sensor.dome.inner_radius)
    return sensor.replace(body=None, soft=None, plate_rim=None, friction=0.0, plate_radius=plate)


def stand_in(sensor: Sensor) -> Sensor:
    """The sensor to which a fit applies its correction: pressed by a plate without friction, with a homogeneous wall,
    neo-Hookean in place of a fitted law, and a base without the ring that clamps the flange."""
    if sensor.dome.base is not None:
        sensor = sensor.replace(base=RigidBase())
    return under_plate(sensor.even)


_DEPTH = 0.75
"""Greatest depth in R0 that a fit uses, that of the sensitivity test (paper, section 3-B)."""


def outside_fit(sensor: Sensor) -> str | None:
    """Reason why a sensor cannot be fitted to measured runs; None if it can. A fit uses the atlas to `_DEPTH`, times
    the solid's ratio to the `stand_in` for a law, grade, softness or contact that the atlas does not cover; for another
    shape than the hemisphere the solid alone."""
    if sensor.protocol.soft is not None:
        return f"{sensor.protocol.other_contact}, and a fit presses rigid ones"
    if other_shape(sensor):
        held = None if sensor.dome.flange is None else "the flange is held as printed, not the base plane"
        return sensor.protocol.off_axis or held
    return outside_atlas(stand_in(_shallow(sensor)), wider_box())


def other_shape(sensor: Sensor) -> bool:
    """True if no hemisphere can stand in for the dome in a fit."""
    return no_hemisphere(sensor.dome.shape.plain) is not None


def is_corrected(sensor: Sensor) -> bool:
    """True if a fit takes the solid, in the atlas's place or for its ratio to the `stand_in`: the atlas does not cover
    the sensor, or leaves out the ring that its wall meets."""
    return outside_atlas(_shallow(sensor)) is not None or meets_ring(_shallow(sensor))


def _shallow(sensor: Sensor) -> Sensor:
    return sensor.replace(depth=min(sensor.protocol.depth, _DEPTH * sensor.dome.inner_radius))
