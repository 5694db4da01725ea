"""How a sensor is made: a cast one by weighing, pouring and curing, a printed one as before."""

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.parts import assemble
from pneutouch.parts.mould import silicone_batch
from pneutouch.report.print_sheet import making, making_title


def steps(name, changes=None):
    assembly = assemble(load_scene(name, changes))
    pour = None if assembly.mould is None else silicone_batch(assembly.mould)
    return pour, making(assembly.scene, pour)


def test_a_cast_dome_is_weighed_by_its_ratio_poured_cured_and_peeled():
    pour, lines = steps("cast-dome")
    assert pour.parts_g == pytest.approx((pour.mass_g / 2, pour.mass_g / 2))
    text = " ".join(lines)
    assert f"{pour.parts_g[0]:.2f} g of part A and {pour.parts_g[1]:.2f} g of part B" in text
    order = [text.index(word) for word in ("Release agent", "Weigh", "Degas", "Pour", "Cure", "Demould", "screws")]
    assert order == sorted(order)
    assert "latex" in text and "water jet" not in text and "Aim the jet" not in text and "support" not in lines[0]
    assert making_title(pour) == "How to make it"


def test_a_ring_is_printed_put_into_the_mould_cast_around_and_glued():
    _, lines = steps("cast-dome", {"connector.seat": "cast-ring", "mould.cavities": 4})
    text = " ".join(lines)
    order = [
        text.index(word) for word in ("make 4", "degrease", "into the mould's ring", "Pour", "straight off", "epoxy")
    ]
    assert order == sorted(order)
    assert "peel the flange" not in text and "0.40 mm a side" in text


def test_a_printed_dome_has_nothing_to_pour():
    pour, lines = steps("paper-dome")
    assert pour is None and making_title(pour) == "Material and print"
    assert "flexible adhesive that wets both materials" in " ".join(lines) and "Weigh" not in " ".join(lines)


@pytest.mark.parametrize(
    ("name", "changes", "glue"),
    [
        ("cast-dome", {"connector.seat": "glued-flange"}, "silicone adhesive (such as Sil-Poxy)"),
        ("paper-dome", {"connector.glue": "cyanoacrylate"}, "cyanoacrylate"),
    ],
)
def test_the_glue_is_that_of_the_pair_of_materials(name, changes, glue):
    _, lines = steps(name, changes)
    assert f"fill the gap with {glue};" in " ".join(lines)
