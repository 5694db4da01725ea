"""Records in a prediction for contact without axial symmetry and for an object that moves sideways after pressing."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class ShearCurve:
    """Sideways motion of the object at constant height: `harmonic.friction_path.ShearPath` with its states as arrays of
    one length (mm, N, N mm, MPa); ``travel`` and ``sideways`` are positive towards the offset."""

    travel: Array
    force: Array
    sideways: Array
    moment: Array
    rise: Array
    sliding: Array
    stiffness: float | None
    peak: float | None
    slips_from: float | None
    ended: str | None

    def scaled(self, force: float, rise: float) -> ShearCurve:
        """The curve with forces, moment and stiffness times ``force``, and pressure rise times ``rise``."""
        return replace(
            self,
            force=force * self.force,
            sideways=force * self.sideways,
            moment=force * self.moment,
            rise=rise * self.rise,
            stiffness=None if self.stiffness is None else force * self.stiffness,
            peak=None if self.peak is None else force * self.peak,
        )


@dataclass(frozen=True, slots=True)
class RangeCurve:
    """A loading curve at equal steps from first contact to the end of its range (arrays of one length, mm, N, MPa), on
    Hermite cubics through the solved states and their slopes."""

    indentation: Array
    force: Array
    rise: Array


@dataclass(frozen=True, slots=True)
class OffAxisCurve:
    """Additions to a loading curve for contact off the axis: sideways force and moment at its points (N, N mm; see
    `harmonic.press.OffAxisState`), ``order`` of the harmonics, relative change ``last_change`` of the figures when it
    was last raised. ``to_end`` is the curve to the end of its range; ``shear`` is None without sideways motion."""

    order: int
    last_change: float
    sideways: Array
    moment: Array
    to_end: RangeCurve
    shear: ShearCurve | None = None

    def scaled(self, force: float, rise: float) -> OffAxisCurve:
        """The curve with forces and moments times ``force``, and pressure rises times ``rise``."""
        sheared = None if self.shear is None else self.shear.scaled(force, rise)
        to_end = replace(self.to_end, force=force * self.to_end.force, rise=rise * self.to_end.rise)
        sideways, moment = force * self.sideways, force * self.moment
        return replace(self, sideways=sideways, moment=moment, to_end=to_end, shear=sheared)
