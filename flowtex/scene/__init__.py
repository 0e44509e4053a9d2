"""One flow and how it is drawn: the options of every call, the scene, a point's own sum."""
