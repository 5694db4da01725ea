"""Axisymmetric hyperelastic finite elements: a dome, its trapped gas, and a rigid plate or other object.

Meshes, settings and results are in mm, N and MPa; the solver is nondimensional, in R0 and mu. Entry points:
`mesh.dome`, `flange.printed_dome`, `model.SolidModel`, `inflate.inflate` and `indent.indent`. Nothing is imported here,
because the atlas needs no solver and no SciPy.
"""
