"""What a store has for browsers is what a server would hand them."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import AnyArray
from flowtex.options import Options
from flowtex.pyramid import build
from flowtex.tiles import Pyramid, TileKey
from flowtex.web.tiles import packed_tile, tile_loader
from flowtex.web.view import WebView, web_views

zarr = pytest.importorskip("zarr")


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 1250)


def flat() -> FlowField:
    """Three times of a stream past an island, with a scalar that varies and one that does not."""
    y, x = np.mgrid[0:50, 0:75].astype(float) / 25
    steps = [np.stack([np.cos(3 * y + t), np.sin(4 * x - t)], axis=-1) for t in (0.0, 0.1, 0.2)]
    scalars = {"heat": np.stack([x, x + 1, x * y]), "depth": x * y}
    valid = np.hypot(x - 1.3, y - 1.2) > 0.4
    return FlowField.from_arrays(
        np.stack([x, y], -1),
        np.stack(steps),
        times=[0, 0.1, 0.2],
        valid=valid,
        scalars=scalars,
    )


def ring() -> FlowField:
    """Curved, closed around, on a cone."""
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 101), np.linspace(0, 1, 48))
    radius = 1 + 0.4 * height
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)
    around = np.stack([-np.sin(turn), np.cos(turn), 0.3 * np.sin(5 * turn)], axis=-1)
    return FlowField.from_arrays(points, around)


def opened(file: bytes) -> dict[str, AnyArray]:
    """Read a file of parts as the client does."""
    (length,) = struct.unpack_from("<I", file)
    parts, start = {}, 4 + length
    for info in json.loads(file[4:start]):
        data = np.frombuffer(file, np.dtype(info["dtype"]), int(np.prod(info["shape"])), start)
        parts[info["name"]] = data.reshape(info["shape"])
        start += info["bytes"]
    return parts


def handed(view: WebView, key: TileKey, steps: range) -> dict[str, AnyArray]:
    """Return the parts of a tile as a page that holds them has them."""
    data = view.page_data()
    assert data.pyramid is not None
    loader = tile_loader(data, data.pyramid)
    loader.request([key], steps)
    loader.wait()
    tile = loader.get(key, list(steps))
    assert tile is not None
    return packed_tile(data, tile, steps)


@pytest.mark.parametrize("make", [flat, ring])
def test_parts_are_those_of_a_page(tmp_path: Path, make: Any) -> None:
    field = make()
    build(field, tmp_path / "a.zarr", levels="all", progress=False)
    group = zarr.open_group(tmp_path / "a.zarr", mode="r")
    (view,) = web_views(field, Options.split())
    steps = range(len(field.times))
    assert view.scene.pyramid is not None
    for key in view.scene.pyramid.children(None):
        own, at = group[str(key.level)], (key.row, key.column)
        stored, expected = opened(own["surface"][at].tobytes()), handed(view, key, steps)
        prefix = f"tile/{key.level}/{key.row}/{key.column}/"
        told, wanted = (
            json.loads(some.pop(f"{prefix}header").tobytes()) for some in (stored, expected)
        )
        assert told["geometry"] == wanted["geometry"]
        assert told["slices"].items() <= wanted["slices"].items()
        assert told["ranges"]["speed"] == list(view.scene.scalar_range("speed"))
        for name, array in stored.items():
            # Velocities have single precision in a store.
            np.testing.assert_allclose(array, expected.pop(name), rtol=1e-5, atol=1e-5)
        traced = [name for name in expected if "/scalars/" in name]
        assert len(traced) == (7 if make is flat else 1)
        for name in traced:
            when, number = (*name.removeprefix(prefix).split("/")[1:], "0")[:2]
            rows, columns = expected[name].shape
            values = own["values"][(int(when), *at, int(number))]
            np.testing.assert_allclose(
                values[:rows, :columns], expected.pop(name), rtol=1e-5, atol=1e-5
            )
        assert {name.removeprefix(prefix).split("/")[0] for name in expected} == {"slices", "extra"}
    root = group[str(view.scene.pyramid.depth)]
    for step in steps:
        wanted = view.page_data().step(step)[f"scalars/{step}"]
        np.testing.assert_allclose(root["values"][step, 0, 0, 0], wanted, rtol=1e-5, atol=1e-5)


def test_a_tile_of_which_nothing_is_drawn_says_so(tmp_path: Path) -> None:
    field = flat()
    valid = field.valid.copy()
    valid[:, 62:] = False
    field = replace(field, valid=valid, velocity=np.where(valid[..., None], field.velocity, 0.0))
    build(field, tmp_path / "a.zarr", levels="all", progress=False)
    pyramid = Pyramid(field)
    group = zarr.open_group(tmp_path / "a.zarr", mode="r")
    empty = [key for key in pyramid.children(None) if pyramid.textures(key) is None]
    assert empty
    for _, row, column in empty:
        (told,) = opened(group["0/surface"][row, column].tobytes()).values()
        assert json.loads(told.tobytes()) is None
