"""pneutouch: pneumatic touch sensors, from a design file to print files, a prediction and a datasheet."""

__version__ = "0.1.0"
