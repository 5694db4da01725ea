"""The datasheet and its figures, the measured sheet, comparisons, and the charts of commands: drawn from records."""
