"""Objects that touch a pad, by their parameters, and random ones within its range."""

import math

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.touch.cell import TILTS
from pneutouch.mechanics.touch.forward import ObjectKind, PadAnswer, PadModel

KINDS: tuple[ObjectKind, ...] = ("ball", "plate", "cylinder")

_BALL = 2.0
"""Radius of the ball that pads are measured with over the domes' inner radius: our choice."""


def answer_of(model: PadModel, kind: ObjectKind, parameters: Array) -> PadAnswer:
    """Answers of a pad to objects: of a ball its place x, y (mm), its curvature in 1/R0 and its depth (mm), (m, 4); of
    a cylinder its axis as of `PadModel.under_cylinders`, and then as of a ball, (m, 4); of a plate its slopes along x
    and y and its depth, (m, 3)."""
    if kind == "plate":
        return model.under_plates(parameters[:, :2], parameters[:, 2])
    low, high = (model.table.radius / size for size in model.radii)
    radius = model.table.radius / np.clip(parameters[:, 2], high, low)
    under = model.under_cylinders if kind == "cylinder" else model.under_balls
    return under(parameters[:, :2], radius, parameters[:, 3])


def usual_ball(model: PadModel) -> float:
    """Radius, mm, of the ball that a pad is measured with: whole halves of a millimetre, within the tables."""
    return max(0.5, round(2.0 * _BALL * model.table.radius) / 2.0, 0.5 * math.ceil(2.0 * model.radii[0]))


def random_objects(model: PadModel, kind: ObjectKind, count: int, random: np.random.Generator) -> Array:
    """Parameters (count, k) of random objects within the range of every cell and touching one, at any depth: balls and
    cylinders of any curvature of the table with their axis anywhere over the pad, plates of any slope of the table."""
    kept, size = [], 0
    low, high = model.radii
    reach = max(table.outer for table in model.tables) + np.abs(model.places).max(axis=0)
    while size < count:
        depth = random.uniform(0.0, model.deepest, count)
        if kind != "plate":
            bend = model.table.radius * random.uniform(1.0 / high, 1.0 / low, count)
            half, middle = reach, 0.0 * reach
            if kind == "cylinder":
                half, middle = np.array([0.5 * np.pi, np.hypot(*reach)]), np.array([0.5 * np.pi, 0.0])
            drawn = np.column_stack([middle + half * random.uniform(-1.0, 1.0, (count, 2)), bend, depth])
        else:
            steepest = TILTS[-1] / np.sqrt(1.0 - TILTS[-1] ** 2)
            turn, slope = random.uniform(0.0, 2.0 * np.pi, count), steepest * np.sqrt(random.uniform(0.0, 1.0, count))
            drawn = np.column_stack([slope * np.cos(turn), slope * np.sin(turn), depth])
        drawn = drawn[answer_of(model, kind, drawn).inside]
        kept.append(drawn)
        size += len(drawn)
    return np.concatenate(kept)[:count]
