"""Which arrays have been sent to some page: they are offered to others before they are sent."""

from __future__ import annotations

import threading
from collections import OrderedDict

__all__ = ["has_gone"]

#: Digests that are remembered.
REMEMBERED = 10_000

_gone: OrderedDict[bytes, None] = OrderedDict()
_lock = threading.Lock()


def has_gone(told: bytes) -> bool:
    """Tell whether an array has been sent to some page, which from now on it has."""
    with _lock:
        had = told in _gone
        _gone[told] = None
        _gone.move_to_end(told)
        while len(_gone) > REMEMBERED:
            _gone.popitem(last=False)
        return had
