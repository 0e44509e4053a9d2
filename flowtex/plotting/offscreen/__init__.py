"""Pictures and movies without a window."""
