"""The atlas: the solid's answers in dimensionless form, tabulated once.

`recipe` and `survey` say what the solid is asked, `fit` how its answers are held; `table` looks them up, `press` adds gas
and plate, `respond` turns many sensors at once into figures.
"""
