"""Trace slices without what their neighbours tell, and how much that is.

:func:`redundancy` measures it, and :func:`compact` takes it out: exactly, or within a bound in
texels of the noise.
"""

from __future__ import annotations

from paper.compact.compress import CompactSlices, compact
from paper.compact.redundancy import Redundancy, redundancy
from paper.compact.texels import error_in_texels

__all__ = ["CompactSlices", "Redundancy", "compact", "error_in_texels", "redundancy"]
