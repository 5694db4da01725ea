"""One folder a command. A workflow imports from another only what that one's `__init__` offers."""
