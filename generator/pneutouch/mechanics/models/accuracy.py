"""Numerical errors that the models state, as measured (docs/background/accuracy.md)."""

HARMONICS_SETTLED = 0.01
"""The last raise of the harmonics changes sensitivity, force and pressure by less than this share."""

SENSITIVITY_DISCRETISATION = 0.011
LIMIT_DISCRETISATION = 0.002
"""Greatest relative errors of the solid at its default resolution against a refined mesh."""

OBJECT_DISCRETISATION = 0.02
"""Greatest relative error of the solid's sensitivity under an object that is no plate, at the resolution it takes,
against a refined mesh (docs/background/contact.md): 0.002 where the range ends at the depth, more where an
event ends it."""

TABULATION = 0.0075
"""Greatest relative error of the atlas's sensitivity against the solid where `auto` takes it: away from buckling,
tearing and ranges below 0.2 R0 (docs/background/atlas.md); held by `make check-slow`."""

_MEMBRANE = 17.0
"""Greatest relative error of the membrane's sensitivity against the solid: no bending stiffness."""

NUMERICAL = {
    "membrane": _MEMBRANE,
    "atlas": SENSITIVITY_DISCRETISATION + TABULATION,
    "solid": SENSITIVITY_DISCRETISATION,
    "harmonic": OBJECT_DISCRETISATION,
}
"""Relative error in sensitivity of each model as a numerical answer: its distance from the exact solution of its
equations, or for the membrane from the solid's. Effects that the equations leave out come on top, for every model."""
