"""What knows nothing of flows; and the version, as every room can read it here."""

from __future__ import annotations

__version__ = "0.1.0"
