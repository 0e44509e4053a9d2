"""Surfaces of triangles from meshes of any kind: surfaces, cuts through a volume, or its hull."""
