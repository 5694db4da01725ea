"""Several sensors on one tray of a printer: packed, marked, labelled, with as few resin changes as possible."""
