"""Frozen records, in boundary units, of all that is computed; every document that is written is a dump of one."""
