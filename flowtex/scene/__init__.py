"""A flow and how it is drawn: options, attributes, scene, and the computation of one point."""
