"""Output files and folders with their manifests, recipes of builds, and new design files."""
