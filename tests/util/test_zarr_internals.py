"""Parts of Zarr without a public place: a new version that moves or changes them fails here."""

from __future__ import annotations

import asyncio
import re
from pathlib import Path

import numpy as np
import pytest

zarr = pytest.importorskip("zarr")

from flowtex._util.zarr_internals import ArraySpec, ArrayV3Metadata, sync  # noqa: E402

PACKAGE = Path(__file__).parents[2] / "flowtex"


def test_an_array_made_from_its_metadata_has_its_values() -> None:
    store = zarr.storage.MemoryStore()
    values = np.arange(12.0).reshape(3, 4)
    zarr.create_array(store, data=values, chunks=(2, 2))
    metadata = ArrayV3Metadata.from_dict(zarr.open_array(store, mode="r").metadata.to_dict())
    assert metadata.shape == values.shape
    made = zarr.AsyncArray(metadata, zarr.storage.StorePath(store, ""))
    np.testing.assert_array_equal(sync(made.getitem((slice(None), slice(None)))), values)


def test_codecs_receive_shape_and_type_of_a_chunk() -> None:
    assert {"shape", "dtype", "prototype"} <= set(ArraySpec.__dataclass_fields__)


def test_coroutines_share_one_event_loop() -> None:
    async def loop() -> asyncio.AbstractEventLoop:
        return asyncio.get_running_loop()

    assert sync(loop()) is sync(loop())


def test_no_other_module_imports_private_parts() -> None:
    found = []
    for path in PACKAGE.rglob("*.py"):
        if path.name == "zarr_internals.py":
            continue
        if re.search(r"\bzarr\.core\b", path.read_text(encoding="utf-8")):
            found.append(path.name)
    assert not found
