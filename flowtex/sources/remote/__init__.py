"""Files that are read in a separate process."""

from __future__ import annotations

from flowtex.sources.remote.source import RemoteSource, open_remote, prepare_readers

__all__ = ["RemoteSource", "open_remote", "prepare_readers"]
