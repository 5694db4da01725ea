"""Bodies in, bytes out: 3MF, STL, STEP and GLB, all in the print frame, the same bytes for the same input."""
