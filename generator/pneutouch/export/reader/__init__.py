"""A sensor's pressure-to-force model as files for a microcontroller, for Python and for other programs."""
