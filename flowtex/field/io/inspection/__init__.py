"""Compares what a file declares with its size and the free memory, before a reader opens it."""
