"""What accompanies a release: ``make sbom``, ``make paper``."""
