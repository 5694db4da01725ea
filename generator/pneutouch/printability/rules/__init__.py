"""The rules by their subject: ``check_NAME(view)`` returns findings."""
