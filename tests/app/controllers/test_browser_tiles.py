"""Tiles that the application hands to a browser that draws."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest

pytest.importorskip("trame_rca")

from aiohttp import web

import flowtex
from flowtex.app import FlowApp
from flowtex.rendering.webgl.protocol import file_infos
from flowtex.tiles import Pyramid

pytestmark = pytest.mark.usefixtures("opengl")


def parts_of(answer: web.StreamResponse) -> dict[str, list[int]]:
    """Names and shapes of the arrays in a file."""
    assert isinstance(answer, web.Response)
    body = answer.body
    assert isinstance(body, bytes)
    return {info["name"]: info["shape"] for info in file_infos(body)[0]}


def test_a_tile_is_made_when_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 10_000)
    y, x = np.mgrid[-1:1:200j, -1:1:300j]
    field = flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack([-y, x], -1))
    app = FlowApp(field, samples=3)
    app.stream.update_size("test", {"w": 96, "h": 64, "p": 1})
    app.state.set(rendering="browser")
    app.controllers.browser.take_renderer()
    source: Any = app.state.get("client_source")
    assert source["header"]["pyramid"]["shapes"] == [[200, 300], [101, 151], [51, 76]]
    stem = source["parts"].rsplit("/", 1)[1]

    async def ask(name: str) -> dict[str, list[int]]:
        return parts_of(await app.controllers.browser._routes.answer(stem + name))

    found = asyncio.run(ask("0,0,1.0"))
    assert found["tile/0/0/1/scalars/0"] == [200, 44]
    assert {"header", "padded", "unit", "flow/0"} <= {name.split("/", 4)[4] for name in found}
    assert {"mesh", "places", "padded"} <= asyncio.run(ask("whole")).keys()
    assert asyncio.run(ask("whole.0")).keys() == {"flow/0", "scalars/0"}
    for name in ("", "0,0.0", "0,0,1.7", "0,0,x.0", "whole.7", "part"):
        with pytest.raises(web.HTTPNotFound):
            asyncio.run(ask(name))
    for _ in range(2):  # told once
        with pytest.raises(web.HTTPNotFound):
            asyncio.run(ask("0,5,5.0"))
    (record,) = caplog.records
    assert "there is no tile (0, 5, 5)" in record.getMessage()
    with monkeypatch.context() as patch:
        patch.setattr(Pyramid, "textures", None)
        with pytest.raises(web.HTTPNotFound):
            asyncio.run(ask("0,0,0.0"))
    # What was wrong was the network, which is there again when it is asked for later.
    assert "tile/0/0/0/scalars/0" in asyncio.run(ask("0,0,0.0"))
    app.controllers.browser.leave()
    with pytest.raises(web.HTTPNotFound):
        asyncio.run(ask("0,0,1.0"))
    app.close()


def test_tiles_in_other_colours_are_not_traced_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 10_000)
    y, x = np.mgrid[-1:1:200j, -1:1:300j]
    points, velocity = np.stack([x, y], -1), np.stack([-y, x], -1)
    app = FlowApp(flowtex.FlowField.from_arrays(points, velocity, scalars={"p": x}), samples=3)
    app.stream.update_size("test", {"w": 96, "h": 64, "p": 1})
    app.state.set(rendering="browser")
    app.controllers.browser.take_renderer()
    routes = app.controllers.browser._routes

    def ask() -> dict[str, list[int]]:
        stem = source()["parts"].rsplit("/", 1)[1]
        return parts_of(asyncio.run(routes.answer(stem + "0,0,1.0")))

    def source() -> Any:
        return app.state.get("client_source")

    assert "tile/0/0/1/scalars/0" in ask()
    first = source()
    monkeypatch.setattr(flowtex.textures.TextureSet, "layers", None)
    app.area.scalars = "p"
    app.controllers.browser.follow()
    assert source()["parts"] != first["parts"]
    assert source()["header"]["generation"] == first["header"]["generation"]
    assert source()["header"]["scalars"]["name"] == "p"
    assert "tile/0/0/1/scalars/0/1" in ask()
    app.close()
