"""A target to designs."""
