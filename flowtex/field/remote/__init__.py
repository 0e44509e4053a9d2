"""Files that are read in a process of their own."""

from __future__ import annotations

from flowtex.field.remote.source import RemoteSource, open_remote, prepare_readers

__all__ = ["RemoteSource", "open_remote", "prepare_readers"]
