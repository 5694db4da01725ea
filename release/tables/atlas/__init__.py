"""Builds the atlas that ships: the solid surveyed, and its answers fitted."""
