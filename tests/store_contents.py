"""What lies in a store."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flowtex.pyramid import layout


def contents(store: Path) -> dict[str, bytes]:
    """What lies in all arrays, of files of parts in the first chunk.

    Files themselves also tell when they were packed.
    """
    import zarr

    members = zarr.open_group(store, mode="r").members(max_depth=None)
    arrays = {name: array for name, array in members if isinstance(array, zarr.Array)}
    return {
        name: np.asarray(
            array[..., : layout.FILE_CHUNK] if array.shape[-1] == layout.FILE_BYTES else array[:]
        ).tobytes()
        for name, array in arrays.items()
    }
