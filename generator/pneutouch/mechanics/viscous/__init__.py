"""Effects of the resin's relaxation and of its ageing on a sensor. Nothing loads here: only the runs need the atlas."""
