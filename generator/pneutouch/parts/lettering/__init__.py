"""Labels on bodies: glyphs, the faces that take them, tally grooves, and the marked body."""
