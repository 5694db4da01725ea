"""Axisymmetric hyperelastic finite elements: a dome, its trapped gas and a flat rigid plate.

Units throughout: mm, N, MPa (pressures too).  Entry points: `mesh.dome` and `flange.printed_dome` (meshes),
`laws.hyperelastic` (materials), `model.SolidModel` (the discrete body), `inflate.inflate` (study 1), `indent.indent`
(study 2).  Nothing is imported here: the solver loads SciPy, which the atlas must not pay for.
"""
