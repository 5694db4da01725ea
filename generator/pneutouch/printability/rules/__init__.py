"""The rules, one file each: ``check(view)`` returns findings."""
