"""State of the points (touching, sticking, sliding) in the linear model of a step with friction, found one point after
another.

The tractions are continuous and linear in pieces. From the start the residual of the model shrinks evenly along a
straight line in every piece; where the line leaves a piece, one point touches, leaves, sticks or slides, and the
stiffness changes by one rank (Katzenelson 1965, Bell Syst. Tech. J. 44, 1605,
doi:10.1002/j.1538-7305.1965.tb04195.x). All is kept by points: how their tractions follow from loads on them.
"""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.friction_status import PointStatus, PointTractions

#: Changes of a point on average, beyond which the search is given up.
_MOST = 3
#: A change that leaves less of the stiffness than this share turns the line back.
_FLAT = 1.0e-9


class PiecewiseLine:
    """The line from the tractions ``begun`` towards ``ended``, those of the linear model of a status; points (n,) each.

    response: (2 n, 2 n) how the tractions, normal first, follow from loads of unit tractions, that status kept; it is
    overwritten.  areas: (2, n) of a point over the stiffness of its springs, along the normal and the surface.  grip:
    (n,) the largest traction along the surface over the normal one, or that traction itself where ``held``.
    """

    def __init__(
        self,
        status: PointStatus,
        begun: PointTractions,
        ended: PointTractions,
        response: Array,
        areas: Array,
        grip: Array,
        held: bool,
    ) -> None:
        self._response, self._areas, self._grip, self._held = response, areas, grip, held
        self._at, self._move = (np.concatenate([one.normal, one.trial]) for one in (begun, ended))
        self._move -= self._at
        n = grip.size
        self._touching, self._bearing, self._sign = status.touching.copy(), status.bearing.copy(), status.sign.copy()
        # Three margins a point, each (by the normal traction, by the trial one, constant): the piece ends where one of
        # them falls to nothing.
        self._by_normal, self._by_trial, self._free = np.zeros((3, n)), np.zeros((3, n)), np.full((3, n), np.inf)
        for j in range(n):
            self._bound(j)

    def status(self) -> PointStatus | None:
        """The status at the end of the line; None if it turns back or goes through too many pieces."""
        n = self._grip.size
        for _ in range(_MOST * n):
            margin = self._by_normal * self._at[:n] + self._by_trial * self._at[n:] + self._free
            rate = self._by_normal * self._move[:n] + self._by_trial * self._move[n:]
            share = np.full(margin.shape, np.inf)
            np.divide(np.maximum(margin, 0.0), -rate, out=share, where=rate < 0.0)
            k = int(share.argmin())
            first = float(share.flat[k])
            if first >= 1.0:
                return PointStatus(self._touching, self._bearing, self._sign)
            self._at += first * self._move
            self._move *= 1.0 - first
            if not self._cross(k // n, k % n):
                return None
        return None

    def _cross(self, side: int, j: int) -> bool:
        """Go into the piece beyond a margin of a point; False where the line turns back there."""
        n = self._grip.size
        trial, grip, held = float(self._at[n + j]), float(self._grip[j]), self._held
        across, along = self._areas[:, j]
        if side == 0:
            on = -1.0 if self._touching[j] else 1.0
            self._touching[j] = on > 0.0
            if held:
                push, gap = (on * across, 0.0), (1.0, 0.0)
            else:
                self._bearing[j] = self._touching[j]
                sign = self._sign[j] if on < 0.0 else (1.0 if trial >= 0.0 else -1.0)
                self._sign[j] = sign if on > 0.0 else 0.0
                push, gap = (on * across, on * along * sign * grip), (1.0, 0.0)
        else:
            slides = self._sign[j] == 0.0
            sign = (1.0 if side == 1 else -1.0) if slides else float(self._sign[j])
            self._sign[j] = sign if slides else 0.0
            on = -1.0 if slides else 1.0
            push, gap = (0.0, along), (0.0 if held else -on * sign * grip, on)
        self._bound(j)
        return self._change(j, push, gap)

    def _change(self, j: int, push: tuple[float, float], gap: tuple[float, float]) -> bool:
        """Change the stiffness by the product of a load on a point and a combination of its tractions."""
        n, response = self._grip.size, self._response
        column = push[0] * response[:, j] + push[1] * response[:, n + j]
        row = gap[0] * response[j] + gap[1] * response[n + j]
        left = 1.0 + gap[0] * float(column[j]) + gap[1] * float(column[n + j])
        if not left > _FLAT:
            return False
        column /= left
        self._move -= column * (gap[0] * float(self._move[j]) + gap[1] * float(self._move[n + j]))
        response -= np.multiply.outer(column, row)
        return True

    def _bound(self, j: int) -> None:
        """The margins of a point in its piece."""
        grip, held, sign = float(self._grip[j]), self._held, float(self._sign[j])
        touching, bearing = bool(self._touching[j]), bool(self._bearing[j])
        sticks = bearing and sign == 0.0
        by_cap, cap = (0.0, grip) if held else (grip, 0.0)
        none = (0.0, 0.0, np.inf)
        # A point that sticks slides before it leaves, unless its largest traction is held.
        first = (1.0 if touching else -1.0, 0.0, 0.0) if held or not sticks else none
        second, third = none, none
        if sticks:
            second, third = (by_cap, -1.0, cap), (by_cap, 1.0, cap)
        elif sign:
            second = (-by_cap, sign, -cap)
        for k, margin in enumerate((first, second, third)):
            self._by_normal[k, j], self._by_trial[k, j], self._free[k, j] = margin
