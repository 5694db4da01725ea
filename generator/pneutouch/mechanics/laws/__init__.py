"""Hyperelastic laws: one file for each, and one line in `LAWS`."""

from collections.abc import Callable

from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.mooney_rivlin import mooney_rivlin
from pneutouch.mechanics.laws.neo_hookean import neo_hookean
from pneutouch.mechanics.laws.ogden import ogden
from pneutouch.mechanics.laws.yeoh import yeoh

LAWS: dict[str, Callable[..., Hyperelastic]] = {
    "neo-hookean": neo_hookean,
    "mooney-rivlin": mooney_rivlin,
    "yeoh": yeoh,
    "ogden": lambda *flat, poisson_ratio: ogden(tuple(zip(flat[::2], flat[1::2], strict=True)), poisson_ratio),
}
"""Functions by the law's name; called with constants (MPa; Ogden: mu, alpha, mu, alpha ...) and ``poisson_ratio``."""


def hyperelastic(name: str, constants: tuple[float, ...], poisson_ratio: float) -> Hyperelastic:
    """Law of a name of `LAWS` with its constants. Raises InputError for an unknown name or unsuitable constants."""
    if name not in LAWS:
        raise InputError(f"unknown.{nearest(name, LAWS)}", key="law", value=name)
    try:
        return LAWS[name](*constants, poisson_ratio=poisson_ratio)
    except (TypeError, ValueError):
        raise InputError(f"cannot take the constants {list(constants)}", key="law", value=name) from None


def stiffened(name: str, constants: tuple[float, ...], factor: float) -> tuple[str, tuple[float, ...]]:
    """Name and constants of a law with all stresses times ``factor``: it multiplies all but Ogden's exponents."""
    exponents = slice(1, None, 2) if name == "ogden" else slice(0)
    scaled = [factor * constant for constant in constants]
    scaled[exponents] = constants[exponents]
    return name, tuple(scaled)


__all__ = ["LAWS", "Hyperelastic", "hyperelastic", "mooney_rivlin", "neo_hookean", "ogden", "stiffened", "yeoh"]
