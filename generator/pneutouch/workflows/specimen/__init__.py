"""Texture specimen: drawn, checked and built."""

from pneutouch.workflows.specimen.build import inputs
from pneutouch.workflows.specimen.draw import ResolvedSpecimen, draw, load_specimen

__all__ = ["ResolvedSpecimen", "draw", "inputs", "load_specimen"]
