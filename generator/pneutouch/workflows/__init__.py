"""Workflows of the commands, a file or a folder each. From another's folder one imports only what `__init__` offers."""
