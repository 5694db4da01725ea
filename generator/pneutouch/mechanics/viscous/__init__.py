"""What the resin's relaxation and its ageing do to a sensor. Nothing loads here: only the runs need the atlas."""
