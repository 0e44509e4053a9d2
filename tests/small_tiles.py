"""Tiles of a sixteenth of their size, for tests in which the size of a tile does not matter."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest

__all__ = ["TILE_CELLS", "shrink", "small_tiles"]

#: Cells along a side of a tile; BLOCK_CELLS stay what they are.
TILE_CELLS = 64


def shrink(change: Callable[[Any, str, Any], None] = setattr) -> None:
    """Make tiles of one block, and not of four times four, in all modules that know the size."""
    from flowtex.pyramid import build, samples, served, stored
    from flowtex.rendering.vtk import surface
    from flowtex.tiles import Pyramid

    del build, samples, served, stored, surface  # what is not there could not be changed
    change(Pyramid, "tile_blocks", 1)
    for name, module in list(sys.modules.items()):
        for constant, value in (("TILE_BLOCKS", 1), ("TILE_CELLS", TILE_CELLS)):
            if name.startswith("flowtex.") and hasattr(module, constant):
                change(module, constant, value)


@pytest.fixture(scope="module")
def small_tiles() -> Iterator[None]:
    """Tests of this module have small tiles."""
    with pytest.MonkeyPatch.context() as patch:
        shrink(patch.setattr)
        yield
