"""FlowField to TraceSlices: where the particle now at a node was at earlier times."""

from __future__ import annotations

from flowtex.trace.slices import TraceSlices
from flowtex.trace.store import SliceStore, shared_store
from flowtex.trace.trace import paths, trace

__all__ = ["SliceStore", "TraceSlices", "paths", "shared_store", "trace"]
