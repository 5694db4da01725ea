"""The atlas: the solid's answers in dimensionless form, tabulated once.

`recipe` and `survey` state which states the solid solves, `fit` how its answers are stored; `table` looks them up, `press` adds gas
and plate, `respond` turns many sensors at once into figures.
"""
