"""Checks of a file's declarations against its size and the free memory, before it is opened."""
