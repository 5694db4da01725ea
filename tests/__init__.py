"""Tests of the package. They mirror its folders."""

import os

# Two workers share the processors: threads of the linear algebra only wait for each other. Set before NumPy is loaded.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
