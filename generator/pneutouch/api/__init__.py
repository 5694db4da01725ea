"""The Python interface: `pneutouch` offers its names. Thin over the evaluation and the workflows."""
