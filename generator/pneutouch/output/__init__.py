"""The only code that writes folders: files, manifest, recipe, new design files."""
