"""The gas line from the cavity to the gauge as a transmission line, and what it does to a reading over time."""
