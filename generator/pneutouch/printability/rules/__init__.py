"""The rules, one file each: ``check(assembly, prediction)`` returns findings."""
