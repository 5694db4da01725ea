"""LAPACK's routines without the package around them are those of `scipy.linalg`, whichever is loaded first."""

import subprocess
import sys

import pytest

OURS, SCIPYS = (
    "from pneutouch.mechanics.solid.banded import lapack as ours",
    "from scipy.linalg import lapack as scipys",
)
COMPARED = """
import sys
import numpy as np
band = np.asfortranarray([[4.0, 5.0, 6.0], [1.0, 2.0, 0.0]])
dense, b = np.array([[4.0, 1.0, 0.0], [1.0, 5.0, 2.0], [0.0, 2.0, 6.0]]), np.ones((3, 1))
for each in (ours, scipys):
    factor, info = each.dpbtrf(band, lower=1)
    x = each.dpbtrs(factor, b, lower=1)[0]
    assert info == 0 and np.abs(dense @ x - b).max() < 1e-15, each
"""


@pytest.mark.parametrize("imports", [(OURS, SCIPYS), (SCIPYS, OURS)])
def test_both_solve_a_banded_system(imports):
    code = "\n".join([*imports, COMPARED])
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_wrappers_alone_load_no_package_of_linear_algebra():
    code = f"import sys\n{OURS}\nassert not {{'scipy.linalg', 'numpy.f2py'}} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
