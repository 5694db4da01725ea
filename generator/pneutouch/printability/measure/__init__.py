"""Measurements on meshes that several rules share; each is made once for each part."""
