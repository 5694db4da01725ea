"""Builders of the tables that ship with the package, each run after a change to the model that it tabulates.

``make atlas`` surveys the solid over walls, volumes and depths and fits the atlas to it. ``make contact-table`` presses
domes by balls and edges, in the middle and off it, for the table of contact anywhere. Both take hours, use every core,
keep their parts in ``outputs/`` and go on where they were stopped. Tests compare a fingerprint of today's model with
the one that each table holds.
"""
