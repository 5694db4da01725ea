"""Uncertainty of a graded wall: the figures of the solid, the relative uncertainty of the even wall of its mean
modulus.

The atlas covers even walls alone. Differences of the solid would take two presses for each of six inputs, half a second
each and state, and on meshes coarse enough to be quick they are noise: at 12 cells the derivative of the sensitivity by
the wall of `designs/graded-dome.toml`, unpressurised, is +0.05, on the usual mesh -0.47. So the derivatives are those
of the even wall of the same mean modulus, -0.47 too.
"""

from pneutouch.mechanics import Sensor

GAP, STEEP_GAP = 0.2, 0.45
"""Distance of the derivatives d ln sensitivity / d ln modulus and wall of the even wall from those of the graded solid,
for the paper's sensor: with one end 6 times as stiff as the other, either one, and with the rim 13 times as stiff as
the pole (`tests/evaluation/test_graded_uncertainty.py`)."""

_NOTE = (
    "the wall is graded: the figures are the solid's, their relative uncertainty is that of an even wall of its mean "
    f"modulus, whose logarithmic derivatives by modulus and wall were found within {GAP:g} of a graded one's (one end "
    f"6 times as stiff as the other; {STEEP_GAP:g} for 13 times); all of the wall is taken stiffer, or all of it "
    "softer, than its mixing curve states"
)


_LAW_NOTE = (
    "the wall has a fitted law: the figures are the solid's, their relative uncertainty is that of the neo-Hookean "
    "wall with the modulus fitted over the same stretches (docs/reference/materials.md sets both side by side)"
)


def even_wall(sensor: Sensor) -> Sensor:
    """The sensor as the atlas can take it: its mean modulus everywhere, and the neo-Hookean wall for a fitted law."""
    even = sensor if sensor.wall.grade is None else sensor.replace(grade=None)
    return even.replace(law=None) if _fitted(even) else even


def notes_on(sensor: Sensor) -> tuple[str, ...]:
    """Notes on the uncertainty of this sensor."""
    graded = () if sensor.wall.grade is None else (_NOTE,)
    return (*graded, _LAW_NOTE) if _fitted(sensor) else graded


def _fitted(sensor: Sensor) -> bool:
    return sensor.wall.law is not None and sensor.wall.largest_stretch is not None
