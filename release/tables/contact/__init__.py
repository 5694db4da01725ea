"""Builds the table of contact anywhere that ships: presses of domes by objects in the middle and off it."""
