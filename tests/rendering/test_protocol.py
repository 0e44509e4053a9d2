"""Parts on their way to a browser, read back as ``client/src/protocol.ts`` does."""

from __future__ import annotations

import json

import numpy as np
import pytest
from packed import unpacked

from flowtex._util.array_types import AnyArray
from flowtex.rendering.webgl.protocol import part_info, part_text, parts_file

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
