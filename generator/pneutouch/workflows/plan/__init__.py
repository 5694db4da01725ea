"""Plan of the measurement of a printed sensor, with the expected figures."""
