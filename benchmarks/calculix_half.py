"""Half a dome in three dimensions under a rigid object by CalculiX (an optional peer, found on PATH), with its own gas.

C3D20R cells, clamped at the base. The object is a layer of C3D20 cells with quadratic faces on its underside: flat faces
would turn the direction of the contact in jumps. CalculiX freezes which points of the two surfaces meet at the beginning
of an increment (its manual, "Face-to-face penalty contact"). On a round object the direction of the force therefore lags
behind: a ball's sideways force is 10 % off after 0.5 mm in one increment. Increments without any motion before every
figure remove that. CalculiX has no trapped gas. At each depth the press therefore has two pressures, a given one and one
a little higher. From the volumes that CalculiX finds, its own initial or inflated one included, Boyle's law gives the
pressure that its dome has, and with it the forces. After the press the object may move sideways at the last depth.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from benchmarks.calculix_sweep import run_calculix
from benchmarks.scenes import PAPER
from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.surface import Surface
from pneutouch.mechanics.solid.elements import cell_shapes, gauss_square
from pneutouch.mechanics.solid.mesh import with_middles

INNER, WALL = PAPER.dome.inner_radius, PAPER.dome.wall_thickness
_RAISED = 2.0e-4
"""How much the second pressure at a depth lies above the first, MPa."""
_ALONG = 0.1
"""Stiffness of the contact along the surface over that across it."""
HOLE = np.radians(0.6)
"""A hole at the pole spares degenerate cells; its area is a ten-thousandth of the base's."""
SPRING = 300.0
"""Stiffness of the contact, MPa/mm."""


class Grid:
    """Half a dome of C3D20R cells: ``arc`` from base to pole, ``through`` the wall, ``around`` half the axis.

    ``angles`` of the nodes above the base (rad), those in the middle of cells included; without them the cells are
    equally long.
    """

    def __init__(self, arc: int, through: int, around: int, angles: Array | None = None) -> None:
        self.arc, self.through, self.around = arc, through, around
        self.number: dict[tuple[int, int, int], int] = {}
        self.points: list[tuple[float, float, float]] = []
        angle = np.linspace(0.0, 0.5 * np.pi - HOLE, 2 * arc + 1) if angles is None else angles
        radius = INNER + WALL * np.linspace(0.0, 1.0, 2 * through + 1)
        turn = np.linspace(0.0, np.pi, 2 * around + 1)
        for k, i, j in np.ndindex(turn.size, angle.size, radius.size):
            if i % 2 + j % 2 + k % 2 > 1:
                continue
            r = radius[j] * np.cos(angle[i])
            self.number[i, j, k] = len(self.points) + 1
            self.points.append((r * np.cos(turn[k]), r * np.sin(turn[k]), radius[j] * np.sin(angle[i])))

    def cells(self) -> list[tuple[list[int], bool, bool]]:
        """Nodes of each cell, and whether it has a face inside and one outside."""
        out = []
        for k, i, j in np.ndindex(self.around, self.arc, self.through):
            a, b, c = 2 * i, 2 * j, 2 * k
            # Seen along the turn: inner low, inner high, outer high, outer low.
            corners = [(a, b), (a + 2, b), (a + 2, b + 2), (a, b + 2)]
            sides = [(a + 1, b), (a + 2, b + 1), (a + 1, b + 2), (a, b + 1)]
            order = [(*p, c) for p in corners] + [(*p, c + 2) for p in corners]
            order += [(*p, c) for p in sides] + [(*p, c + 2) for p in sides] + [(*p, c + 1) for p in corners]
            out.append(([self.number[node] for node in order], j == 0, j == self.through - 1))
        return out


class Stop(NamedTuple):
    """CalculiX's dome at one depth (mm): force on the object and its part along x (N), gauge pressure (MPa), and how far
    that lies above the pressure that was given (MPa); ``travel`` of the object along x (mm)."""

    depth: float
    force: float
    sideways: float
    pressure: float
    added: float
    travel: float = 0.0


class Cost(NamedTuple):
    """Processor time of CalculiX (s), whole process, and the share of its Newton iterations that went to the raised
    pressures."""

    seconds: float
    raised: float


@dataclass(frozen=True)
class HalfPress:
    """A press of the paper's sensor from a driving pressure (MPa) to depths (mm, rising, the first 0).

    travels: where the object then goes along x from where it stood, mm, in the order in which it goes there.
    surface: the object in R0 at first contact.  edges: of the object's cells, along x and y, mm.
    cells: along the arc, through the wall, around half the axis; those in the upper half of the arc are ``closer`` times
    shorter than below.  increment: greatest one, as a share of the way from depth to depth.
    wall: shear modulus (MPa) and Poisson's ratio.
    """

    surface: Surface
    edges: tuple[Array, Array]
    driving: float
    depths: Array
    cells: tuple[int, int, int] = (30, 2, 16)
    closer: float = 1.0
    friction: float = 0.0
    increment: float = 0.5
    ambient: float = 0.101325
    wall: tuple[float, float] = (PAPER.wall.shear_modulus, PAPER.wall.poisson_ratio)
    travels: tuple[float, ...] = ()

    @property
    def places(self) -> list[tuple[float, float]]:
        """Depth and travel along x (mm) at each place where the object stops after first contact."""
        pressed = [(float(depth), 0.0) for depth in self.depths[1:]]
        return pressed + [(pressed[-1][0], travel) for travel in self.travels]

    @property
    def grid(self) -> Grid:
        """The nodes of the dome."""
        half = 0.25 * np.pi
        counted = np.array([0.0, 1.0, 1.0 + self.closer])
        ends = np.interp(np.linspace(0.0, counted[-1], self.cells[0] + 1), counted, [0.0, half, 2.0 * half])
        ends[-1] -= HOLE
        return Grid(*self.cells, angles=with_middles(ends))

    def run(self, pressures: Array) -> tuple[list[Stop], Cost]:
        """CalculiX's answers near gauge pressures (MPa) at first contact and where the object stops, and what they cost;
        those that it does not reach are left out."""
        grid = self.grid
        found, cost = calculix_stops(deck(self, grid, pressures), grid)
        begin = 1 if self.driving else 0
        first = found[1.0][1] if begin else np.array(grid.points)
        amount = (self.ambient + self.driving) * inside_volume(grid, first)
        out = []
        for k, (given, (depth, travel)) in enumerate(zip(pressures[1:].tolist(), self.places, strict=True)):
            if begin + 2.0 * k + 2.0 not in found:
                break
            (low, inside), (high, swelling) = (found[begin + 2.0 * k + up] for up in (1.5, 2.0))
            volume, swollen = inside_volume(grid, inside), inside_volume(grid, swelling)
            lacks = amount / volume - self.ambient - given
            share = lacks / (_RAISED + amount / volume - amount / swollen)
            force = low + share * (high - low)
            out.append(Stop(depth, force[2], force[0], given + share * _RAISED, share * _RAISED, travel))
        return out, Cost(cost.seconds, self._raised(cost.iterations))

    def _raised(self, iterations: list[tuple[float, int]]) -> float:
        """Share of the iterations, given by the time at which their increments end, at the raised pressures."""
        begin = 1.0 if self.driving else 0.0
        total = sum(count for _, count in iterations)
        raised = sum(count for time, count in iterations if time > begin and (time - begin - 1e-9) % 2.0 > 1.5)
        return raised / total


def deck(press: HalfPress, grid: Grid, pressures: Array) -> list[str]:
    """The input of CalculiX for gauge pressures (MPa) at the depths of the press."""
    return [*half_model(press, grid), *_step(press, pressures)]


def half_model(press: HalfPress, grid: Grid) -> list[str]:
    """Dome, object, materials and contact, as lines of a deck."""
    mu, nu = press.wall
    bulk = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))
    spring = SPRING * mu / PAPER.wall.shear_modulus
    lines = [*_dome(grid), *_object(press, len(grid.points), grid.around * grid.arc * grid.through)]
    lines += ["*MATERIAL,NAME=RUBBER", "*HYPERELASTIC,NEO HOOKE", f"{0.5 * mu:.12g},{2 / bulk:.12g}"]
    lines += ["*MATERIAL,NAME=STIFF", "*ELASTIC", "1000,0.3"]
    lines += ["*SOLID SECTION,ELSET=WALL,MATERIAL=RUBBER", "*SOLID SECTION,ELSET=BODY,MATERIAL=STIFF"]
    lines += ["*SURFACE INTERACTION,NAME=MEETS", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{spring:.12g}"]
    lines += ["*FRICTION", f"{press.friction:.12g},{_ALONG * spring:.12g}"] if press.friction else []
    return [*lines, "*CONTACT PAIR,INTERACTION=MEETS,TYPE=SURFACE TO SURFACE", "OUT,UNDER"]


def _step(press: HalfPress, pressures: Array) -> list[str]:
    """In one unit of time the dome is inflated, if at all. Then to each place the object goes in one unit and rests for
    half of one, and the pressure is raised and rests in a quarter each."""
    begin = [(0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, press.driving)]
    course = begin if press.driving else begin[:1]
    for (depth, travel), pressure in zip(press.places, pressures[1:], strict=True):
        at = course[-1][0]
        course += [(at + later, depth, travel, pressure) for later in (1.0, 1.5)]
        course += [(at + later, depth, travel, pressure + _RAISED) for later in (1.75, 2.0)]
    last = course[-1][0]
    fixed = "OBJECT,2,2" if press.travels else "OBJECT,1,2"
    return [
        *amplitude("DOWN", [(row[0], row[1]) for row in course]),
        *(amplitude("ASIDE", [(row[0], row[2]) for row in course]) if press.travels else []),
        *amplitude("GAS", [(row[0], row[3]) for row in course]),
        *("*TIME POINTS,NAME=STOPS,GENERATE", f"0.5,{last:.12g},0.5"),
        *("*BOUNDARY", "HELD,1,3", "FLAT,2,2", fixed),
        *("*STEP,NLGEOM,INC=2000", "*STATIC", f"0.1,{last:.12g},1e-5,{press.increment:.12g}"),
        *("*CONTROLS,PARAMETERS=FIELD", "1e-3,1e-2"),
        *("*BOUNDARY,AMPLITUDE=DOWN", "OBJECT,3,3,-1", "*DLOAD,AMPLITUDE=GAS", "INNER,P3,1"),
        *(("*BOUNDARY,AMPLITUDE=ASIDE", "OBJECT,1,1,1") if press.travels else ()),
        *("*NODE PRINT,NSET=INSIDE,TIME POINTS=STOPS", "U"),
        *("*NODE PRINT,NSET=OBJECT,TOTALS=ONLY,TIME POINTS=STOPS", "RF", "*END STEP"),
    ]


def amplitude(name: str, course: list[tuple[float, float]]) -> list[str]:
    """An amplitude over the total time."""
    return [f"*AMPLITUDE,NAME={name},TIME=TOTAL TIME", *(f"{time:.12g},{value:.12g}" for time, value in course)]


def _dome(grid: Grid) -> list[str]:
    """The nodes and cells of the wall and their sets."""
    cells = grid.cells()
    flat = [number for (_, _, k), number in grid.number.items() if k in (0, 2 * grid.around)]
    held = [number for (i, _, _), number in grid.number.items() if i == 0]
    inner = [number for (_, j, _), number in grid.number.items() if j == 0]
    return [
        "*NODE",
        *(f"{n},{x:.12g},{y:.12g},{z:.12g}" for n, (x, y, z) in enumerate(grid.points, 1)),
        "*ELEMENT,TYPE=C3D20R,ELSET=WALL",
        *(element(n, nodes) for n, (nodes, _, _) in enumerate(cells, 1)),
        *listed("*NSET,NSET=FLAT", flat),
        *listed("*NSET,NSET=HELD", held),
        *listed("*NSET,NSET=INSIDE", inner),
        *listed("*ELSET,ELSET=INNER", [n for n, cell in enumerate(cells, 1) if cell[1]]),
        *("*SURFACE,NAME=OUT", *(f"{n},S5" for n, cell in enumerate(cells, 1) if cell[2])),
    ]


def _object(press: HalfPress, nodes: int, cells: int) -> list[str]:
    """The nodes and cells of the object, after those of the dome; its underside is S1 of every cell."""
    xs, ys = (with_middles(np.asarray(edges)) for edges in press.edges)
    number: dict[tuple[int, int, int], int] = {}
    lines = ["*NODE,NSET=OBJECT"]
    for i, k, up in np.ndindex(xs.size, ys.size, 3):
        if i % 2 + k % 2 + up % 2 > 1:
            continue
        number[i, k, up] = nodes + len(number) + 1
        at = press.surface.over(np.array(xs[i] / INNER), np.array(ys[k] / INNER)).height
        lines.append(f"{number[i, k, up]},{xs[i]:.12g},{ys[k]:.12g},{INNER * float(at) + 0.5 * up:.12g}")
    lines.append("*ELEMENT,TYPE=C3D20,ELSET=BODY")
    for n, (a, c) in enumerate(np.ndindex(len(press.edges[0]) - 1, len(press.edges[1]) - 1), 1):
        i, k = 2 * a, 2 * c
        corners = [(i, k), (i + 2, k), (i + 2, k + 2), (i, k + 2)]
        sides = [(i + 1, k), (i + 2, k + 1), (i + 1, k + 2), (i, k + 1)]
        order = [(*p, 0) for p in corners] + [(*p, 2) for p in corners]
        order += [(*p, 0) for p in sides] + [(*p, 2) for p in sides] + [(*p, 1) for p in corners]
        lines.append(element(cells + n, [number[spot] for spot in order]))
    return [*lines, "*SURFACE,NAME=UNDER", "BODY,S1"]


def element(number: int, nodes: list[int]) -> str:
    """A cell of 20 nodes on two lines."""
    return f"{number}," + ",".join(map(str, nodes[:10])) + ",\n" + ",".join(map(str, nodes[10:]))


def listed(head: str, numbers: list[int]) -> list[str]:
    """A set under its heading."""
    return [head, *(f"{n}," for n in sorted(numbers))]


class Work(NamedTuple):
    """Processor time of CalculiX (s), and the Newton iterations of every increment by the time at its end."""

    seconds: float
    iterations: list[tuple[float, int]]


def calculix_stops(lines: list[str], grid: Grid) -> tuple[dict[float, tuple[Array, Array]], Work]:
    """Force on the object of the whole dome (3,) and positions of the nodes of the inner wall (the others at rest,
    (n, 3)) by the time, at every half unit that CalculiX reaches on a deck; and the work for all of them."""
    run = run_calculix(lines)
    # Columns: step, increment, attempt, iterations, total time, step time, increment.
    counts = [(float(w[4]), int(w[3])) for w in map(str.split, run.status) if len(w) == 7 and w[0].isdigit()]
    work = Work(run.seconds, counts)
    stops, place, time = dict[float, tuple[Array, Array]](), np.array(grid.points), 0.0
    for line in run.prints:
        words = line.split()
        if "time" in words:
            time = round(float(words[-1]), 6)
        elif len(words) == 4 and words[0].isdigit():
            place[int(words[0]) - 1] = grid.points[int(words[0]) - 1] + np.array(words[1:], dtype=np.float64)
        elif len(words) == 3:
            stops[time] = (-2.0 * np.array(words, dtype=np.float64), place.copy())
    return stops, work


def inside_volume(grid: Grid, places: Array) -> float:
    """Volume inside the inner wall of the whole dome above z = 0 (mm^3) for positions of the nodes (n, 3).

    Quadratic faces by 3 x 3 Gauss points each.
    """
    points, weights = gauss_square(3)
    value, slope = cell_shapes(points, 8)
    total = 0.0
    for k, i in np.ndindex(grid.around, grid.arc):
        a, c = 2 * i, 2 * k
        spots = [(a, c), (a + 2, c), (a + 2, c + 2), (a, c + 2), (a + 1, c), (a + 2, c + 1), (a + 1, c + 2), (a, c + 1)]
        place = places[[grid.number[p, 0, q] - 1 for p, q in spots]]
        at, along, turned = value @ place, slope[..., 0] @ place, slope[..., 1] @ place
        # The horizontal position through the surface: half its flux is the volume.
        normal = np.cross(turned, along)
        total += float(weights @ (at[:, :2] * normal[:, :2]).sum(axis=1))
    return abs(total)
