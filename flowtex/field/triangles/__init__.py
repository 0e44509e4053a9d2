"""Surfaces of triangles: topology, geometry, and values at nodes.

The nodes of such a surface are one row of a grid: arrays over them are (1, N) where those of a
structured surface are (J, I), so that code that uses only the values need not distinguish them.
"""
