"""The structure of a flow: critical points, and the lines between them."""
