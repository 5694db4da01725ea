"""The finite elements that the reduced model is measured against, and the error that docs/background/texture.md states."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.strip import AGILUS, Row, Strip, harmonic

from pneutouch.texture.substrate import BarRow, MatrixLayer, amplitude, bonded_layer, patch_filter

MATRIX = MatrixLayer(8.0, *AGILUS)


def test_plane_strain_layer_is_the_exact_one():
    length, half = 36.0, 2.6
    k = 2 * np.pi * np.arange(1, 600) / length
    # The wave of k = 0 is the oedometer's.
    exact = 8.0 * (1 - 2 * AGILUS[1]) / (2 * AGILUS[0] * (1 - AGILUS[1])) / length
    exact += 2 * float(np.sum(np.sinc(k * half / np.pi) ** 2 * bonded_layer(k, 8.0, *AGILUS))) / length
    errors = [abs(Strip(length, 8.0, c).strip_compliance(np.array([1.0]), half)[0] / exact - 1) for c in (1.0, 0.5)]
    assert errors[1] < 3e-4 and errors[1] < 0.5 * errors[0]


def test_homogeneous_strip_has_no_pattern_and_stiff_bars_one():
    at = np.arange(4) * 1.5
    assert abs(harmonic(Strip(24.0, 8.0, 0.5).strip_compliance(at, 2.0))) < 1e-6
    # Bars as soft as the matrix are no bars.
    soft = Strip(24.0, 8.0, 0.5, (Row(6.0, 3.0, 1.5, 2.0),), bars=AGILUS)
    assert abs(harmonic(soft.strip_compliance(1.5 + at, 2.0))) < 1e-6
    # Bars 4,000 times as stiff are as good as rigid.
    found = [
        harmonic(Strip(24.0, 8.0, 0.5, (Row(6.0, 3.0, 1.5, 2.0),), bars=(mu, 0.35)).strip_compliance(1.5 + at, 2.0))
        for mu in (926.0, 1e5)
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-3) and found[0] < 0


def test_work_is_reciprocal():
    strip = Strip(24.0, 8.0, 0.5, (Row(6.0, 3.0, 1.5, 1.0),))
    one, other = (strip.load(x, 1.5, np.ones_like) for x in (3.0, 7.3))
    works = strip.solved(0.0, np.stack([one, other, one + other, one - other], axis=1))
    # (a + b)A(a + b) + (a - b)A(a - b) = 2 aAa + 2 bAb holds for every symmetric A.
    assert works[2] + works[3] == pytest.approx(2 * (works[0] + works[1]), rel=1e-9)
    assert (works > 0).all()


@pytest.mark.slow
def test_disc_on_a_layer_is_the_exact_one():
    # Periods across and along the path take up to 5 %.
    for radius in (2.0, 3.0):
        found = Strip(36.0, 8.0, 0.5).disc_compliance(np.array([1.0]), radius)[0]
        assert found == pytest.approx(float(MATRIX.compliance(np.array(radius))), rel=0.06)


@pytest.mark.slow
@pytest.mark.parametrize(("pitch", "radius", "low", "high"), [(6.0, 2.33, 0.9, 1.6), (3.0, 2.33, 1.5, 5.5)])
def test_reduced_model_errs_no_more_than_its_page_says(pitch, radius, low, high):
    width, height = {3.0: (1.5, 1.0), 6.0: (3.0, 1.5)}[pitch]
    found = []
    for depth in (0.0, 1.0, 2.0, 3.0):
        strip = Strip(24.0, 8.0, 0.5, (Row(pitch, width, height, depth),))
        fe = harmonic(strip.disc_compliance(width / 2 + pitch * np.arange(8) / 8, radius))
        bars = BarRow("", pitch, width, height, depth, np.array([[0.0, width]]))
        found.append(-float(amplitude(MATRIX, bars, np.array(radius))) / fe)
    assert low < min(found) and max(found) < high, found
    # One sign: a bar under the middle counts as the patch filter says.
    assert np.sign(float(patch_filter(np.array(2 * np.pi / pitch), radius))) == (1.0 if pitch > 5 else -1.0)
