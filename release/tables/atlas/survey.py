"""Solves the solid for one wall ratio: equilibria over cavity volume and plate height, gas left out.

A state is the least elastic energy at a given volume and plate height; its pressure and force are the slopes of that
energy, so that any gas can be put behind it afterwards.
"""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.recipe import AtlasRecipe
from pneutouch.mechanics.atlas.surveyed import Survey, stored_fields
from release.tables.atlas.sampler import AtlasSampler, Equilibrium, SampledPress, survey_depths, survey_volumes

_NEAR_ZERO = 0.3
"""Below this share of the limit pressure, a pressure that rises as the plate goes up belongs to a buckled wall."""


def survey(wall_ratio: float, recipe: AtlasRecipe) -> Survey:
    """Solve the solid for every reachable state of one wall ratio.

    Raises ComputationError where the dome itself fails.
    """
    sampler = AtlasSampler(wall_ratio, recipe)
    rows = [_down(sampler, sampler.touching(free)) for free in sampler.free]
    nodes = [node for row in rows for node in row.values()]
    above = rows[0]
    for nu in reversed(survey_volumes(recipe)[survey_volumes(recipe) < 0.0]):
        above = _squeezed(sampler, above, float(nu))
        nodes += above.values()
    presses = [
        sampler.pressed(share * sampler.limit.pressure, ambient)
        for share in recipe.first_pressures
        for ambient in recipe.ambients
    ]
    nodes += [node for press in presses for node in press.path]
    return _gathered(sampler, nodes, *_fold(sampler, presses))


def _fold(sampler: AtlasSampler, presses: list[SampledPress]) -> tuple[float, Array]:
    """Edge of the sheet of states: the depth below the unloaded apex at which a vented press buckles, and the least
    volume at depths beyond; (recipe.fold_depths,).

    The ends of the presses are points of that edge; where no press has ended, the lowest press is.
    """
    rest, recipe = sampler.rest.outer_apex, sampler.recipe
    grid: Array = recipe.fold_depths
    tracks = [np.array([[rest - node.height, node.state.volume] for node in press.path]).T for press in presses]
    ended = [track[:, -1] for track, press in zip(tracks, presses, strict=True) if press.ended]
    lowest = np.min([np.interp(grid, track[0], track[1], left=np.inf, right=np.inf) for track in tracks], axis=0)
    vented = tracks[0][0, -1] if presses[0].ended else np.inf
    if len(ended) > 1:
        depth, volume = np.array(sorted(map(tuple, ended)), float).T
        lowest = np.minimum(lowest, np.interp(grid, depth, volume, left=np.inf, right=np.inf))
    return float(min(vented, recipe.beyond)), np.where(np.isfinite(lowest), lowest, 0.0)


def _down(sampler: AtlasSampler, start: Equilibrium) -> dict[int, Equilibrium]:
    """The plate coming down at a fixed volume, as far as a gas can hold it."""
    row = {0: start}
    for k, w in enumerate(survey_depths(sampler.recipe)[1:], start=1):
        node = sampler.step(row[k - 1], start.state.volume, start.height - w)
        if node is None or not sampler.reachable(node):
            break
        row[k] = node
    return row


def _squeezed(sampler: AtlasSampler, above: dict[int, Equilibrium], nu: float) -> dict[int, Equilibrium]:
    """The row at a volume below the unloaded one, each state from the one above it, as long as a gas can be there.

    The free apex is continued along its tangent, so that w keeps its meaning. Only the unbroken deep end of the row
    counts: past a break lies another branch.
    """
    volume, rest = sampler.volume(nu), sampler.rest
    apex = rest.outer_apex + sampler.first_slope * (volume - rest.volume)
    lowest = rest.outer_apex - sampler.recipe.beyond
    row: dict[int, Equilibrium] = {}
    for k in sorted(above, reverse=True):
        height = apex - survey_depths(sampler.recipe)[k]
        if height < lowest:
            continue
        node = sampler.step(above[k], volume, height)
        if node is None or not sampler.reachable(node) or _turned(sampler, node, row.get(k + 1)):
            if row:
                break
            continue
        row[k] = node
    return row


def _turned(sampler: AtlasSampler, node: Equilibrium, deeper: Equilibrium | None) -> bool:
    if deeper is None:
        return False
    low, high = deeper.state.filling.pressure, node.state.filling.pressure
    return low < high and low < _NEAR_ZERO * sampler.limit.pressure


def _gathered(sampler: AtlasSampler, nodes: list[Equilibrium], fold_from: float, fold_volume: Array) -> Survey:
    solid, probe = sampler.solid, sampler.probe
    return Survey(
        solid.wall,
        sampler.limit.volume,
        sampler.limit.pressure,
        np.array([f.volume for f in sampler.free]),
        np.array([f.outer_apex for f in sampler.free]),
        np.array([n.state.volume for n in nodes]),
        np.array([n.height for n in nodes]),
        np.array([n.energy for n in nodes]),
        np.array([n.state.filling.pressure for n in nodes]),
        np.array([n.force for n in nodes]),
        np.array([n.stiffness for n in nodes]),
        np.array([stored_fields(probe, n.state) for n in nodes]).T,
        fold_from,
        fold_volume,
    )
