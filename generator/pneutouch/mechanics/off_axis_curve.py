"""Records, in a prediction, of contact without axial symmetry and of an object that moves sideways after pressing."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class ShearCurve:
    """A shear at constant height (arrays of one length, mm, N, N mm, MPa; see `harmonic.friction_path.ShearPath`);
    ``travel`` and ``sideways`` are positive towards the offset."""

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
        """The curve with all forces and the pressure rise times factors."""
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
    """A loading curve from first contact to the end of its range at equal steps (arrays of one length, mm, N, MPa), by
    Hermite cubics through the solved states and their slopes."""

    indentation: Array
    force: Array
    rise: Array


@dataclass(frozen=True, slots=True)
class OffAxisCurve:
    """Additions to a loading curve for contact off the axis: sideways force and moment (N, N mm; see
    `harmonic.press.OffAxisState`), the order of the harmonics, and the share by which the last increase of the order
    changed the figures. ``to_end`` is the curve between its points, up to the end of its range."""

    order: int
    last_change: float
    sideways: Array
    moment: Array
    to_end: RangeCurve
    shear: ShearCurve | None = None

    def scaled(self, force: float, rise: float) -> OffAxisCurve:
        """The curve with all forces and the pressure rise times factors."""
        sheared = None if self.shear is None else self.shear.scaled(force, rise)
        to_end = replace(self.to_end, force=force * self.to_end.force, rise=rise * self.to_end.rise)
        sideways, moment = force * self.sideways, force * self.moment
        return replace(self, sideways=sideways, moment=moment, to_end=to_end, shear=sheared)
