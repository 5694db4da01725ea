"""What a print takes, on shapes whose figures can be worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.catalogue import load_scene
from pneutouch.evaluation.subject import subject_of
from pneutouch.parts import assemble
from pneutouch.printability import PrintSubject
from pneutouch.printability.estimate import estimate
from pneutouch.printability.rulebook import mould_subject
from tests.printability.gallery import box, item, printer


def table():
    return box(20, 20, 2, (0, 0, 8)) + box(4, 4, 9) + box(4, 4, 9, (16, 16, 0))


def test_a_table_on_a_polyjet_printer():
    (job,) = estimate(PrintSubject((item(table()),)))
    volume = 20 * 20 * 2 + 2 * 4 * 4 * 8
    assert job.items[0].volume_mL == pytest.approx(volume / 1e3)
    assert job.resins_mL == {"VeroClear": pytest.approx(volume / 1e3)}
    assert job.support_mL == pytest.approx((400 - 32) * 8 / 1e3, rel=0.06)
    assert job.layers == 625
    assert job.swaths == 1
    assert 60 * job.time_min == pytest.approx(
        625 * printer().mode_for(item(box(1, 1, 1)).body.material).layer_seconds.nominal
    )


def test_lying_down_takes_fewer_layers():
    upright, lying = (
        estimate(PrintSubject((item(box(10, 10, 60), up=up),)))[0] for up in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    )
    assert (upright.layers, lying.layers) == (3750, 625)
    assert upright.size_mm == pytest.approx((10, 10, 60))


def test_a_wide_job_takes_more_swaths():
    (job,) = estimate(PrintSubject((item(box(120, 120, 2)),)))
    assert job.swaths == 3
    seconds = printer().mode_for(item(box(1, 1, 1)).body.material).layer_seconds.nominal
    assert 60 * job.time_min == pytest.approx(job.layers * 3 * seconds)


def test_filament_is_laid_down_by_volume_and_supported_under_overhangs():
    (job,) = estimate(PrintSubject((item(table(), resin="ABS", machine="abs-filament"),)))
    assert 0 < job.support_mL < (400 - 32) * 8 / 1e3
    machine = printer("abs-filament")
    mode = machine.mode[0]
    volume = 1e3 * (job.items[0].volume_mL + job.support_mL)
    assert 60 * job.time_min == pytest.approx(
        volume / machine.deposition_mm3_per_s.nominal + job.layers * mode.layer_seconds.nominal
    )
    (flat,) = estimate(PrintSubject((item(box(20, 20, 5), resin="ABS", machine="abs-filament"),)))
    assert flat.support_mL == 0.0


def test_a_profile_without_times_gives_no_time_and_says_so():
    plain = item(box(10, 10, 10))
    silent = plain.mode.model_copy(update={"layer_seconds": None})
    (job,) = estimate(PrintSubject((item(box(10, 10, 10)).__class__(plain.body, plain.printer, silent),)))
    assert job.time_min is None
    assert any("layer_seconds" in note for note in job.assumptions)


def test_the_support_that_a_printers_own_program_lays_is_not_known():
    (job,) = estimate(PrintSubject((item(table(), resin="Elastic50A", machine="form4"),)))
    assert job.support_mL is None and job.items[0].volume_mL == pytest.approx((20 * 20 * 2 + 2 * 4 * 4 * 8) / 1e3)


def test_the_resins_of_a_digital_material_are_added_up():
    (job,) = estimate(PrintSubject((item(box(10, 10, 10), resin="FLX9970"),)))
    assert job.resins_mL == {"TangoPlus + VeroClear": pytest.approx(1.0)}
    assert any("no ratios" in note for note in job.assumptions)


def test_bodies_of_one_job_are_one_estimate_and_it_is_json():
    pair = (item(box(10, 10, 10), "a", job="tray"), item(box(10, 10, 10, (0, 0, 10)), "b", "FLX9970", job="tray"))
    (job,) = estimate(PrintSubject(pair))
    assert job.size_mm == (10, 10, 20)
    assert [entry.name for entry in job.items] == ["a", "b"]
    assert job.support_mL == 0.0


def test_the_space_under_a_table_is_that_of_its_top_without_the_legs():
    standing = item(table()).body
    assert standing.under_ceilings(1.0) == pytest.approx((20 * 20 - 2 * 4 * 4) * 8)
    assert standing.under_ceilings(-1.0) == pytest.approx(0.0, abs=1e-9)


def test_a_mould_is_estimated_with_its_infill():
    mould = assemble(load_scene("cast-dome")).mould
    shares = {
        job.job: job.items[0].mass_g / solid.mass
        for job, solid in zip(estimate(mould_subject(mould)), mould.solids, strict=True)
    }
    # A thick part is light, a thin one all outlines.
    assert 0.3 < shares["mould-cap"] < 0.6 and shares["mould-ring"] == pytest.approx(1.0)


@pytest.mark.parametrize("seat", ["glued-flange", "clamped-flange-M2"])
@pytest.mark.parametrize("port", ["barb-4x2.5", "push-in-4", "thread-M5", "luer-female"])
def test_a_filament_connector_stands_on_its_seat_and_needs_little_support(seat, port):
    """Seat up it would stand on the few mm2 of its port, under 1,500 mm2 of ceiling."""
    assembly = assemble(load_scene("paper-dome", {"connector.seat": seat, "connector.port": port}))
    assert not assembly.stands_up("connector")
    turned = subject_of(assembly)
    upright = replace(turned, items=tuple(replace(item, up=(0.0, 0.0, 1.0)) for item in turned.items))
    needed, other = ({job.job: job.support_mL for job in estimate(each)} for each in (turned, upright))
    assert needed["connector"] < 0.7 * other["connector"]
    body = next(body for body in assembly.bodies if body.name == "connector")
    corners = body.vertices[body.triangles]
    flat = corners[corners[:, :, 2].min(axis=1) > body.bounds[1][2] - 1e-6]
    on_bed = 0.5 * np.linalg.norm(np.cross(flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]), axis=1).sum()
    assert on_bed > 200.0
