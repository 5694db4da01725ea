"""The sheet of a comparison: what differs, figures with intervals, overlaid curves and sections."""
