"""Blends of a body at every voxel: one base resin, or a share of a second one."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.errors import InputError, shown
from pneutouch.meridian.arc import arc_share
from pneutouch.spec.material import Material
from pneutouch.spec.mixing import MixingCurve

Share = Callable[[Array, Array], Array]
"""Volume fraction of the second resin at points (r, z), arrays of one shape, mm in the design frame."""


@dataclass(frozen=True)
class ResinBlend:
    """The resins of a body, soft one first; ``share`` is of the second, None if there is one alone.

    ``most`` is its greatest value. ``assumed`` says what the share rests on where it was neither measured nor
    requested.
    """

    resins: tuple[str, ...]
    share: Share | None = None
    most: float = 0.0
    assumed: str = ""


def blend(material: Material, name: str, library: Library, where: str) -> ResinBlend:
    """The blend of a material; ``name`` is its own in the catalogue, ``where`` the file and key that request it.

    A digital material of the catalogue has no published mix: its fraction is taken from the mixing curve that it is a
    point of. Raises InputError if there is none, and for more than two resins.
    """
    resins = tuple(material.base_resins)
    if len(resins) == 1:
        return ResinBlend(resins)
    if len(resins) > 2:
        raise InputError(f"{where} = {shown(name)}: mixed from {len(resins)} resins; voxels are mixed from two at most")
    if material.along is not None:
        along = material.along
        stations, fractions = np.array(along.arc), np.array(along.stiff_fraction)
        return ResinBlend(resins, lambda r, z: np.interp(arc_share(r, z), stations, fractions), float(fractions.max()))
    if material.mix is not None:
        stiff = material.mix.fractions[resins[1]]
        return ResinBlend(resins, _even(stiff), stiff)
    fraction, why = _assumed(name, resins, library, where)
    return ResinBlend(resins, _even(fraction), fraction, f"{name} is {fraction:.1%} {resins[1]}: {why}")


def _even(fraction: float) -> Share:
    return lambda r, z: np.full(np.shape(r), fraction)


def _assumed(name: str, resins: tuple[str, ...], library: Library, where: str) -> tuple[float, str]:
    """Place of a digital material on a mixing curve, and the reason for it."""
    curve_name = f"{resins[0]}+{resins[1]}"
    if curve_name in library.paths("mixing"):
        curve: MixingCurve = library.load("mixing", curve_name)
        for point in curve.points:
            if point.material == name:
                return point.fraction, point.source
    raise InputError(
        f"{where} = {shown(name)}: no vendor publishes how much {resins[1]} is in it, and "
        f"printprofiles/mixing/{curve_name}.toml has no point for it; give "
        f"{{ from = {shown(resins[0])}, to = {shown(resins[1])}, fraction = .. }} instead"
    )
