"""The small store that the client's own tests read, and what they must find in it.

``FLOWTEX_WRITE_FIXTURES=1`` writes the file; without it, it must say what Python writes.
"""

from __future__ import annotations

import base64
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex._util.array_types import AnyArray
from flowtex.pyramid.layout import FLOW, SURFACE, VALUES, create_array
from flowtex.rendering.webgl.protocol import parts_file

zarr = pytest.importorskip("zarr")

FILE = Path(__file__).resolve().parents[2] / "client" / "tests" / "store.json"
#: Nodes of a tile, its texels, and bytes of a file and of its chunks.
NODES, SIZE, ROOM, CHUNK = (4, 5), (5, 7), 4096, 1024
COUNT, EXTRA, STEPS = 3, [0, 2], 2
ABOUT = {"format": "form", "fingerprint": "print", "parameter": "arclength", "lines": "pathlines"}


def told() -> dict[str, Any]:
    """Return what is told of the tile that is drawn."""
    rows, columns = ({"before": 1, "size": size} for size in SIZE)
    return {
        "geometry": {
            "triangles": False,
            "shape": list(NODES),
            "rows": rows,
            "columns": columns,
            "levels": 2,
            "periodic": [False, False],
            "planar": True,
            "extent": 2.0,
            "center": [0.0, 0.0, 0.0],
            "frame": np.eye(3).ravel().tolist(),
        },
        "slices": {
            "count": COUNT,
            "channels": 2,
            "extra": EXTRA,
            "lags": [1.0, 2.0],
            "sides": 1,
            "unit": 0.5,
            "cell": 0.1,
            "critical": 0.0,
        },
    }


def files() -> dict[str, dict[tuple[int, ...], dict[str, AnyArray]]]:
    """Return the files of two tiles, the second of which is empty, by array and place."""
    rng = np.random.default_rng(3)
    result: dict[str, dict[tuple[int, ...], dict[str, AnyArray]]] = {FLOW: {}, VALUES: {}}
    for step in range(STEPS):
        layers = rng.integers(-9, 10, (COUNT, *SIZE, 4)).astype(np.float16) / np.float16(8)
        slopes, extra = np.ascontiguousarray(layers[..., :2]), layers[EXTRA, ..., 3]
        parts = {f"tile/0/0/0/slices/{step}": slopes, f"tile/0/0/0/extra/{step}": extra}
        result[FLOW][step, 0, 0], result[FLOW][step, 0, 1] = parts, {}
        for number in range(2):
            values = rng.integers(0, 99, NODES).astype(np.float32)
            result[VALUES][step, 0, 0, number] = {f"tile/0/0/0/scalars/{step}/{number}": values}
    drawn: dict[str, AnyArray] = {
        "tile/0/0/0/header": np.frombuffer(json.dumps(told()).encode(), np.uint8),
        "tile/0/0/0/mesh": np.arange(19, dtype=np.float32).reshape(1, 1, 19),
        "tile/0/0/0/position": rng.integers(0, 99, (*NODES, 3)).astype(np.float32),
    }
    empty: dict[str, AnyArray] = {"tile/0/0/1/header": np.frombuffer(b"null", np.uint8)}
    return {**result, SURFACE: {(0, 0): drawn, (0, 1): empty}}


def expected() -> dict[str, Any]:
    """Return what the client makes of it: slopes as they are packed, and values."""
    made = files()
    parts = [parts for array in (FLOW, VALUES) for parts in made[array].values()]
    return {
        name.removeprefix("tile/0/0/0/"): {
            "shape": list(array.shape),
            "data": np.ascontiguousarray(array).view(f"u{array.itemsize}").ravel().tolist(),
        }
        for name, array in (item for some in parts for item in some.items())
    }


def numbers() -> dict[str, AnyArray]:
    """Return the arrays of the level."""
    of = np.frombuffer(ABOUT["fingerprint"].encode(), np.uint8)
    result: dict[str, AnyArray] = {}
    for name, made in files().items():
        counts = np.max([*made], axis=0) + 1
        result[name] = np.zeros((*counts, ROOM), np.uint8)
        for at, parts in made.items():
            file = np.frombuffer(parts_file({"of": of, **parts}, planes=True), np.uint8)
            result[name][at][: len(file)] = file
    return result


def write(folder: Path) -> None:
    group = zarr.open_group(folder, mode="w")
    group.attrs["flowtex"] = ABOUT
    level = group.require_group("0")
    for name, array in numbers().items():
        axes = {f"axis{n}": (count, 1, 1) for n, count in enumerate(array.shape[:-1])}
        create_array(level, name, "uint8", {**axes, f"axis{len(axes)}": (ROOM, CHUNK, ROOM)})
        level[name][...] = array


def test_the_clients_store_is_what_python_writes(tmp_path: Path) -> None:
    if os.environ.get("FLOWTEX_WRITE_FIXTURES"):
        write(tmp_path / "made")
        files = {
            str(path.relative_to(tmp_path / "made")): base64.b64encode(path.read_bytes()).decode()
            for path in sorted((tmp_path / "made").rglob("*"))
            if path.is_file()
        }
        text = json.dumps({"files": files, "told": told(), "expected": expected()}, indent=1)
        FILE.write_text(text + "\n", encoding="utf-8")
    kept = json.loads(FILE.read_text("utf-8"))
    assert (kept["told"], kept["expected"]) == (told(), expected())
    for name, data in kept["files"].items():
        (tmp_path / "kept" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "kept" / name).write_bytes(base64.b64decode(data))
    group = zarr.open_group(tmp_path / "kept", mode="r")
    for name, array in numbers().items():
        np.testing.assert_array_equal(group[f"0/{name}"][...], array)
