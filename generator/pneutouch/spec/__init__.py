"""Typed models of what users write: designs, printers, materials and parts. Validation and nothing else."""
