"""Measurements. ``python -m benchmarks.NAME`` measures and stores docs/background/NAME.json, of which pages are filled."""
