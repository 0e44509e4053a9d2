"""Flows in browsers: notebook widgets, pages and modules by export, and :func:`flowtex.show`.

``view`` makes header and parts of a scene, which all hosts hand to the same client in ``static``;
the page of an application is in :mod:`flowtex.app`.
"""
