"""Linear maps from nodal coefficients to fields at points of the meridian and angles around the axis."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index


class FieldGroup(NamedTuple):
    """Fields that share one shape in the meridian: ``shape`` (n_blocks, n_points, n_nodes), or without its first axis
    where all blocks share it, and ``rows`` (n_angles, n_fields, columns) of the coefficients around the axis."""

    shape: Array
    rows: Array


class FieldOperator:
    """Fields at the points and angles of cells or edges, and what belongs to nodes of what belongs to fields.

    ``nodes`` (n_blocks, n_nodes); ``signs`` (n_mesh_nodes, columns) turns coefficients that are tied to the negative of
    another one, in forces and stiffnesses.
    """

    def __init__(self, groups: list[FieldGroup], nodes: Index, signs: Array) -> None:
        self._nodes, self._groups = nodes, groups
        self.columns = groups[0].rows.shape[2]
        self._gemm = [np.ascontiguousarray(rows.reshape(-1, self.columns)) for _, rows in groups]
        self._spans = np.cumsum([0, *(rows.shape[1] for _, rows in groups)])
        shape = np.stack([np.broadcast_to(s, (nodes.shape[0], *s.shape[-2:])) for s, _ in groups], axis=2)
        self._count = shape.shape[1], groups[0].rows.shape[0]
        self._shape = np.ascontiguousarray(shape)
        flat = shape.reshape(shape.shape[0], -1, shape.shape[3])
        self._wide = np.ascontiguousarray(np.swapaxes(flat, 1, 2))
        self._flat = np.ascontiguousarray(flat)
        sign = signs[nodes].reshape(nodes.shape[0], -1)
        self._turned = np.flatnonzero((sign < 0.0).any(axis=1))
        self._signs = sign[self._turned]

    def fields(self, x: Array) -> Array:
        """Fields (n_blocks, n_points, n_angles, n_fields) of coefficients x (n_mesh_nodes, columns)."""
        points, angles = self._count
        blocks = self._nodes.shape[0]
        along = np.matmul(self._flat, x[self._nodes]).reshape(blocks, points, len(self._groups), -1)
        parts = [
            (along[:, :, k].reshape(blocks * points, -1) @ rows.T).reshape(blocks, points, angles, -1)
            for k, rows in enumerate(self._gemm)
        ]
        return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=3)

    def forces(self, by_field: Array) -> Array:
        """Derivative by the coefficients of the nodes, (n_blocks, n_nodes columns), of one by the fields."""
        blocks, points = by_field.shape[:2]
        parts = [
            by_field[..., a:b].reshape(blocks * points, -1) @ rows
            for rows, a, b in zip(self._gemm, self._spans, self._spans[1:], strict=False)
        ]
        along = np.stack([part.reshape(blocks, points, -1) for part in parts], axis=2)
        out = np.matmul(self._wide, along.reshape(blocks, -1, self.columns)).reshape(blocks, -1)
        out[self._turned] *= self._signs
        return np.asarray(out)

    def stiffness(self, by_fields: Array) -> Array:
        """Second derivative by the coefficients, (n_blocks, n, n) with n nodes times columns, of one by the fields,
        (n_blocks, n_points, n_angles, n_fields, n_fields)."""
        blocks, points = by_fields.shape[:2]
        groups, width = len(self._groups), self.columns
        inner = np.empty((blocks, points, groups, width, width, groups))
        spans = list(zip(self._spans, self._spans[1:], strict=False))
        for k, (c, d) in enumerate(spans):
            half = np.matmul(by_fields[..., c:d], self._groups[k].rows)
            for i, (a, b) in enumerate(spans[: k + 1]):
                left = half[..., a:b, :].reshape(blocks, points, -1, width)
                block = np.matmul(self._gemm[i].T, left)
                inner[:, :, i, :, :, k] = block
                if i != k:
                    inner[:, :, k, :, :, i] = np.swapaxes(block, 2, 3)
        return self._to_nodes(inner)

    def _to_nodes(self, inner: Array) -> Array:
        """Blocks by nodes of blocks by shape derivatives, (n_blocks, n_points, groups, columns, columns, groups)."""
        blocks, points, groups, width = inner.shape[:4]
        nodes = self._nodes.shape[1]
        right = np.matmul(inner.reshape(blocks, points, -1, groups), self._shape)
        both = np.matmul(self._wide, right.reshape(blocks, points * groups, -1))
        out = both.reshape(blocks, nodes, width, width, nodes).swapaxes(3, 4).reshape(blocks, nodes * width, -1)
        if self._turned.size:
            out[self._turned] *= self._signs[:, :, None] * self._signs[:, None, :]
        return np.asarray(out)
