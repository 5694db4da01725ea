"""Open moulds of coupons: the cavity is the coupon at the mould's size, up to the plane it is struck off at."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.body import Bore, Solid
from pneutouch.parts.coupons import COUPONS, CouponContext
from pneutouch.parts.mould.size import FLOOR, WALL, open_mould
from pneutouch.spec.material import Material


@pytest.mark.parametrize("name", ["puck", "dumbbell"])
def test_what_the_mould_leaves_of_its_block_is_the_coupon(library, name):
    materials = library.all("materials", Material)
    (coupon,) = COUPONS[name].draw(CouponContext(materials["DragonSkin20"]))
    made = open_mould(coupon, materials["ABS"], 1.01)
    mesh = made.mesh(0.02)
    low, high = mesh.bounds
    block = float(np.prod(high - low))
    assert mesh.is_closed() and mesh.volume == pytest.approx(made.volume, rel=1e-3)
    assert block - made.volume == pytest.approx(1.01**3 * coupon.volume, rel=1e-9)
    size = np.ptp(coupon.mesh(0.02).bounds, axis=0)
    assert high - low == pytest.approx(1.01 * size + [2 * WALL, 2 * WALL, FLOOR], abs=0.05)
    # Open at the top, closed below: a ray down the middle meets the floor's two faces.
    hits = mesh.manifold().ray_cast((0.01, 0.02, high[2] + 1), (0.01, 0.02, low[2] - 1))
    assert len(hits) == 2
    assert made.material.title == materials["ABS"].title


def test_a_coupon_with_holes_has_no_open_mould(library):
    materials = library.all("materials", Material)
    (puck,) = COUPONS["puck"].draw(CouponContext(materials["DragonSkin20"]))
    holed = Solid("puck", "coupon", puck.material, puck.base, bores=(Bore(0.0, 0.0, 1.0, 0.0, 3.0),))
    with pytest.raises(TypeError, match="no plain body"):
        open_mould(holed, materials["ABS"], 1.0)
