"""The dither: even in every cube, without pattern, the same everywhere, soft at every face and yet not short."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.voxels import FRACTIONS, SHAPE, blue_noise, radial, white_noise, worst_cube
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import binary_erosion, generate_binary_structure

from pneutouch.export.voxels.raster import ResinBlend, SkinCompensation, interior
from pneutouch.export.voxels.slices import BLOCK, VoxelSlicer, thresholds, void_and_cluster
from tests.export.voxels.small import ball, block, job, material

PITCH = (25.4 / 600, 25.4 / 300, 0.027)


def test_ranks_are_a_permutation_and_follow_from_the_seed():
    shape, pitch = (8, 6, 10), (0.027, 0.085, 0.042)
    ranks = void_and_cluster(shape, pitch, 3)
    assert sorted(ranks.ravel()) == list(range(480))
    assert np.array_equal(ranks, void_and_cluster(shape, pitch, 3))
    assert not np.array_equal(ranks, void_and_cluster(shape, pitch, 4))


def test_ranks_are_those_of_every_machine():
    """Whole-number energies: a few ranks fixed for ever."""
    ranks = void_and_cluster((4, 4, 4), (1.0, 1.0, 1.0), 1).ravel()
    assert int((ranks * np.arange(64)).sum()) == 65481


@pytest.mark.parametrize("fraction", FRACTIONS)
def test_every_cube_of_a_millimetre_holds_the_fraction(fraction):
    found = blue_noise(fraction)
    assert worst_cube(found, fraction) <= 0.005
    assert abs(found.mean() - fraction) <= 5e-4
    assert worst_cube(white_noise(fraction), fraction) > 0.005


@pytest.mark.parametrize("fraction", [0.05, 0.25, 0.5, 0.9])
def test_no_clumps(fraction):
    """Waves longer than 0.5 mm carry a tenth of white noise's power or less."""
    low, high = radial(blue_noise(fraction), np.array([0.0, 2.0, 12.0]))
    assert low < 0.1
    assert high > 0.3


@given(st.floats(0, 1), st.floats(0, 1))
def test_more_is_more_everywhere(one, other):
    """No voxel loses its droplet when the fraction grows: a grade has no seams."""
    noise = thresholds(PITCH, 1).values
    low, high = sorted((one, other))
    assert not ((low > noise) & ~(high > noise)).any()
    assert abs((low > noise).mean() - low) <= 0.5 / noise.size + 1e-12


def test_nothing_and_everything():
    noise = thresholds(PITCH, 1).values
    assert not (noise < 0.0).any()
    assert (noise < 1.0).all()


def test_skin_is_what_six_neighbours_leave():
    rng = np.random.default_rng(0)
    box = rng.random((9, 12, 14)) < 0.9
    padded = np.pad(box, 1)
    found = np.array([interior(padded[k], padded[k + 1], padded[k + 2]) for k in range(9)])
    expected = binary_erosion(padded, generate_binary_structure(3, 1))
    assert np.array_equal(found[:, 1:-1, 1:-1], expected[1:-1, 1:-1, 1:-1])


def test_what_the_skin_lacks_is_made_up_for_to_the_last_droplet():
    inside = np.zeros((40, 30, 50), bool)
    inside[3:37, 4:27, 5:44] = True
    inner = binary_erosion(inside)
    share = np.where(inside, np.linspace(0.1, 0.6, 50), 0.0).astype(np.float32)

    def parts(number):
        return (inner[number], np.where(inner[number], 0, share[number])) if 0 <= number < 40 else None

    more = SkinCompensation(parts, PITCH, 0.12)
    added = sum(float(more.layer(k)[inner[k]].sum(dtype=float)) for k in range(40))
    assert added == pytest.approx(float(share[inside & ~inner].sum(dtype=float)), rel=1e-5)


def stack(slicer):
    return np.array(list(slicer))


def even(fraction):
    return ResinBlend(("TangoPlus", "VeroClear"), lambda r, z: np.full(np.shape(r), fraction), fraction)


@pytest.mark.parametrize("fraction", [0.02, 0.25, 0.5, 0.65])
def test_a_mixed_disc_is_soft_at_every_face_and_holds_its_fraction(fraction):
    slicer = VoxelSlicer(job((block(0, 1.5, 2.0), even(fraction))))
    found = stack(slicer)
    soft, stiff = found == 1, found == 2
    inner = binary_erosion(soft | stiff)
    assert not (stiff & ~inner).any()
    tally = slicer.tallies["block"]
    assert tally.realised == stiff.sum()
    assert tally.voxels == (soft | stiff).sum()
    assert tally.skin == (soft | stiff).sum() - inner.sum()
    assert tally.given == pytest.approx(tally.requested, rel=1e-5)
    assert abs(tally.realised / tally.voxels - fraction) < 1e-3
    assert tally.worst < 0.005 and tally.cubes > 5


def test_a_wall_too_thin_for_its_fraction_is_said_to_fall_short():
    from pneutouch.export.voxels.stack import shortfalls

    thin = job((block(0, 0.14, 2.0), even(0.9)))
    slicer = VoxelSlicer(thin)
    stack(slicer)
    (line,) = shortfalls(thin, slicer)
    assert line.startswith("block: ") and "90.00% requested" in line
    assert slicer.tallies["block"].given < 0.8 * slicer.tallies["block"].requested
    full = job((block(0, 1.5, 2.0), even(0.3)))
    slicer = VoxelSlicer(full)
    stack(slicer)
    assert shortfalls(full, slicer) == []


def test_a_grade_is_followed_along_the_height():
    rising = ResinBlend(("TangoPlus", "VeroClear"), lambda r, z: 0.1 + 0.2 * z, 0.7)
    found = stack(VoxelSlicer(job((block(0, 3.0, 2.0), rising))))
    for low in (0.3, 1.0, 2.0):
        part = found[round(low / 0.027) : round((low + 0.5) / 0.027)]
        share = (part == 2).sum() / (part > 0).sum()
        assert share == pytest.approx(0.1 + 0.2 * (low + 0.25), abs=0.004)


def test_bodies_touch_without_a_gap_and_without_overlap():
    lower, upper = block(0, 1.0, 2.0, "lower"), block(1.0, 2.0, 2.0, "upper", "VeroClear")
    slicer = VoxelSlicer(job((lower, even(0.2)), (upper, ResinBlend(("VeroClear",)))))
    found = stack(slicer)
    alone = stack(VoxelSlicer(job((block(0, 2.0, 2.0), ResinBlend(("TangoPlus",))))))
    assert np.array_equal(found > 0, alone > 0)
    assert sum(tally.voxels for tally in slicer.tallies.values()) == sum(slicer.counts.values()) == (alone > 0).sum()


def test_turned_over_the_stack_is_the_same_turned():
    from pneutouch.body import Solid

    cap = Solid("cap", "coupon", material("TangoPlus"), ball(1.7), adds=())
    for solid in (block(0.2, 1.6, 1.5), cap):
        up = stack(VoxelSlicer(job((solid, ResinBlend(("TangoPlus",))))))
        down = stack(VoxelSlicer(job((solid, ResinBlend(("TangoPlus",))), upright=False)))
        assert up.shape == down.shape
        assert (up.sum() - down.sum()) ** 2 <= (0.02 * up.sum()) ** 2
        assert np.array_equal(up.any(axis=(0, 1)), down.any(axis=(0, 1)))


@given(st.floats(0.8, 3.0))
def test_a_ball_keeps_its_volume_on_unequal_pixels(radius):
    from pneutouch.body import Solid

    solid = Solid("ball", "coupon", material("TangoPlus"), ball(radius))
    drawn = job((solid, ResinBlend(("TangoPlus",))), layer_um=54)
    count = int((stack(VoxelSlicer(drawn)) > 0).sum())
    assert count * drawn.raster.voxel == pytest.approx(solid.volume, rel=0.01 / radius)


def test_a_window_of_the_noise_is_that_part_of_it():
    noise = thresholds(PITCH, 1)
    whole = noise.layer(5, slice(0, SHAPE[1]), slice(0, SHAPE[2]))
    assert np.array_equal(noise.layer(5, slice(7, 40), slice(9, 100)), whole[7:40, 9:100])


def test_blocks_do_not_repeat():
    """Side by side as it is the block would come again: one wave of its size would hold a thousand times white noise's power."""
    noise, (depth, height, width) = thresholds(PITCH, 1), BLOCK
    shape = (2 * depth, 8 * height, 8 * width)
    rolled = np.array([noise.layer(k, slice(0, shape[1]), slice(0, shape[2])) for k in range(shape[0])]) < 0.25

    def peak(found):
        power = np.abs(np.fft.rfftn(found - found.mean())) ** 2 / found.size / (0.25 * 0.75)
        return power.max()

    plain = np.tile(noise.values < 0.25, (2, 8, 8))
    assert peak(plain) > 1000
    assert peak(rolled) < 100
    assert rolled.mean() == pytest.approx(0.25, abs=1e-4)
