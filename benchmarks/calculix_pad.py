"""Domes on one flange in three dimensions under a rigid object by CalculiX (an optional peer, found on PATH).

C3D20R cells as in `calculix_half`, in the half y >= 0 of a pad that is its own mirror image there: domes whose axes lie
in the plane are halves, those beside it whole. Around each dome the flange is cut half way to its neighbours, so that
the meshes of neighbours meet node by node: the cells have the pitch from axis to axis, or stand alone. Gauge pressures
are given; the volumes that CalculiX finds give those that the shut-in gas would have.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from benchmarks.calculix_half import HOLE, SPRING, amplitude, element, listed
from benchmarks.calculix_sweep import run_calculix
from benchmarks.scenes import PAPER
from pneutouch.arrays import Array, Index
from pneutouch.mechanics.sensor import WallMaterial
from pneutouch.mechanics.solid.elements import cell_shapes, gauss_square

Seat = Literal["base", "groove", "alone", "underside"]
"""What is held. ``base``: the base plane of the domes, which have no flange; ``groove``: the flange's underside and the
walls of its holes, as glue that fills the gaps of the fit holds them; ``alone``: the same, and the object meets the first
dome alone; ``underside``: the underside alone, the walls of the holes under the pressure of the gas."""
_CORNERS, _SIDES = [(0, 0), (2, 0), (2, 2), (0, 2)], [(1, 0), (2, 1), (1, 2), (0, 1)]
_ORDER = [(*p, k) for p, k in [(p, k) for at in (_CORNERS, _SIDES) for k in (0, 2) for p in at]]
_ORDER += [(*p, 1) for p in _CORNERS]
"""Steps along i, j and k to the nodes of a cell of 20 nodes, as in `Grid.cells`."""
_INSIDE = [0, 1, 5, 4, 8, 17, 12, 16]
"""Nodes of the face of a cell on its low side of j, the face 3 of CalculiX; that on the high side is its face 5."""
_SAME = 1e-6
"""Nodes nearer than this are one, mm."""
_REACH, _FACES = 4.0, 8
"""Half the width of the object's patch over a dome, mm, and the faces along it."""


class PadBody(NamedTuple):
    """The rubber: nodes (n, 3), cells (m, 20), and for each dome the numbers of its cells with a face on the cavity (that
    of the flange's hole included) and with one outside; fixed nodes, and nodes in the plane of symmetry."""

    nodes: Array
    cells: Index
    inner: list[Index]
    outer: list[Index]
    held: Index
    flat: Index


@dataclass(frozen=True)
class PadShape:
    """Sizes of a pad, mm: axes of its domes with y >= 0 (n, 2), least distance of two, radius and thickness of the wall,
    width and thickness of the flange."""

    places: Array
    pitch: float
    radius: float
    wall: float
    flange: tuple[float, float]

    def body(self, cells: tuple[int, int, int], seat: Seat) -> PadBody:
        """Mesh with ``cells`` along the arc, through the wall and around a whole dome, a multiple of 12."""
        domes = [self._blocks(k, cells, seat) for k in range(len(self.places))]
        points = np.concatenate([block.reshape(-1, 3) for blocks in domes for block in blocks])
        start, count, found, inner, outer = 0, 0, list[Index](), list[Index](), list[Index]()
        for blocks in domes:
            faces = list[Index]()
            for number, block in enumerate(blocks):
                made, low, high = _cells(block.shape[:3])
                found.append(made + start)
                faces += [low + count] if number < 2 else []
                outer += [high + count] if number == 0 else []
                start, count = start + block[..., 0].size, count + len(made)
            inner.append(np.concatenate(faces))
        every = np.concatenate(found)
        used, flat = np.unique(every, return_inverse=True)
        _, kept, number = np.unique(
            np.round(points[used] / _SAME) + 0.0, axis=0, return_index=True, return_inverse=True
        )
        nodes = points[used][kept]
        return PadBody(
            nodes,
            number.reshape(-1)[flat].reshape(every.shape).astype(np.intp),
            inner,
            outer,
            self._held(nodes, seat),
            np.flatnonzero(np.abs(nodes[:, 1]) < _SAME).astype(np.intp),
        )

    def _held(self, nodes: Array, seat: Seat) -> Index:
        low, z = -self.flange[1], nodes[:, 2]
        if seat == "base":
            return np.flatnonzero(z < _SAME).astype(np.intp)
        fixed = z < low + _SAME
        if seat != "underside":
            from_axis = np.hypot(*(nodes[:, None, :2] - self.places).transpose(2, 0, 1)).min(axis=1)
            fixed |= (z < _SAME) & (from_axis < self.radius + _SAME)
        return np.flatnonzero(fixed).astype(np.intp)

    def _blocks(self, k: int, cells: tuple[int, int, int], seat: Seat) -> list[Array]:
        """Grids (i up, j outwards, k around, 3) of a dome, and of the flange under its wall and around it."""
        arc, through, around = cells
        turns = np.linspace(0.0, 2.0 * np.pi, 2 * around + 1)[: around + 1 if self.places[k, 1] < _SAME else None]
        out = np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=-1)
        wall = self.radius + self.wall * np.linspace(0.0, 1.0, 2 * through + 1)
        up = np.linspace(0.0, 0.5 * np.pi - HOLE, 2 * arc + 1)
        axis, centre = np.array([0.0, 0.0, 1.0]), np.append(self.places[k], 0.0)
        along = np.cos(up)[:, None, None] * out + np.sin(up)[:, None, None] * axis
        blocks = [centre + wall[None, :, None, None] * along[:, None]]
        if seat == "base":
            return blocks
        wide, low = max(1, through), self.flange[1] * np.linspace(-1.0, 0.0, 2 * max(2, through) + 1)
        share = np.linspace(0.0, 1.0, 2 * wide + 1)[:, None]
        rims = [np.repeat(wall[:, None], len(turns), axis=1), wall[-1] + share * (self._rim(k, turns) - wall[-1])]
        return blocks + [centre + rim[None, :, :, None] * out + low[:, None, None, None] * axis for rim in rims]

    def _rim(self, k: int, turns: Array) -> Array:
        """Distance from the axis of a dome at which its part of the flange ends: half way to a neighbour, or the rim."""
        rim = np.full(turns.shape, self.radius + self.wall + self.flange[0])
        mirrored = self.places[self.places[:, 1] > _SAME] * [1.0, -1.0]
        for x, y in np.concatenate([self.places, mirrored]) - self.places[k]:
            if abs(np.hypot(x, y) - self.pitch) < _SAME:
                aside = (turns - np.arctan2(y, x) + np.pi) % (2.0 * np.pi) - np.pi
                near = np.abs(aside) < np.pi / 6.0 + _SAME
                rim[near] = 0.5 * self.pitch / np.cos(aside[near])
        return rim


def _cells(shape: tuple[int, ...]) -> tuple[Index, Index, Index]:
    """Cells (n, 20) of a grid of nodes, and the numbers of those on the low and on the high side of j."""
    counts = [(size - 1) // 2 for size in shape]
    i, j, k = (grid.ravel() for grid in np.meshgrid(*map(np.arange, counts), indexing="ij"))
    nodes = [np.ravel_multi_index((2 * i + a, 2 * j + b, 2 * k + c), shape) for a, b, c in _ORDER]
    low, high = np.flatnonzero(j == 0), np.flatnonzero(j == counts[1] - 1)
    return np.stack(nodes, axis=-1), low.astype(np.intp), high.astype(np.intp)


class PadStop(NamedTuple):
    """A pad at one depth of the object: forces on the object (n, 3) of whole domes, N; whole force (3,), N, and moment
    about the origin (3,), N mm; volumes of the cavities (n,), mm3. Domes in the order of the places with y >= 0."""

    forces: Array
    force: Array
    moment: Array
    volumes: Array


@dataclass(frozen=True)
class PadPress:
    """An object that goes down on a pad: ``height`` of its underside over x and y at the depth 0, mm; it waits ``above``
    that while the pad is inflated to ``driving`` (MPa), and stops at ``depths``, with gauge pressures (depths, n).
    ``increment``: greatest one, as a share of the way from depth to depth."""

    shape: PadShape
    wall: WallMaterial
    height: Callable[[Array, Array], Array]
    above: float
    driving: float
    depths: Array
    pressures: Array
    increment: float = 0.25

    def run(self, cells: tuple[int, int, int], seat: Seat) -> tuple[list[PadStop], float]:
        """The inflated pad and the pad at each depth that CalculiX reaches, and its processor time, s."""
        body = self.shape.body(cells, seat)
        patches = self._patches(len(body.nodes))
        run = run_calculix([*self._model(body, patches, seat), *self._step()])
        stops, time, kind = dict[float, tuple[Array, Array]](), 0.0, ""
        size = len(body.nodes) + sum(len(nodes) for nodes, _ in patches)
        for words in map(str.split, run.prints):
            if "time" in words:
                time, kind = round(float(words[-1]), 6), words[0]
                stops.setdefault(time, (np.zeros((size, 3)), np.zeros((size, 3))))
            elif len(words) == 4:
                stops[time][kind == "forces"][int(words[0]) - 1] = np.array(words[1:], dtype=np.float64)
        times = [1.0, *(1.5 * k + 2.5 for k in range(len(self.depths)))]
        found = [(time, depth) for time, depth in zip(times, [-self.above, *self.depths], strict=True) if time in stops]
        return [self._stop(body, patches, depth, *stops[time]) for time, depth in found], run.seconds

    def _stop(
        self, body: PadBody, patches: list[tuple[Array, Index]], depth: float, moved: Array, load: Array
    ) -> PadStop:
        places, first = body.nodes + moved[: len(body.nodes)], len(body.nodes)
        forces, whole, moment, volumes = [], np.zeros(3), np.zeros(3), []
        for k, (nodes, _) in enumerate(patches):
            own = -load[first : first + len(nodes)]
            first += len(nodes)
            turned = np.cross(nodes - [0.0, 0.0, self.above + depth], own).sum(axis=0)
            # The mirror image of the half that is computed has the same force along x and z, and moment about y.
            whole += 2.0 * own.sum(axis=0) * [1.0, 0.0, 1.0]
            moment += 2.0 * turned * [0.0, 1.0, 0.0]
            share = 2.0 if self.shape.places[k, 1] < _SAME else 1.0
            forces.append(share * own.sum(axis=0))
            axis = np.append(self.shape.places[k], 0.0)
            volumes.append(share * _volume(places[body.cells[body.inner[k]][:, _INSIDE]] - axis))
        return PadStop(np.array(forces), whole, moment, np.array(volumes))

    def _patches(self, first: int) -> list[tuple[Array, Index]]:
        """Nodes of the object over each dome, where it waits, and its cells, which count them from ``first``."""
        out = []
        for x, y in self.shape.places:
            across = np.linspace(-_REACH, _REACH, 2 * _FACES + 1)
            along = across if y > _SAME else np.linspace(-2.0, _REACH, 2 * _FACES + 1)
            at = np.stack(np.meshgrid(x + across, y + along, [0.0, 0.25, 0.5], indexing="ij"), axis=-1)
            at[..., 2] += self.height(at[..., 0], at[..., 1]) + self.above
            # The underside is the face S1, whose nodes run around it: i and j along it, k upwards.
            cells = _cells(at.shape[:3])[0]
            used, number = np.unique(cells, return_inverse=True)
            out.append((at.reshape(-1, 3)[used], number.reshape(cells.shape) + first))
            first += len(used)
        return out

    def _model(self, body: PadBody, patches: list[tuple[Array, Index]], seat: Seat) -> list[str]:
        """Rubber, object, materials, contact and supports, as lines of a deck."""
        mu, nu = self.wall.shear_modulus, self.wall.poisson_ratio
        bulk = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))
        lines = _nodes("*NODE", body.nodes, 1)
        lines += _elements("C3D20R,ELSET=WALL", body.cells, 1)
        lines += [*listed("*NSET,NSET=HELD", body.held + 1), *listed("*NSET,NSET=FLAT", body.flat + 1)]
        at, count, skin = len(body.nodes) + 1, len(body.cells) + 1, list[Index]()
        for k, (nodes, cells) in enumerate(patches):
            lines += [*_nodes("*NODE,NSET=OBJECT", nodes, at), *_elements(f"C3D20,ELSET=BODY{k}", cells, count)]
            lines += ["*SOLID SECTION,MATERIAL=STIFF,ELSET=" + f"BODY{k}", f"*SURFACE,NAME=UNDER{k}", f"BODY{k},S1"]
            lines += [f"*SURFACE,NAME=OUT{k}", *(f"{n + 1},S5" for n in body.outer[k])]
            lines += listed(f"*ELSET,ELSET=INNER{k}", body.inner[k] + 1)
            at, count = at + len(nodes), count + len(cells)
            skin.append(np.unique(body.cells[body.inner[k]][:, _INSIDE]))
        lines += listed("*NSET,NSET=INSIDE", np.unique(np.concatenate(skin)) + 1)
        lines += ["*MATERIAL,NAME=RUBBER", "*HYPERELASTIC,NEO HOOKE", f"{0.5 * mu:.12g},{2 / bulk:.12g}"]
        lines += ["*MATERIAL,NAME=STIFF", "*ELASTIC", "1000,0.3", "*SOLID SECTION,ELSET=WALL,MATERIAL=RUBBER"]
        lines += ["*SURFACE INTERACTION,NAME=MEETS", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR"]
        lines += [f"{SPRING * mu / PAPER.wall.shear_modulus:.12g}"]
        lines += ["*CONTACT PAIR,INTERACTION=MEETS,TYPE=SURFACE TO SURFACE"]
        touched = range(1 if seat == "alone" else len(patches))
        return [*lines, *(f"OUT{k},UNDER{k}" for k in touched)]

    def _step(self) -> list[str]:
        """In one unit of time the domes are inflated; to each depth the object goes in one, and rests for half of one."""
        course = [(0.0, 0.0), (1.0, 0.0)]
        for depth in self.depths.tolist():
            at = course[-1][0]
            course += [(at + later, self.above + depth) for later in (1.0, 1.5)]
        stops = [course[1][0], *(time for time, _ in course[3::2])]
        gas = np.concatenate([np.zeros_like(self.pressures[:1]), np.full_like(self.pressures[:1], self.driving)])
        gas = np.concatenate([gas, np.repeat(self.pressures, 2, axis=0)])
        times, count = [time for time, _ in course], self.pressures.shape[1]
        loads = [(f"*DLOAD,AMPLITUDE=GAS{k}", f"INNER{k},P3,1") for k in range(count)]
        return [
            *amplitude("DOWN", course),
            *(line for k in range(count) for line in amplitude(f"GAS{k}", list(zip(times, gas[:, k], strict=True)))),
            *("*TIME POINTS,NAME=STOPS", *(f"{time:.12g}," for time in stops)),
            *("*BOUNDARY", "HELD,1,3", "FLAT,2,2", "OBJECT,1,2"),
            *("*STEP,NLGEOM,INC=2000", "*STATIC", f"0.1,{times[-1]:.12g},1e-5,{self.increment:.12g}"),
            *("*CONTROLS,PARAMETERS=FIELD", "1e-3,1e-2"),
            *("*BOUNDARY,AMPLITUDE=DOWN", "OBJECT,3,3,-1", *(line for load in loads for line in load)),
            *("*NODE PRINT,NSET=INSIDE,TIME POINTS=STOPS", "U"),
            *("*NODE PRINT,NSET=OBJECT,TIME POINTS=STOPS", "RF", "*END STEP"),
        ]


def _nodes(head: str, nodes: Array, first: int) -> list[str]:
    return [head, *(f"{n},{x:.12g},{y:.12g},{z:.12g}" for n, (x, y, z) in enumerate(nodes.tolist(), first))]


def _elements(head: str, cells: Index, first: int) -> list[str]:
    return [f"*ELEMENT,TYPE={head}", *(element(n, nodes) for n, nodes in enumerate((cells + 1).tolist(), first))]


def _volume(faces: Array) -> float:
    """Volume inside quadratic faces (n, 8, 3) around a vertical axis through 0, mm3, if ends are level: half the flux of
    the horizontal position through them."""
    points, weights = gauss_square(3)
    value, slope = cell_shapes(points, 8)
    at = value @ faces
    along, turned = (np.einsum("qa,fai->fqi", slope[..., k], faces) for k in range(2))
    normal = np.cross(along, turned)
    return abs(0.5 * float((weights * (at[..., :2] * normal[..., :2]).sum(axis=-1)).sum()))
