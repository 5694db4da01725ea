"""The models of a sensor, one file each, with one interface (`interface`) and one table (`choice`)."""
