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
from flowtex.pyramid.checks import identity_of
from flowtex.pyramid.layout import SURFACE, TRACES, VALUES, create_array, shard_texels, to_write
from flowtex.rendering.webgl.protocol import parts_file
from flowtex.tiles import TileKey

zarr = pytest.importorskip("zarr")

FILE = Path(__file__).resolve().parents[2] / "client" / "tests" / "store.json"
#: Nodes of a tile, its texels, and those that there is room for.
NODES, SIZE, ROOM = (4, 5), (5, 7), (6, 8)
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
        "ranges": {"speed": [0.0, 1.0], "depth": [-2.0, 2.0]},
    }


def numbers() -> dict[str, AnyArray]:
    """Return the arrays of a level of two tiles, the second of which is empty."""
    rng = np.random.default_rng(3)
    layers = rng.integers(-9, 10, (STEPS, COUNT, *SIZE, 4)).astype(np.float32) / 8
    mesh = np.arange(19, dtype=np.float32).reshape(1, 1, 19)
    position = rng.integers(0, 99, (*NODES, 3)).astype(np.float32)
    traces = np.zeros((STEPS, 1, 2, 6, *ROOM, 4), np.float16)
    slices = told()["slices"]
    measures = {name: slices[name] for name in ("count", "lags", "unit", "cell")}
    for step in range(STEPS):
        whole, empty = (identity_of(ABOUT, TileKey(0, 0, column), step) for column in (0, 1))
        text = {**measures, "size": list(SIZE), **whole}
        traces[step, 0, 0] = shard_texels(text, layers[step], traces.shape[3:])
        traces[step, 0, 1] = shard_texels({"empty": True, **empty}, None, traces.shape[3:])
    values = np.zeros((STEPS, 1, 2, 2, *ROOM), np.float32)
    nodal = rng.integers(0, 99, (STEPS, 2, *NODES)).astype(np.float32)
    values[:, 0, 0, :, : NODES[0], : NODES[1]] = nodal
    header = np.frombuffer(json.dumps(told()).encode(), np.uint8)
    parts: dict[str, AnyArray] = {"header": header, "mesh": mesh, "position": position}
    files = [
        parts_file({f"tile/0/0/0/{name}": part for name, part in parts.items()}),
        parts_file({"tile/0/0/1/header": np.frombuffer(b"null", np.uint8)}),
    ]
    surface = np.zeros((1, 2, 4096), np.uint8)
    for column, file in enumerate(files):
        surface[0, column, : len(file)] = np.frombuffer(file, np.uint8)
    return {TRACES: traces, VALUES: values, SURFACE: surface}


def expected() -> dict[str, Any]:
    """Return what the client makes of it: slopes as they are packed, and values."""
    arrays = numbers()
    result: dict[str, Any] = {}
    for step in range(STEPS):
        layers = arrays[TRACES][step, 0, 0, 1 : 1 + COUNT, : SIZE[0], : SIZE[1]]
        result[f"slices/{step}"] = layers[..., :2]
        result[f"extra/{step}"] = layers[EXTRA, ..., 3]
        for number in range(2):
            nodal = arrays[VALUES][step, 0, 0, number, : NODES[0], : NODES[1]]
            result[f"scalars/{step}/{number}"] = nodal
    return {
        name: {
            "shape": list(array.shape),
            "data": np.ascontiguousarray(array).view(f"u{array.itemsize}").ravel().tolist(),
        }
        for name, array in result.items()
    }


def write(folder: Path) -> None:
    group = zarr.open_group(folder, mode="w")
    group.attrs["flowtex"] = ABOUT
    level = group.require_group("0")
    for name, array in numbers().items():
        shape = array.shape
        last = {TRACES: 3, VALUES: 2, SURFACE: 1}[name]
        chunks = (*(1,) * (len(shape) - last), *shape[-last:])
        shards = (1, 1, 1, *shape[3:]) if name == TRACES else None
        axes = [f"axis{n}" for n in range(len(shape))]
        kind = array.dtype.name
        create_array(level, name, shape, chunks, shards, kind, axes)
        writable = level[name] if name == TRACES else to_write(level, name)
        writable[...] = array


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
