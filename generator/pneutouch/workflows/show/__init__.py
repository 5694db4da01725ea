"""Content of a 3MF or of a voxel stack."""
