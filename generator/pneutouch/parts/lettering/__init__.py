"""Labels on bodies: glyphs, the faces that can carry labels, tally grooves, and the marked body."""
