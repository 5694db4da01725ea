"""A body of revolution as arcs and lines in the (r, z) plane: the one source for solid, print mesh and FE mesh."""

from pneutouch.meridian.profile import Meridian
from pneutouch.meridian.sampling import MeridianVertex, polygon, sample
from pneutouch.meridian.segments import Arc, Line, Point, Segment

__all__ = ["Arc", "Line", "Meridian", "MeridianVertex", "Point", "Segment", "polygon", "sample"]
