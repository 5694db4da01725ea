"""The greatest stretch on the faces of a wall that is no body of revolution."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.harmonic.operators import FieldGroup, FieldOperator
from pneutouch.mechanics.solid.kinematics import F_RR, F_RZ, HOOP, RADIAL
from pneutouch.mechanics.solid.stress import StrainProbe


class HarmonicProbe:
    """Stretches at the stations of a `StrainProbe` and at both sides of the plane of symmetry and between; where there
    are two planes, from one to the other."""

    def __init__(self, model: HarmonicModel, probe: StrainProbe) -> None:
        cells = model.mesh.cells
        waves, span = model.harmonics.waves, np.pi / model.harmonics.stride
        angles = np.linspace(0.0, span, 2 * waves + 1) if waves else np.zeros(1)
        self._values, self._turned = model.harmonics.values(angles), model.harmonics.turned(angles)
        self._stations = self._gradients(probe.operator.reshape(len(cells), -1, 5, probe.operator.shape[-1]), cells)
        self._edges = self._gradients(probe.edge_operator[:, None], cells[probe.edge_cells])
        self._far = probe.far

    def _gradients(self, strains: Array, cells: Index) -> FieldOperator:
        shapes = (strains[:, :, row, RADIAL] for row in (F_RR, F_RZ, HOOP))
        rows = (self._values, self._values, self._turned)
        groups = [FieldGroup(shape, row) for shape, row in zip(shapes, rows, strict=True)]
        return FieldOperator(groups, cells, np.ones((int(cells.max()) + 1, self._values.shape[2])))

    def greatest_stretch(self, x: Array) -> float:
        """Greatest principal stretch over both faces, away from the clamp, for coefficients x (n_nodes, columns)."""
        stations = self._stations.fields(x)
        far = stations.reshape(-1, *stations.shape[2:])[self._far].reshape(-1, 3, 3)
        f = np.concatenate([far, self._edges.fields(x).reshape(-1, 3, 3)])
        # The greatest singular value by the greatest eigenvalue of the right Cauchy-Green tensor.
        return float(np.sqrt(np.linalg.eigvalsh(np.matmul(f, np.swapaxes(f, 1, 2)))[:, -1].max()))
