"""Designs, builds and measurements side by side."""

from pneutouch.workflows.compare.run import Compared, CompareResult, compare, write

__all__ = ["CompareResult", "Compared", "compare", "write"]
