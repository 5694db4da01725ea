"""A page in the browser, served only to this machine: a design's form, its drawing, its curves and its limits."""
