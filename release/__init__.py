"""What a release is checked and accompanied by: ``make sbom``, ``make pythons``, ``make paper``."""
