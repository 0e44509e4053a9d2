"""Unstructured meshes of models: their nodes, faces, axes and maps.

Once a mesh is found, the dimensions of its nodes and faces are called ``NODES`` and ``FACES`` (see
:mod:`flowtex.sources.datasets.axes`) in all datasets that belong together.
"""
