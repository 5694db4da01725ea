"""Space that two bodies share."""

from pneutouch.body import Body


def overlap_volume(one: Body, other: Body) -> float:
    """Volume in mm3 that both bodies occupy."""
    return float((one.manifold() ^ other.manifold()).volume())
