"""What the resin's relaxation and its ageing do to a sensor. Nothing loads here: the atlas, which loads scipy, is for the runs alone."""
