"""Warnings, and notices about choices that flowtex made, issued at the caller's line."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

_PACKAGE = str(Path(__file__).resolve().parents[1])


class Notice(UserWarning):
    """Something of the data was chosen automatically, or is not drawn."""


def notify(text: str, kind: type[Warning] = Notice) -> None:
    """Warn at the line that called the package, however deep the call stack is."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, kind, stacklevel=level)
