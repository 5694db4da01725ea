"""A texture specimen: drawn, checked and built."""

from pneutouch.workflows.specimen.build import inputs
from pneutouch.workflows.specimen.draw import draw
from pneutouch.workflows.specimen.load import SpecimenScene, load_specimen, specimen_file

__all__ = ["SpecimenScene", "draw", "inputs", "load_specimen", "specimen_file"]
