"""What a 3MF or a voxel stack holds."""
