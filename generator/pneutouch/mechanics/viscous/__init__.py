"""Effects of the resin's relaxation and ageing on a sensor; no imports here, because only the runs need the atlas."""
