"""Stretches that a wall reaches: the range over which a law has to be fitted.

Measured with the solid (neo-Hookean) on the shipped domes paper-dome, fingertip-dome and soft-pad, walls of 0.012 to
0.6 MPa, plate to three quarters of the inner radius, from no driving pressure to 0.8 of the limit point, and on every
shipped design at 0, at its rated pressure and at 0.9 of its limit point. The largest first invariant anywhere on the
faces half a wall away from the clamp is that of uniaxial tension by 1.92 at 0.17 MPa, 1.79 at 0.2 MPa and 2.09, 2.22,
2.33 and 2.39 at 0.08, 0.05, 0.025 and 0.012 MPa: in a softer wall the trapped gas hardly yields, and the wall bulges
instead. ``python -m benchmarks.materials --reach`` measures them again.
"""

SOFT = 0.1
"""MPa; below this the wall is stretched further."""

REACHED, REACHED_SOFT = 2.0, 2.5
"""Stretches of uniaxial tension, rounded up from the measured ones."""


def reached_stretch(shear_modulus: float) -> float:
    """Stretch of uniaxial tension that a law for a wall of a shear modulus (MPa) has to be fitted up to."""
    return REACHED_SOFT if shear_modulus < SOFT else REACHED
