"""What a store has for browsers is what a server would hand them."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from flows import ring
from packed import parts_of

from flowtex import FlowField
from flowtex._util.array_types import AnyArray
from flowtex.field.derived.quantities import steps_of
from flowtex.host.view import web_views
from flowtex.pyramid import build, layout
from flowtex.rendering.webgl.client_data import tile_parts
from flowtex.scene.options import Options
from flowtex.textures.tiles.grid_pyramid import GridPyramid

zarr = pytest.importorskip("zarr")


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1250)


def flat() -> FlowField:
    """Three times of a stream past an island, with a scalar that varies and one that does not."""
    y, x = np.mgrid[0:40, 0:70].astype(float) / 25
    steps = [np.stack([np.cos(3 * y + t), np.sin(4 * x - t)], axis=-1) for t in (0.0, 0.1, 0.2)]
    scalars = {"heat": np.stack([x, x + 1, x * y]), "depth": x * y}
    valid = np.hypot(x - 1.3, y - 1.2) > 0.4
    return FlowField.from_arrays(
        np.stack([x, y], -1), np.stack(steps), times=[0, 0.1, 0.2], valid=valid, scalars=scalars
    )


def opened(group: Any, name: str, *at: int) -> dict[str, AnyArray]:
    """Read a file of parts as the client does."""
    parts = parts_of(group[name][(*at, slice(layout.FILE_CHUNK))].tobytes())
    assert parts.pop("of").tobytes().decode() == group.attrs["flowtex"]["fingerprint"]
    return parts


@pytest.mark.parametrize("make", [flat, ring])
def test_parts_are_those_of_a_page(tmp_path: Path, make: Any) -> None:
    field = make()
    build(field, tmp_path / "a.zarr", progress=False)
    group = zarr.open_group(tmp_path / "a.zarr", mode="r")
    (view,) = web_views(field, Options.split())
    whole, steps = replace(view.page_data(), traces=True), range(len(field.times))
    pyramid = whole.pyramid
    assert pyramid is not None
    exactly: dict[str, Any] = {"rtol": 1e-3, "atol": 1e-4}
    for key in pyramid.children(None):
        textures = pyramid.textures(key)
        assert textures is not None
        tile = whole.tile(textures, partial(steps_of, textures.geometry.field))
        expected, at = tile_parts(key, tile, *steps), (key.row, key.column)
        stored = opened(group, f"{key.level}/surface", *at)
        prefix = f"tile/{key.level}/{key.row}/{key.column}/"
        for step in steps:
            stored |= opened(group, f"{key.level}/flow", step, *at)
            speed = expected.pop(f"{prefix}scalars/{step}")
            rows, columns = textures.grid.drawn
            flow = stored[f"{prefix}flow/{step}"][rows, columns, -1].astype(float)
            own = flow * textures.typical_speed
            shown = textures.geometry.field.valid[rows, columns]
            np.testing.assert_allclose(own[shown], speed[shown], rtol=2**-8, atol=1e-4)
            for number, name in enumerate(field.scalars, start=1):
                if step < len(field.scalars[name]):
                    file = opened(group, f"{key.level}/values", step, *at, number)
                    wanted = f"{prefix}scalars/{step}/{number}"
                    (values,) = file.values()
                    np.testing.assert_allclose(values, expected.pop(wanted), **exactly)
        told, other = (
            json.loads(some.pop(f"{prefix}header").tobytes()) for some in (stored, expected)
        )
        assert told["geometry"] == other["geometry"]
        assert told["slices"]["trace"]["nodes"] == other["slices"]["trace"]["nodes"]
        assert stored.keys() == expected.keys()
        assert {name.removeprefix(prefix).split("/")[0] for name in stored} >= {"padded", "flow"}
        for name, array in stored.items():
            # Errors of colours are shares of a range, which is narrow on the cone.
            near = {"atol": 0.02} if name.endswith("mesh") else exactly
            if "/flow/" in name:  # rounded further
                near = {"rtol": 2**-8, "atol": 2**-8}
            np.testing.assert_allclose(array, expected[name], **near)


def test_a_tile_of_which_nothing_is_drawn_says_so(tmp_path: Path) -> None:
    field = flat()
    valid = field.valid.copy()
    valid[:, 62:] = False
    field = replace(field, valid=valid, velocity=np.where(valid[..., None], field.velocity, 0.0))
    build(field, tmp_path / "a.zarr", progress=False)
    pyramid = GridPyramid(field)
    group = zarr.open_group(tmp_path / "a.zarr", mode="r")
    empty = [key for key in pyramid.children(None) if pyramid.textures(key) is None]
    assert empty
    for _, row, column in empty:
        (told,) = opened(group, "0/surface", row, column).values()
        assert json.loads(told.tobytes()) is None
        assert opened(group, "0/flow", 0, row, column) == {}
