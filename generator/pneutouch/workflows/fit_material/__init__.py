"""``fit-material``: the law of a material from the tensile or puck test of a laboratory, and its file."""
