"""The gas line from the cavity to the gauge as a transmission line, and its effect on a reading over time."""
