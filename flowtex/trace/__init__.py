"""FlowField to TraceSlices: earlier and later positions of the particles at the nodes."""
