"""Components, pieces and distances are those of SciPy, which the print rules do not load."""

import subprocess
import sys

import numpy as np
import pytest
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pneutouch.printability.measure.joined import components, distances, grown, largest_pieces, outside

SHAPES = [(7, 9, 5), (40, 30, 20), (3, 4, 200)]
SHARES = [0.0, 0.05, 0.3, 0.6, 0.7, 0.95]


def space(shape: tuple[int, int, int], share: float) -> np.ndarray:
    """Cubes at random, a share of them in the space."""
    return np.random.default_rng(7).random(shape) < share


@pytest.mark.parametrize("nodes", [1, 6, 1000])
def test_components_are_numbered_by_their_first_nodes(nodes):
    one, other = np.random.default_rng(nodes).integers(0, nodes, (2, nodes * 2 // 3))
    graph = coo_array((np.ones(len(one)), (one, other)), shape=(nodes, nodes))
    assert (components(nodes, one, other) == connected_components(graph, directed=False)[1]).all()


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("share", SHARES)
def test_a_space_falls_into_the_same_pieces(shape, share):
    cubes = space(shape, share)
    number, count = ndimage.label(cubes)
    edge = np.ones(shape, bool)
    edge[1:-1, 1:-1, 1:-1] = False
    assert (outside(cubes) == (np.isin(number, np.unique(number[edge])) & cubes)).all()
    size = np.bincount(number.ravel(), minlength=count + 1)[1:]
    expected = [number == 1 + k for k in np.argsort(-size, kind="stable")[:10] if size[k] > 1]
    pieces = largest_pieces(cubes)
    assert len(pieces) == len(expected)
    assert all((piece == other).all() for piece, other in zip(pieces, expected, strict=True))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("share", SHARES)
def test_distances_are_exact(shape, share):
    cubes = space(shape, share)
    assert (distances(cubes) == ndimage.distance_transform_edt(cubes)).all()


def test_a_space_without_outside_is_the_diagonal_away():
    assert (distances(np.ones((2, 3, 6), bool)) == 7.0).all()


def test_a_space_grows_over_the_faces_of_its_cubes():
    cubes = space((9, 8, 7), 0.1)
    assert (grown(cubes) == ndimage.binary_dilation(cubes)).all()
    level = np.zeros((3, 3, 3), bool)
    level[:, :, 1] = ndimage.generate_binary_structure(2, 1)
    assert (grown(cubes, (0, 1)) == ndimage.binary_dilation(cubes, level)).all()


def test_the_print_rules_load_neither(tmp_path):
    code = (
        "import sys; from pneutouch.evaluation.evaluate import evaluate; evaluate('paper-dome', model='atlas').findings;"
        "print(*[name for name in ('scipy.ndimage', 'scipy.sparse', 'scipy.special') if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert run.stdout.strip() == ""
