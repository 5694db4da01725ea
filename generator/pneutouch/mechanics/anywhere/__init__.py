"""Errors of a sensor's reading under contact off the centre, tabulated once in dimensionless form.

`recipe` states the presses that the table is made from, `table` interpolates in it, `conditions` makes its variables
from sensors, `reading` the errors of a force that is read by the central calibration. The table is built outside the
package: ``make contact-table``.
"""
