"""A flow in HoloViews, drawn again for what a plot shows of it: `make integrations`."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_docs import code_blocks, era5

import flowtex

hv = pytest.importorskip("holoviews", reason="make integrations")
hv.extension("bokeh")

SIZE = (160, 120)
LOOK: dict[str, Any] = {"samples": 9, "cmap": "viridis"}


def seen(flow: Any, x: tuple[float, float], y: tuple[float, float], *time: Any) -> Any:
    """Look at a part of a flow, and return the element that is drawn."""
    ranges, size = flow.streams
    ranges.event(x_range=x, y_range=y)
    size.event(width=SIZE[0], height=SIZE[1], scale=1.0)
    return flow[time] if time else flow[()]


def test_the_lines_of_figures_md_run(
    opengl: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pyproj")
    monkeypatch.chdir(tmp_path)
    era5(tmp_path / "era5.nc")
    flowtex.examples.ocean().isel(time=slice(2)).to_netcdf("currents.nc")
    pages = Path(__file__).parents[2] / "docs" / "howto" / "figures.md"
    (code,) = (block.code for block in code_blocks(pages) if "holoviews" in block.code)
    page: dict[str, Any] = {"flowtex": flowtex}
    exec(compile(code, pages.name, "exec"), page)
    time = page["currents"].kdims[0].values[0]
    assert len(np.unique(pixels(page["currents"][time])[..., :3])) > 50
    assert hv.render(page["winds_on_tiles"]) is not None


def pixels(element: Any) -> Any:
    """Return the channels (H, W, 4), row 0 at the top."""
    return np.stack([element.dimension_values(n, flat=False) for n in range(2, 6)], -1)[::-1]


def test_a_part_is_drawn_as_render_draws_it(opengl: Any) -> None:
    field = flowtex.examples.double_gyre_field(shape=(33, 65))
    flow = flowtex.dynamic_map(field, **LOOK)
    view: dict[str, Any] = {"zoom": 4.0, "focus": (0.6, 0.4), "size": SIZE}
    left, right, bottom, top = flowtex.extent(field, **view)
    element = seen(flow, (left, right), (bottom, top))
    assert element.bounds.lbrt() == pytest.approx((left, bottom, right, top))
    picture = flowtex.render(field, show_scalar_bar=False, **view, **LOOK)
    own = pixels(element)
    assert (own[..., 3] == 255).all()
    off = np.abs(own[..., :3].astype(int) - picture)
    assert np.corrcoef(own[..., :3].ravel(), picture.ravel())[0, 1] > 0.98, off.mean()


def test_nothing_is_drawn_beside_the_flow(opengl: Any) -> None:
    field = flowtex.examples.double_gyre_field(shape=(33, 65))
    own = pixels(seen(flowtex.dynamic_map(field, **LOOK), (-2, 2), (-1, 2)))
    there = own[..., 3] > 127
    assert there.mean() == pytest.approx(2 / 12, abs=0.02)
    assert (own[~there] < 128).all()
    # Edges have the colours of the flow, and no dark rim.
    edge = (own[..., 3] > 20) & (own[..., 3] < 235)
    if edge.any():
        assert own[edge][:, :3].max(axis=1).mean() > 0.5 * own[there][:, :3].max(axis=1).mean()


def test_a_series_has_a_time(opengl: Any) -> None:
    field = flowtex.examples.vortex_field().downsample(8).at_steps([0, 3])
    flow = flowtex.dynamic_map(field, **LOOK)
    (time,) = flow.kdims
    first, last = (pixels(flow[each]) for each in time.values)
    assert time.name == "time" and len(time.values) == 2
    assert np.abs(first.astype(int) - last).mean() > 2


def test_data_of_the_earth_lie_on_tiles(opengl: Any) -> None:
    pytest.importorskip("pyproj")
    importlib.import_module("flowtex.xarray")
    winds = flowtex.examples.weather().isel(latitude=slice(None, None, 3))
    flow = winds.flowtex.dynamic_map(level=500, projection="EPSG:3857", **LOOK)
    overlay = hv.element.tiles.OSM() * flow
    assert hv.render(overlay) is not None
    left, bottom, right, top = flow[()].bounds.lbrt()
    assert right - left == pytest.approx(2 * np.pi * 6.378e6, rel=0.02)
    assert -2.1e7 < bottom < top < 2.1e7
