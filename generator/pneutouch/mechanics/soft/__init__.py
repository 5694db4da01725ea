"""Soft objects: their surface gives way to the wall's pressure, and the dome is pressed by what it becomes."""
