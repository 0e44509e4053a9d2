"""Controllers of a page: the actions of its controls."""
