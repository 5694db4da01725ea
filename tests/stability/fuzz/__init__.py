"""Random damage to files and command lines: which cases there are, how they are made and how one is judged."""
