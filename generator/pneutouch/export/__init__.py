"""Files as bytes, the same for the same input: 3MF, STL, STEP, GLB, voxel slices, readers and simulator models."""
