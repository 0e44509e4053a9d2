"""Tiles of a sixteenth of their size, for tests in which the size of a tile does not matter."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest

#: Cells along a side of a block, and of a tile of four times four of them.
BLOCK_CELLS, TILE_CELLS = 16, 64
#: These, and bytes of the files of a tile: zeros fill their last chunk, and are packed as well.
SMALL = {
    "BLOCK_CELLS": BLOCK_CELLS,
    "TILE_CELLS": TILE_CELLS,
    "FILE_CHUNK": 1 << 16,
    "FILE_BYTES": 1 << 24,
}


def shrink(change: Callable[[Any, str, Any], None] = setattr) -> None:
    """Make small tiles, in all modules that know their size."""
    from flowtex.pyramid import build, stored
    from flowtex.textures.tiles.blocks import block_places

    with suppress(ModuleNotFoundError):  # without VTK nothing is drawn by it
        from flowtex.rendering.vtk import flow_surface as flow_surface

    del build, stored  # what is not there could not be changed
    change(block_places, "__defaults__", (BLOCK_CELLS,))
    for name, module in list(sys.modules.items()):
        for constant, value in SMALL.items():
            if name.startswith("flowtex.") and hasattr(module, constant):
                change(module, constant, value)


@pytest.fixture(scope="module")
def small_tiles() -> Iterator[None]:
    """Tests of this module have small tiles."""
    with pytest.MonkeyPatch.context() as patch:
        shrink(patch.setattr)
        yield
