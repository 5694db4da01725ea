"""Form of a membrane: one meridian, from which solid, print mesh, mould and finite elements all grow."""
