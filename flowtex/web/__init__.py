"""Pages and pictures for a browser, and its client."""
