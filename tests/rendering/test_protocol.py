"""Parts on their way to a browser, read back as ``client/src/protocol.ts`` does."""

from __future__ import annotations

import json
import zlib
from itertools import product

import numpy as np
import pytest
from packed import unpacked

from flowtex._util.array_types import AnyArray
from flowtex.rendering.webgl.protocol import part_buffer, part_info, part_text, parts_file

ARRAYS: dict[str, AnyArray] = {
    "slices/0": np.arange(24, dtype="<f2").reshape(2, 3, 4),
    "normal": np.array([[-32767, 5, 0]], dtype="<i2"),
    "position": np.linspace(-1, 1, 12, dtype="<f4").reshape(4, 3),
    "cells": np.array([1, 0, 1], dtype=np.uint8),
    "step": np.zeros((0, 3), dtype="<f2"),
    "rough": np.array([[[0.1, -3, 1e-30]]], dtype="<f4"),
    "even": (np.arange(60, dtype="<f4").reshape(4, 5, 3) - 20) / 2**20,
}


def test_a_file_holds_parts_one_after_the_other() -> None:
    file = parts_file(ARRAYS)
    length = int.from_bytes(file[:4], "little")
    infos = json.loads(file[4 : 4 + length])
    start = 4 + length
    for (name, array), info in zip(ARRAYS.items(), infos, strict=True):
        assert info == {**part_info(name, array), "bytes": array.nbytes}
        part = np.frombuffer(file[start : start + info["bytes"]], info["dtype"])
        np.testing.assert_array_equal(part.reshape(info["shape"]), array)
        start += info["bytes"]
    assert start == len(file)


@pytest.mark.parametrize("name", ARRAYS)
def test_text_has_all_bits(name: str) -> None:
    array = ARRAYS[name]
    packing, text = part_text(array)
    found = unpacked({**part_info(name, array), **packing}, text)
    assert found.dtype == array.dtype and found.tobytes() == array.tobytes()


def test_multiples_of_a_power_of_two_are_whole_numbers() -> None:
    assert part_text(ARRAYS["even"])[0]["scale"] == [-20] * 3
    assert part_text(ARRAYS["slices/0"])[0]["scale"] == [2, 0, 1, 0]
    assert part_text(ARRAYS["rough"])[0]["scale"] is None
    for odd in ([1.0, 1e-9], [np.nan, 1.0], [-0.0, 1.0], [1e-40, 0.0]):
        assert part_text(np.array(odd, "<f4"))[0]["scale"] is None


def test_what_changes_evenly_is_packed_as_differences() -> None:
    even = np.arange(30_000, dtype="<u4").reshape(100, 100, 3)
    packing, text = part_text(even)
    assert packing["differences"][0] and len(text) < 1000


@pytest.mark.parametrize("unit", [2.0**-12, 2.0**-20])
def test_differences_are_those_with_the_fewest_bytes(unit: float) -> None:
    a, b = np.meshgrid(np.linspace(0, 3, 300), np.linspace(0, 1, 200))
    smooth = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)
    multiples = (np.rint(smooth / unit) * unit).astype("<f4")
    numbers = np.moveaxis(np.rint(smooth / unit).astype("<i4"), -1, 0)
    sizes = {}
    for orders in product(range(3), repeat=2):
        wholes = numbers
        for axis, order in enumerate(orders, start=1):
            wholes = np.diff(wholes, n=order, axis=axis)
        signed_last = ((wholes << 1) ^ (wholes >> 31)).reshape(-1, 1)
        sizes[orders] = len(zlib.compress(signed_last.view(np.uint8).T.tobytes()))
    packing, text = part_text(multiples)
    assert sizes[*packing["differences"]] < 1.03 * min(sizes.values())
    assert len(text) < 1.2 * 4 / 3 * min(sizes.values())


def test_a_part_that_lies_in_order_is_not_copied() -> None:
    array = ARRAYS["position"]
    assert np.shares_memory(np.frombuffer(part_buffer(array), np.uint8), array)
    across = np.frombuffer(part_buffer(array.T), "<f4")
    np.testing.assert_array_equal(across.reshape(3, 4), array.T)


def test_equal_arrays_have_one_digest() -> None:
    array = ARRAYS["position"]
    assert part_info("a", array)["digest"] == part_info("b", array.copy())["digest"]
    assert part_info("a", array)["digest"] != part_info("a", array[::-1])["digest"]
    assert part_info("a", array)["digest"] != part_info("a", array.view(np.int32))["digest"]
