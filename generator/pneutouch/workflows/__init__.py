"""Workflows of the commands, one folder each. One imports from another only what the other's `__init__` offers."""
