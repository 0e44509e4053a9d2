"""Sessions of pages: their registry, and the kinds that live here and in separate processes."""
