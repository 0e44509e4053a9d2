"""What flowtex needs of Zarr that its public modules lack, in one place.

- ``sync`` waits for a coroutine of a store on the event loop on which Zarr's arrays work. Another
  loop would open a second connection to object storage for each call.
- ``ArrayV3Metadata`` describes an array of which ``AsyncArray`` is made: here with codecs that
  unpack no more bytes than the array declares.
- ``ArraySpec`` tells a codec the shape and type of a chunk.

All else comes from ``zarr``, ``zarr.abc``, ``zarr.buffer``, ``zarr.codecs`` and ``zarr.storage``.
"""

from __future__ import annotations

from zarr.core.array_spec import ArraySpec
from zarr.core.metadata import ArrayV3Metadata
from zarr.core.sync import sync

__all__ = ["ArraySpec", "ArrayV3Metadata", "sync"]
