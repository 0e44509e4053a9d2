"""Helpers of the whole package: array types, caches, colours, files, progress, extras."""
