"""Random faults in the code, and whether the everyday tests notice them: ``python -m tests.mutants``."""
