"""A model fitted to measured runs."""
