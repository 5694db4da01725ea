"""Voxel stacks: one PNG per layer, every pixel a droplet of one base resin (GrabCAD Voxel Print)."""
