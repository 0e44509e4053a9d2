"""Unstructured meshes of models: their nodes, faces, axes and maps."""
