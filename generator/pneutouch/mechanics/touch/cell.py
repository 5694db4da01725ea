"""Answers of one cell of a pad to balls and cylinders beside its axis and to leaning plates, for its dome and gas.

The table of contact anywhere gives forces over readings of the central plate; cells under one rigid object are
coupled by its height, so that here forces and pressure are functions of the travel. ``harmonic`` makes every press.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.errors import ComputationError
from pneutouch.mechanics.anywhere.table import NodeAxis
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.harmonic.press import OffAxisState
from pneutouch.mechanics.models.harmonic import placed_press
from pneutouch.mechanics.models.solid import KINDS, curve_between, reported_events, solid_probe, solid_states
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.indenter import RigidObject, ball, cylinder
from pneutouch.mechanics.solid.inflate import FreeState, state_at
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.dome import DomeShape

RADII = (1.0, 2.0, 5.0, 20.0)
"""Radii of the tabulated balls and cylinders over the inner radius of the dome."""
SHARES = (0.0, 0.3, 0.55, 0.8, 1.0)
"""Offsets of their axes as shares of the greatest at which it still touches the dome, its lowest point at the depth."""
TILTS = (0.0, 0.18, 0.35)
"""Sines of the angles by which a plate leans."""
_ORDER, _CELLS, _STEPS = 6, 12, 10
"""Harmonics, cells along the arc, and steps of each press."""
_POINTS = 33
"""Equal steps of travel at which the curves are kept; between them they are linear."""
_FEWEST = 4
"""Least number of solved states of a press from which a curve is taken."""
_LEAST, _LOWEST = 0.35, 0.95
"""Least travel of a press over the greatest, and the greatest over the height of the object at first contact."""
TABLE_ERROR = 0.05
"""Greatest error of force and pressure rise, of their greatest under the object and at least of a tenth of that under a
plate, in presses that were not used to make a table (tests/mechanics/touch)."""


class CellAnswer(NamedTuple):
    """A cell under an object, arrays of one shape: force upwards on the object and sideways, positive towards its axis
    or its rising side, N; moment about the axis across, N mm; pressure rise, MPa; True within the range."""

    force: Array
    sideways: Array
    moment: Array
    rise: Array
    inside: Flags


_NUMBERS = ("radius", "outer", "depth", "apex", "cavity", "driving_pressure")
_KINDS, _AXES, _PARTS = ("balls", "plates", "cylinders"), ("rows", "columns"), ("values", "first", "reach")
"""Names of the numbers and of the arrays of a table."""


@dataclass(frozen=True)
class _Nodes:
    """Curves of presses at nodes: ``values`` (a, b, `_POINTS`, 4) at equal steps to ``depth``, sideways force and
    moment over the lean; height (a, b) of the object's lowest point, or a plate's middle, at first contact; travel
    (a, b) at which the range ends."""

    rows: NodeAxis
    columns: NodeAxis
    values: Array
    first: Array
    reach: Array


@dataclass(frozen=True)
class CellTable:
    """Answers of one cell at one driving pressure, mm, N and MPa. ``radius`` is the inner radius of the dome, ``outer``
    that of a sphere for its outer face (`outer_sphere`), ``depth`` the greatest travel, ``apex`` the height of the
    inflated dome outside, ``cavity`` its volume before contact, mm3."""

    radius: float
    outer: float
    depth: float
    apex: float
    cavity: float
    driving_pressure: float
    balls: _Nodes
    plates: _Nodes
    cylinders: _Nodes

    def arrays(self) -> dict[str, Array]:
        """The table as arrays by name."""
        numbers = [getattr(self, name) for name in _NUMBERS]
        parts = [(kind, part, getattr(getattr(self, kind), part)) for kind in _KINDS for part in _PARTS]
        nodes = {f"{kind}_{axis}": getattr(getattr(self, kind), axis).nodes for kind in _KINDS for axis in _AXES}
        return {"numbers": np.array(numbers), **nodes, **{f"{kind}_{part}": values for kind, part, values in parts}}

    @staticmethod
    def of(arrays: Mapping[str, Array]) -> "CellTable":
        """The table of `arrays`. Raises KeyError if one is missing, ValueError for another number of numbers."""
        kinds = [
            _Nodes(
                NodeAxis(arrays[f"{kind}_rows"]),
                NodeAxis(arrays[f"{kind}_columns"]),
                *(arrays[f"{kind}_{part}"] for part in _PARTS),
            )
            for kind in _KINDS
        ]
        radius, outer, depth, apex, cavity, pressure = map(float, arrays["numbers"])
        return CellTable(radius, outer, depth, apex, cavity, pressure, *kinds)

    def scaled(self, size: float = 1.0, force: float = 1.0) -> "CellTable":
        """The table of a similar cell, ``size`` times as large, with ``force`` times the forces of its size; pressures
        are the same where the gas behind the cell is similar too."""
        scale = force * size**2 * np.array([1.0, 1.0, size, 1.0 / (force * size**2)])
        nodes: dict[str, Any] = {
            kind: replace(one, values=one.values * scale, first=one.first * size, reach=one.reach * size)
            for kind, one in ((kind, getattr(self, kind)) for kind in _KINDS)
        }
        lengths = {name: size * getattr(self, name) for name in ("radius", "outer", "depth", "apex")}
        return replace(self, **nodes, cavity=self.cavity * size**3, **lengths)

    def under_round(self, kind: str, radius: Array, offset: Array, height: Array) -> CellAnswer:
        """Under ``balls`` or ``cylinders`` of radii from the first to the last of `RADII`, their axes at distances
        ``offset`` from that of the dome, lowest points at ``height`` over the base plane; arrays of one shape."""
        share = offset / (greatest_lean(self.depth, self.outer, radius) * (self.outer + radius))
        beyond = share > SHARES[-1] * 1.05
        rows, columns = np.log(radius / self.radius), np.minimum(share, SHARES[-1])
        answer = self._at(getattr(self, kind), rows, columns**2, columns, height)
        force, sideways, moment, rise = (np.where(beyond, 0.0, one) for one in answer[:4])
        return CellAnswer(force, sideways, moment, rise, answer.inside | beyond)

    def under_plate(self, lean: Array, height: Array) -> CellAnswer:
        """Under plates that lean by angles of sines ``lean`` and whose plane crosses the axis at ``height``."""
        return self._at(self.plates, np.zeros_like(lean), lean**2, lean, height)

    def straight(self, kind: str, bends: Array, leans: Array) -> tuple[Array, Array, Array]:
        """Height at first contact (a, b), end of the range (a, b), and force, sideways force, moment and rise at equal
        travels (a, b, `_POINTS`, 4), between which a reader may go straight.

        Of ``balls`` and ``cylinders`` at ``bends`` (a,), R0 over their radii, and shares ``leans`` (b,) of the greatest
        offset; of ``plates`` at sines ``leans``."""
        nodes: _Nodes = getattr(self, kind)
        by_row, by_column = nodes.rows.weights(-np.log(bends)), nodes.columns.weights(leans**2)
        first, reach = (np.einsum("ra,cb,ab->rc", by_row, by_column, part) for part in (nodes.first, nodes.reach))
        values = np.einsum("ra,cb,abpk->rcpk", by_row, by_column, nodes.values)
        values[..., 1:3] *= leans[:, None, None]
        return first, reach, values

    def _at(self, nodes: _Nodes, rows: Array, columns: Array, lean: Array, height: Array) -> CellAnswer:
        shape = np.shape(height)
        by_row = nodes.rows.weights(rows.ravel())
        by_column = nodes.columns.weights(columns.ravel())
        weight = by_row[:, :, None] * by_column[:, None, :]
        travel = np.einsum("nab,ab->n", weight, nodes.first) - height.ravel()
        reach = np.einsum("nab,ab->n", weight, nodes.reach)
        step = np.clip(travel, 0.0, self.depth) / self.depth * (_POINTS - 1)
        low = np.minimum(step.astype(np.intp), _POINTS - 2)
        share = (step - low)[:, None]
        along = nodes.values.reshape(-1, _POINTS, 4).transpose(1, 0, 2)
        # Of few contacts the whole table is less work than gathering its rows.
        here = np.einsum("nk,nkc->nc", weight.reshape(len(low), -1), along[low])
        there = np.einsum("nk,nkc->nc", weight.reshape(len(low), -1), along[low + 1])
        value = here + share * (there - here)
        value[:, 1:3] *= lean.ravel()[:, None]
        force, sideways, moment, rise = (np.where(travel > 0.0, one, 0.0).reshape(shape) for one in value.T)
        return CellAnswer(force, sideways, moment, rise, (travel <= reach).reshape(shape))


def greatest_lean(depth: float, outer: float, radius: Array) -> Array:
    """Sine of the angle between the axis and the normal at first contact, of a ball or cylinder whose lowest point is
    as deep as ``depth`` below the top of a dome of radius ``outer``, and which just touches it."""
    return np.asarray(np.sqrt(1.0 - (1.0 - depth / (outer + radius)) ** 2))


Progress = Callable[[int, int], None]
"""Called with the number of presses made, and of all."""


def cell_table(sensor: Sensor, driving_pressure: float, progress: Progress = lambda done, total: None) -> CellTable:
    """The table of a cell at one driving pressure (MPa), by 44 presses of ``harmonic``, which take minutes.

    The depth is that of the sensor's test, or where the range of its central plate ends or, on a flange, its wall lies
    down. Raises BeyondLimitError, and ComputationError for a press that finds no equilibrium."""
    plain = sensor.replace(waves=0, body=None, offset=0.0, tilt=0.0, shear=0.0, friction=0.0, steps=_STEPS)
    lies = np.inf
    if plain.dome.flange is not None:
        # Harmonics have no contact of the wall with the top of its flange.
        (state,) = solid_states(plain, np.array([driving_pressure]))
        lies = min((event.indentation for event in state.events if event.kind == KINDS["base"][0]), default=np.inf)
        plain = plain.replace(base=None)
    probe = solid_probe(plain, _CELLS)
    free = state_at(probe.solid, driving_pressure)
    depth = plain.protocol.depth
    numbers, total = count(1), 1 + len(TILTS) + 2 * len(RADII) * len(SHARES)

    def press(scene: Sensor, depth: float, to: float | None = None) -> _Curve:
        curve = _pressed(scene, probe, free, depth, to)
        progress(next(numbers), total)
        return curve

    depth = min(depth, press(plain, depth).end, lies)
    plates = [press(plain.replace(tilt=float(np.arcsin(lean))), depth) for lean in TILTS]
    radius = plain.dome.inner_radius
    outer = outer_sphere(plain.dome.shape, float(np.sqrt(RADII[0] * RADII[-1])) * radius, depth)
    balls, cylinders = (_beside(plain, body, press, free, depth, outer) for body in (ball, cylinder))
    lengths = radius, outer, depth, free.outer_apex
    level = _nodes(NodeAxis(np.zeros(1)), TILTS, plates, 1)
    return CellTable(*lengths, free.volume, driving_pressure, balls, level, cylinders)


def outer_sphere(shape: DomeShape, ball_radius: float, depth: float) -> float:
    """Radius of the sphere that a ball just touches at the same offset as an unloaded dome, its lowest point ``depth``
    below the top: that of the outer face where it is a part of a sphere."""
    r, z = np.concatenate([piece.along(np.linspace(0.0, 1.0, 400)) for piece in shape.outer]).T
    low, high = 0.0, shape.outer_radius + ball_radius
    for _ in range(50):
        offset = 0.5 * (low + high)
        # In the plane of the axes alone: `first_height` looks all around, in five seconds for these steps.
        under = ball_radius - np.sqrt(np.maximum(ball_radius**2 - (r - offset) ** 2, 0.0))
        touches = (z - under)[np.abs(r - offset) <= ball_radius].max(initial=-np.inf) > shape.outer_height - depth
        low, high = (offset, high) if touches else (low, offset)
    return 0.5 * (low**2 + depth**2) / depth - ball_radius


def _beside(
    plain: Sensor,
    body: Callable[[float], RigidObject],
    press: Callable[[Sensor, float, float], "_Curve"],
    free: FreeState,
    depth: float,
    outer: float,
) -> _Nodes:
    """Presses of bodies of `RADII` at offsets of `SHARES`."""
    curves = []
    for size in plain.dome.inner_radius * np.array(RADII):
        lean = greatest_lean(depth, outer, size) * np.array(SHARES)
        drop = (outer + size) * (1.0 - np.sqrt(1.0 - lean**2))
        # As deep as a body nearer to the axis gets, up to which curves are mixed, but not down to the base plane.
        for one, nearer, down in zip(lean, [0.0, *drop[:-1]], drop, strict=True):
            scene = plain.replace(body=body(float(size)), offset=float(one * (outer + size)))
            to = min(max(depth - float(nearer), _LEAST * depth), _LOWEST * (free.outer_apex - float(down)))
            curves.append(press(scene, depth, to))
    return _nodes(NodeAxis(np.log(RADII)), SHARES, curves, len(RADII))


class _Curve(NamedTuple):
    """A press: values (`_POINTS`, 4) at equal steps to the greatest travel of the table, height at first contact, and
    the travel at which its range ends."""

    values: Array
    first: float
    end: float


def _pressed(sensor: Sensor, probe: StrainProbe, free: FreeState, depth: float, to: float | None = None) -> _Curve:
    """Press of one scene to the travel ``to`` (None: ``depth``), continued straight to ``depth``."""
    press = placed_press(sensor.replace(depth=depth if to is None else to), probe, free)
    test = sensor.protocol
    pressed = press.run(_ORDER if test.off_axis else 0)
    states, grid = pressed.path, np.linspace(0.0, depth, _POINTS)
    last = states[-1].indentation
    if len(states) < _FEWEST:
        raise ComputationError(f"a press of a cell ends at {last:.3g} mm", remedy="lower the driving pressure")
    force, rise = curve_between(states, np.minimum(grid, last))
    known = np.array([state.indentation for state in states])
    columns = [force, *(_between(known, states, name, grid) for name in ("sideways", "moment")), rise]
    values = np.stack(columns, axis=-1)
    beyond = grid > last
    if beyond.any():
        k = int(np.argmax(beyond))
        slope = (values[k - 1] - values[k - 2]) / (grid[k - 1] - grid[k - 2])
        values[beyond] = values[k - 1] + (grid[beyond, None] - grid[k - 1]) * slope
    end = min(range_end(reported_events(pressed.events), last), last)
    return _Curve(values, press.surface.height * probe.solid.length, end)


def _between(known: Array, states: Sequence[OffAxisState], name: str, grid: Array) -> Array:
    return np.asarray(np.interp(grid, known, np.array([getattr(state, name) for state in states])))


def _nodes(rows: NodeAxis, leans: Sequence[float], curves: Sequence[_Curve], count: int) -> _Nodes:
    """Nodes of ``count`` rows of presses; sideways force and moment over the lean, where it is 0 by a parabola."""
    lean = np.array(leans)
    values = np.array([one.values for one in curves]).reshape(count, lean.size, _POINTS, 4)
    values[:, 1:, :, 1:3] /= lean[1:, None, None]
    share = lean[1] ** 2 / (lean[2] ** 2 - lean[1] ** 2)
    values[:, 0, :, 1:3] = values[:, 1, :, 1:3] - share * (values[:, 2, :, 1:3] - values[:, 1, :, 1:3])
    first, reach = (np.array([getattr(one, name) for one in curves]).reshape(count, -1) for name in ("first", "end"))
    return _Nodes(rows, NodeAxis(lean**2), values, first, reach)
