"""Schemas of the JSON documents that the program writes."""
