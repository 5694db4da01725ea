"""Tools of a release: its checks, what accompanies it (``make sbom pythons paper``), and builders of shipped tables."""
