"""LAPACK's routines for banded and triangular matrices as SciPy wraps them, without the package around them.

`import scipy.linalg` loads most of NumPy's subpackages (f2py, random and testing among them) and costs three times as
much as NumPy and these wrappers together: a sixth of the processor time of ``predict`` with the solid.
"""

import sys
from importlib import import_module
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from types import ModuleType


def _wrappers() -> ModuleType:
    """SciPy's extension module with the wrappers; through `scipy.linalg` where that is loaded or it lies elsewhere."""
    import scipy

    spec = None
    if "scipy.linalg" not in sys.modules:
        spec = PathFinder.find_spec("scipy.linalg._flapack", [f"{folder}/linalg" for folder in scipy.__path__])
    if spec is None or spec.loader is None:
        return import_module("scipy.linalg.lapack")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


_lapack = _wrappers()
dpbtrf, dpbtrs = _lapack.dpbtrf, _lapack.dpbtrs
dgbsv, dgbtrf, dgbtrs = _lapack.dgbsv, _lapack.dgbtrf, _lapack.dgbtrs
dtrtrs = _lapack.dtrtrs
