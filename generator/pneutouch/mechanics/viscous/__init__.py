"""Effects of the resin's relaxation and ageing on a sensor. Nothing is imported here: only the runs need the atlas."""
