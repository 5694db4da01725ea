"""Tray: several sensors in one print, packed, marked and labelled, with as few resin changes as possible."""
