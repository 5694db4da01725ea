"""Texture specimens from their file to their folder."""
