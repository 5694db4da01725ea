"""A page in the browser, served to this machine alone: a design's form, its drawing, its curves and its limits."""
