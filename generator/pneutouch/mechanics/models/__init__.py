"""The models of a sensor, one file each, behind one interface and in one table (`choice`)."""
