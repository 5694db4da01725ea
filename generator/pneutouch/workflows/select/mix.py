"""Two base resins to mix: resolved, checked against the printer, and offered to the search as resins."""

from dataclasses import dataclass

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import ResolvedMixingCurve, mixed_material, mixing
from pneutouch.errors import InputError, shown
from pneutouch.mechanics.atlas_states import resin_outside_atlas
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.selection.mixes import levels
from pneutouch.selection.problem import CandidateResin
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

USUAL = "TangoPlus+VeroClear"
"""The pair a grade is made of where none is named: the paper's resins."""


@dataclass(frozen=True)
class ResinPair:
    """A soft and a stiff resin with their mixing curve. ``where`` names the file in messages."""

    soft: str
    stiff: str
    law: ResolvedMixingCurve
    library: Library
    where: str

    @property
    def name(self) -> str:
        """``SOFT+STIFF``, as a target names it."""
        return f"{self.soft}+{self.stiff}"

    def grade(self, *fractions: float) -> Grade:
        """A constant mix of one fraction, or a grade of fractions at even knots from the pole to the rim."""
        value = fractions[0] if len(fractions) == 1 else list(fractions)
        return Grade.model_validate({"from": self.soft, "to": self.stiff, "fraction": value})

    def material(self, grade: Grade) -> Material:
        """The material of a grade."""
        return mixed_material(grade, self.library, file=self.where)

    def resin(self, fraction: float) -> CandidateResin:
        """A constant mix as the search takes a resin."""
        grade = self.grade(fraction)
        material = self.material(grade)
        sensor = material_sensor(material)
        return CandidateResin(
            grade.label, material, sensor.wall.shear_modulus, sensor.wall.break_stretch or np.inf, grade
        )


def pair_of(name: str, printer: Printer, library: Library, where: str, named: bool = True) -> ResinPair:
    """The pair of ``SOFT+STIFF``. Raises InputError if a name is unknown or the printer does not hold both.

    ``named`` is whether the user named the pair.
    """
    soft, stiff = (part.strip() for part in name.split("+"))
    pair = ResinPair(soft, stiff, mixing(soft, stiff, library, file=where, key="given.mix"), library, where)
    if printer.mode_for(pair.material(pair.grade(0.5 * pair.law.wall_top))) is None:
        remedy = "name a pair that it holds with `mix`, or another printer with `profile`"
        raise InputError(
            f"given.mix = {shown(name)}{'' if named else ' (none was named)'}: the {printer.title} cannot mix "
            f"{soft} with {stiff}; it runs {', '.join(printer.resins)}, {printer.resins_at_once} at once; "
            f"{remedy}",
            file=where,
        )
    return pair


def mix_resins(pair: ResinPair, ambient_pressure: float) -> tuple[tuple[CandidateResin, ...], dict[str, str]]:
    """Mixes of a pair that the atlas covers, and why the others are left out."""
    resins, out = [], {}
    for fraction in levels(pair.law):
        resin = pair.resin(round(float(fraction), 4))
        why = resin_outside_atlas(material_sensor(resin.material).wall, ambient_pressure)
        if why is None:
            resins.append(resin)
        else:
            out[resin.name] = why
    return tuple(resins), out
