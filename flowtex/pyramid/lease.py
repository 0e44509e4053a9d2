"""The lease of a store: the process that builds it holds one, so no other builds it.

It is an object of the store with the name of its holder and the time of its last renewal. A lease
that is not renewed, or whose process has ended, is stale and taken over.
"""

from __future__ import annotations

import json
import math
import os
import platform
import sys
import threading
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from flowtex.pyramid.places import LEASE, PyramidError, store_at, sync

#: Seconds between renewals, and after which a lease that was not renewed is stale.
RENEWAL_S, STALE_S = 20.0, 120.0


class Lease:
    """The right to build a store, held inside a ``with``; a PyramidError when another holds it.

    The ``clock`` must agree on all machines to within some seconds.
    """

    def __init__(self, place: str, clock: Callable[[], float] = time.time) -> None:
        self.place, self._clock = place, clock
        self._store = store_at(place, read_only=False)
        self._identity = {"id": uuid.uuid4().hex, "host": platform.node(), "process": os.getpid()}
        self._renewed, self._holder = -math.inf, ""
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._keep, name="flowtex-lease", daemon=True)

    def __enter__(self) -> Lease:
        """Take the lease."""
        content = self._read()
        if content and not self._is_stale(content):
            self._refuse(content)
        if content:
            sync(self._store.delete(LEASE))
        self._write(create=True)
        content = self._read()
        if content.get("id") != self._identity["id"]:
            self._refuse(content)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Give the lease back."""
        self._end.set()
        self._thread.join()
        if not self._holder:
            with suppress(Exception):  # an error of the work inside is more important
                if self._read().get("id") == self._identity["id"]:
                    sync(self._store.delete(LEASE))

    def check(self) -> None:
        """Raise a PyramidError if another process has taken over the lease."""
        if not self._holder and self._clock() - self._renewed > STALE_S:
            self.renew()
        if self._holder:
            msg = f"{self.place} was taken over by {self._holder}, which is building it now"
            raise PyramidError(msg)

    def renew(self) -> None:
        """Show that the holder is still running."""
        content = self._read()
        if content.get("id") != self._identity["id"]:
            self._holder = _process_text(content)
        else:
            self._write(create=False)

    def _keep(self) -> None:
        while not self._end.wait(RENEWAL_S):
            with suppress(Exception):  # of the network: check() tries again
                self.renew()

    def _is_stale(self, content: dict[str, Any]) -> bool:
        if self._clock() - content["at"] > STALE_S:
            return True
        is_local = content.get("host") == self._identity["host"]
        return is_local and not _is_running(content.get("process"))

    def _refuse(self, content: dict[str, Any]) -> None:
        age = max(self._clock() - content.get("at", 0.0), 0.0)
        msg = (
            f"{self.place} is being built by {_process_text(content)}, last active {age:.0f} s "
            f"ago; wait until it ends. If it is no longer running, build again {STALE_S:.0f} s "
            "after its last activity"
        )
        raise PyramidError(msg)

    def _read(self) -> dict[str, Any]:
        """Return the content of the lease; empty without one."""
        from zarr.core.buffer import default_buffer_prototype

        data = sync(self._store.get(LEASE, default_buffer_prototype()))
        if data is None:
            return {}
        with suppress(ValueError, KeyError, TypeError):
            content: dict[str, Any] = json.loads(data.to_bytes())
            if isinstance(content["at"], (int, float)):
                return content
        return {"at": -math.inf}  # it was cut off, so it is not held

    def _write(self, *, create: bool) -> None:
        from zarr.core.buffer import default_buffer_prototype

        now = self._clock()
        text = json.dumps({**self._identity, "at": now}).encode()
        data = default_buffer_prototype().buffer.from_bytes(text)
        try:
            set_ = self._store.set_if_not_exists if create else self._store.set
            sync(set_(LEASE, data))
        except (OSError, NotImplementedError):
            # Not all storage has links or conditional writes; then the content decides.
            sync(self._store.set(LEASE, data))
        self._renewed = now


def _process_text(content: dict[str, Any]) -> str:
    return f"process {content.get('process', '?')} on {content.get('host', 'another machine')}"


def _is_running(process: object) -> bool:
    """Return whether a process of this machine runs, or that is unknown."""
    if sys.platform == "win32" or type(process) is not int:
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
