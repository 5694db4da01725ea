"""A sensor live: readings of a device over a serial port, force by the reader, recordings that `characterize` reads."""
