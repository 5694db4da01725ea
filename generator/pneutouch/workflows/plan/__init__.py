"""How to measure a printed sensor, and what to expect."""
