"""The Python interface, whose names `pneutouch` offers: thin functions and objects over the workflows."""
