"""The atlas: the solid's answers in dimensionless form, tabulated once.

`recipe` says which states the solid solves and how its answers are stored, `table` looks them up, `press` adds gas
and plate, `respond` turns many sensors at once into figures. The table is built outside the package: ``make atlas``.
"""
