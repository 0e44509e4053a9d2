"""Trace slices without what their neighbours tell, and how much that is.

:func:`redundancy` measures it, and :func:`compact` takes it out: exactly, or within a bound in
texels of the noise.
"""

from __future__ import annotations

from flowtex.trace.compact.compress import CompactSlices, compact
from flowtex.trace.compact.redundancy import Redundancy, redundancy
from flowtex.trace.compact.texels import error_in_texels

__all__ = ["CompactSlices", "Redundancy", "compact", "error_in_texels", "redundancy"]
