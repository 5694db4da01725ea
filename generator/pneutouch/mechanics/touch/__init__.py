"""Contact of rigid objects with the cells of a pad: what each cell reads, and what object and force explain it."""
