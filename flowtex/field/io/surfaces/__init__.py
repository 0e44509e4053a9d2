"""Surfaces of triangles from meshes of any kind: as they are, cut out of a volume, or around it."""
