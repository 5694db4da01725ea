"""A second opinion on one mesh by pymeshlab, which is GPL and not part of the package's dependencies."""

import importlib
from typing import Any, Protocol

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.errors import InputError
from pneutouch.results.printing import Excess, Finding, Severity
from pneutouch.units import UM

_SOURCE = "measured with pymeshlab (MeshLab's filters), independently of the meshes' maker"
_FINER = 10.0
"""Factor by which the mesh that stands for the exact solid is finer than the one inspected."""
_SLIVER = 1.0
"""Least angle of a triangle in degrees below which slicers and solvers lose precision (own, unverified)."""
_MANY = 0.1
"""Share of slivers above which there is a finding (own, unverified)."""


class Meshable(Protocol):
    """An exact solid that meshes itself."""

    def mesh(self, tolerance: float) -> Body:
        """Mesh of the body within ``tolerance`` mm."""


def inspect(body: Body, solid: Meshable | None = None, tolerance: float = 0.016) -> list[Finding]:
    """Self-intersections, topology, sliver triangles, and the distance in both directions from a ten times finer mesh.

    ``tolerance`` (mm) is that of the body's mesh. The distance is measured only with ``solid``. Takes seconds. Raises
    InputError if pymeshlab is not installed.
    """
    try:
        lab: Any = importlib.import_module("pymeshlab")
    except ImportError:
        raise InputError(
            "the deep inspection needs pymeshlab, which is GPL: pip install 'pneutouch[inspect]'"
        ) from None
    findings = [*_topology(lab, body), *_intersections(lab, body), *_slivers(body)]
    if solid is not None:
        findings += _deviation(lab, body, solid.mesh(tolerance / _FINER), tolerance)
    return findings


def _loaded(lab: Any, *bodies: Body) -> Any:
    meshes = lab.MeshSet()
    for body in bodies:
        meshes.add_mesh(lab.Mesh(np.ascontiguousarray(body.vertices), body.triangles.astype(np.int32)), body.name)
    return meshes


def _finding(severity: Severity, body: Body, text: str, fix: str, excess: Excess) -> Finding:
    return Finding("deep", severity, body.name, text, fix, _SOURCE, None, excess)


def _topology(lab: Any, body: Body) -> list[Finding]:
    measures = _loaded(lab, body).get_topological_measures()
    wrong = {
        "open edges": measures["boundary_edges"],
        "non-manifold edges": measures["non_two_manifold_edges"],
        "non-manifold vertices": measures["non_two_manifold_vertices"],
        "loose vertices": measures["unreferenced_vertices"],
    }
    return [
        _finding("error", body, f"{count} {what}", "mend the mesh where it comes from", Excess(count, 0, what))
        for what, count in wrong.items()
        if count
    ]


def _intersections(lab: Any, body: Body) -> list[Finding]:
    meshes = _loaded(lab, body)
    meshes.compute_selection_by_self_intersections_per_face()
    count = int(meshes.current_mesh().selected_face_number())
    if not count:
        return []
    fix = "cut the shells from one another before meshing"
    return [_finding("error", body, f"{count} triangles cross one another", fix, Excess(count, 0, "triangles"))]


def _slivers(body: Body) -> list[Finding]:
    least = least_angles(body)
    share = float((least < _SLIVER).mean())
    if share <= _MANY:
        return []
    low, middle = np.percentile(least, [1, 50])
    text = (
        f"{share:.0%} of the triangles have an angle below {_SLIVER:g} degree; a hundredth of them is below {low:.2f}, "
        f"half below {middle:.0f} degrees"
    )
    return [_finding("note", body, text, "cut long faces once or twice across", Excess(share, _MANY, ""))]


def least_angles(body: Body) -> Array:
    """Least angle of each triangle, (m,), degrees."""
    a, b, c = np.moveaxis(body.corners, 1, 0)
    angles = []
    for u, v in ((b - a, c - a), (c - b, a - b), (a - c, b - c)):
        sine, cosine = np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v)
        angles.append(np.degrees(np.arctan2(sine, cosine)))
    return np.asarray(np.min(angles, axis=0))


def _deviation(lab: Any, body: Body, fine: Body, tolerance: float) -> list[Finding]:
    """Hausdorff distance in both directions: each mesh sampled on vertices, edges and faces against the other."""
    meshes = _loaded(lab, body, fine)
    number = max(20_000, 4 * len(fine.triangles))
    directions = [
        meshes.get_hausdorff_distance(
            sampledmesh=one, targetmesh=1 - one, sampleedge=True, sampleface=True, samplenum=number
        )
        for one in (0, 1)
    ]
    worst = max(float(direction["max"]) for direction in directions)
    allowed = tolerance * (1 + 1 / _FINER)
    if worst <= allowed:
        return []
    text = f"{worst / UM:.0f} um from a mesh {_FINER:g} times finer; {tolerance / UM:g} um were required"
    return [_finding("warning", body, text, f"mesh it within {tolerance:g} mm", Excess(worst, allowed, "mm"))]
