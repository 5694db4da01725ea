"""Shapes of the dome; solid, print mesh, mould and finite elements of a membrane are derived from its shape."""

import dataclasses
from collections.abc import Mapping
from importlib import import_module
from typing import Any

import numpy as np

from pneutouch.errors import InputError, nearest
from pneutouch.shape.dome import DomeShape
from pneutouch.shape.hemisphere import Hemisphere

SHAPES: dict[str, str | type[DomeShape]] = {
    "hemisphere": Hemisphere,
    "cap": "round.Cap",
    "ellipsoid": "round.Ellipsoid",
    "thimble": "round.Thimble",
    "disc": "disc.Disc",
    "corrugated": "disc.CorrugatedDisc",
    "torus": "torus.Torus",
    "profile": "profile.Profile",
}
"""Shapes by their name in a design file: a class, or the file and class of this folder that are loaded on first use."""


class ShapeError(ValueError):
    """Error on sizes of a shape; ``keys`` are theirs in a design file."""

    def __init__(self, problem: str, *keys: str) -> None:
        super().__init__(problem)
        self.keys = keys


def shape_of(key: str, inner_radius: float, wall_thickness: float, sizes: Mapping[str, Any]) -> DomeShape:
    """The shape named ``key`` with its further sizes by field (mm); those left out are the usual ones.

    Raises ShapeError for a size that the shape does not have, or that makes it impossible.
    """
    kind = _kind(key, sizes)
    own = dataclasses.fields(kind)[2:]
    for size in sizes:
        if size not in own_sizes(kind):
            takes = " and ".join(f"membrane.{key_of(name)}" for name in own_sizes(kind)) or "no further size"
            raise ShapeError(f'the shape "{key}" has no {key_of(size)}; it takes {takes}', "shape", key_of(size))
    usual = {size: share * inner_radius for size, share in kind.usual.items()}
    known = {**usual, **{name: _fixed(name, size) for name, size in sizes.items()}}
    for field in own:
        if field.default is dataclasses.MISSING and field.name not in known:
            raise ShapeError(f'the shape "{key}" needs membrane.{key_of(field.name)}', key_of(field.name))
    shape = kind(inner_radius, wall_thickness, **known)
    fault = shape.wall_fault or shape.fault
    if fault is not None:
        size, why = fault
        stated = f" = {known[size]:g}" if isinstance(known.get(size), float) else ""
        raise ShapeError(f"{key_of(size)}{stated}: {why}", key_of(size))
    return shape


def own_sizes(shape: DomeShape | type[DomeShape]) -> list[str]:
    """Names of the sizes that a shape has besides radius and wall; those that most shapes have come last."""
    names = [field.name for field in dataclasses.fields(shape)[2:]]
    return sorted(names, key=("wall_stations", "root_fillet").__contains__)


def stated_sizes(shape: DomeShape) -> Mapping[str, Any]:
    """The sizes besides radius and wall that a shape states, by their key in a design file; points as lists."""
    sizes = {key_of(name): _plain(getattr(shape, name)) for name in own_sizes(shape)}
    return {key: size for key, size in sizes.items() if size}


def sizes_of(key: str) -> list[str]:
    """Keys in a design file of the sizes that the shape named ``key`` has besides radius and wall."""
    return [key_of(name) for name in own_sizes(_loaded(SHAPES[key]))]


def starting_sizes(key: str, inner_radius: float, digits: int = 2) -> Mapping[str, Any]:
    """Sizes of a new design in a shape, by key, mm: the usual ones, and those without which it would be no example.

    Raises InputError for an unknown shape.
    """
    if key not in SHAPES:
        raise InputError(f"unknown shape.{nearest(key, SHAPES)}", key="shape", value=key)
    kind = _loaded(SHAPES[key])
    shares = {**kind.usual, **kind.start}
    scaled = {key_of(size): (inner_radius * np.array(share)).round(digits).tolist() for size, share in shares.items()}
    return {name: size for name, size in scaled.items() if size != 0.0}


def key_of(size: str) -> str:
    """Key of a size in a design file, by its field."""
    return size if size in ("grooves", "wall_stations") else f"{size}_mm"


def _kind(key: str, sizes: Mapping[str, Any]) -> type[DomeShape]:
    """Class of a shape; a hemisphere has others with a fillet and with a wall that varies."""
    if key != Hemisphere.key or not sizes:
        return _loaded(SHAPES[key])
    return _loaded("round.FreeHemisphere")


def _loaded(shape: str | type[DomeShape]) -> type[DomeShape]:
    if not isinstance(shape, str):
        return shape
    module, _, name = shape.partition(".")
    kind: type[DomeShape] = getattr(import_module(f"{__name__}.{module}"), name)
    return kind


def _plain(size: Any) -> Any:
    return [list(point) for point in size] if isinstance(size, tuple) else size


def _fixed(name: str, size: Any) -> Any:
    """A size as a hashable value; a point of a profile without a radius is not rounded."""
    if not isinstance(size, list):
        return size
    return tuple((*point, 0.0)[:3] if name == "profile" else tuple(point) for point in size)


__all__ = [
    "SHAPES",
    "DomeShape",
    "Hemisphere",
    "ShapeError",
    "key_of",
    "own_sizes",
    "shape_of",
    "sizes_of",
    "starting_sizes",
    "stated_sizes",
]
