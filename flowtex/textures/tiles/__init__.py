"""A surface as a pyramid of tiles, each at the detail that a view asks for."""
