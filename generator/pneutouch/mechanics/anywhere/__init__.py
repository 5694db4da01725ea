"""Errors of a sensor's reading for contact off the centre, tabulated once in dimensionless form.

`table` states the presses from which the table is made and interpolates in it. `reading` computes the table's input
variables for sensors, and the error of a force that is read by the central calibration. The table is built outside the
package: ``make contact-table``.
"""
