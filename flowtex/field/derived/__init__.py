"""Derived quantities, and the gradient of the velocity along a surface."""
