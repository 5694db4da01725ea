"""The atlas: results of the solid in dimensionless form, tabulated once.

`recipe` states which presses the solid solves and how their results are stored, `table` looks them up, `press` adds gas
and plate, `respond` computes figures of many sensors at once. The table is built outside the package: ``make atlas``.
"""
