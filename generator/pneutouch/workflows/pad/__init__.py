"""Pads: what `check` and `build` do with a file that has a [pad] table."""
