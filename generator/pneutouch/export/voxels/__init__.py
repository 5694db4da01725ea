"""Voxel stacks: one PNG a layer, every pixel a droplet of one base resin (GrabCAD Voxel Print)."""
