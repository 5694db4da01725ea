"""Several sensors on one tray of a printer: packed, marked, labelled, in as few resin changes as can be."""
