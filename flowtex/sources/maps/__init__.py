"""Nodes of longitude and latitude on maps."""
