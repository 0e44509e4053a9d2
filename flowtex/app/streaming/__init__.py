"""Pictures of a flow on their way to a page."""
