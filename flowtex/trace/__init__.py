"""FlowField to TraceSlices: earlier and later positions of the particles at the nodes."""

from __future__ import annotations

from flowtex.trace.slices import TraceSlices
from flowtex.trace.store import SliceStore, changing_share, chosen_lines, judged_lines, shared_store
from flowtex.trace.trace import lyapunov_exponent, paths, trace

__all__ = [
    "SliceStore",
    "TraceSlices",
    "changing_share",
    "chosen_lines",
    "judged_lines",
    "lyapunov_exponent",
    "paths",
    "shared_store",
    "trace",
]
