"""Every reader of bytes of others as a function of a file, and damaged and hostile inputs that it must answer or refuse."""
