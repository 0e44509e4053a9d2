"""Arrays by position in every function that draws a flow."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats

LINE_X, LINE_Y = np.linspace(0, 3, 7), np.linspace(2, -1, 9)  # from above, as in an image
X, Y = np.meshgrid(LINE_X, LINE_Y)
U, V = 1 - Y, X + 0.5 * Y
ARRAYS = LINE_X, LINE_Y, U, V
SMALL: dict[str, Any] = {"samples": 5}

opengl = pytest.mark.usefixtures("opengl")


def check(field: FlowField) -> None:
    np.testing.assert_array_equal(field.points[..., :2], np.stack([X, Y], axis=-1))
    np.testing.assert_array_equal(field.velocity[0][..., :2], np.stack([U, V], axis=-1))


@opengl
def test_pictures_are_those_of_the_field() -> None:
    field = FlowField.from_arrays(*ARRAYS)
    drawing: dict[str, Any] = {"size": (90, 60), **SMALL}
    expected = flowtex.render(field, **drawing)
    for mesh in (ARRAYS, (ARRAYS,), (LINE_X, LINE_Y, U + 1j * V)):
        assert np.array_equal(flowtex.render(*mesh, **drawing), expected)
    assert flowtex.extent(*ARRAYS, size=(90, 60)) == flowtex.extent(field, size=(90, 60))


@opengl
def test_plotters_take_arrays() -> None:
    plotter = pv.Plotter(off_screen=True)
    handle = plotter.flowtex.add(*ARRAYS, scalars=X, **SMALL)
    check(handle.field)
    assert np.array_equal(handle.field.scalars["Data"][0], X)
    handle.scalars = "speed"
    handle.set_surface((LINE_X, LINE_Y, 2 * U, 2 * V))
    assert np.array_equal(handle.field.velocity[0][..., 0], 2 * U)
    plotter.close()


def test_widgets_take_arrays() -> None:
    pytest.importorskip("anywidget")
    widget = flowtex.FlowWidget(*ARRAYS, cmap="magma", **SMALL)
    check(widget.field)
    assert widget.cmap == "magma"
    widget.field = (LINE_X, LINE_Y, 2 * U, 2 * V)
    assert np.array_equal(widget.field.velocity[0][..., 0], 2 * U)
    widget.close()


def test_pages_take_arrays(tmp_path: Path) -> None:
    series = LINE_X, LINE_Y, np.stack([U] * 3), np.stack([V] * 3)
    page = flowtex.export(*series, tmp_path / "flow.html", times=[0, 1, 3], **SMALL)
    assert page.steps == 3 and page.path.stat().st_size == page.nbytes
    assert flowtex.export(*ARRAYS, path=tmp_path / "flow.html", **SMALL).steps == 1


@opengl
def test_movies_take_arrays(tmp_path: Path) -> None:
    written = flowtex.movie(*ARRAYS, tmp_path / "flow.gif", size=(48, 32), seconds=0.1, **SMALL)
    assert written.frames == 2


def test_show_takes_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    from flowtex.host import show

    shown: list[Any] = []
    found: Callable[..., None] = lambda mesh, size, options: shown.append((mesh, options))  # noqa: E731
    monkeypatch.setattr("flowtex.rendering.diagnostics.has_display", lambda: True)
    monkeypatch.setattr("flowtex.rendering.diagnostics.require_opengl", lambda: None)
    monkeypatch.setattr("flowtex.rendering.diagnostics.prefer_headless", lambda: None)
    monkeypatch.setattr(show, "_show_window", found)
    flowtex.show(*ARRAYS, cmap="magma")
    ((mesh, options),) = shown
    assert all(one is other for one, other in zip(mesh, ARRAYS, strict=True))
    assert options == {"cmap": "magma"}


def brightest(figure: Figure, ax: Any) -> Floats:
    """Return the middle of the bright pixels inside axes, in data coordinates."""
    figure.canvas.draw()
    shot = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3].astype(float).sum(axis=-1)  # type: ignore[attr-defined]
    box = ax.get_window_extent()
    left, bottom = round(box.x0) + 3, round(box.y0) + 3
    inside = shot[bottom : round(box.y1) - 3, left : round(box.x1) - 3]
    rows, columns = np.indices(inside.shape)
    weights = np.where(inside > 0.5 * inside.max(), inside, 0)
    place = [np.average(part, weights=weights) for part in (columns + left, rows + bottom)]
    return np.asarray(ax.transData.inverted().transform(np.array(place) + 0.5))


@opengl
@pytest.mark.parametrize("nodes", [(0, 1), (1, 0)], ids=["rows", "columns"])
@pytest.mark.parametrize("turned", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_nodes_lie_where_quiver_has_them(turned: tuple[int, int], nodes: tuple[int, int]) -> None:
    figure = Figure(figsize=(6, 3), dpi=100)
    FigureCanvasAgg(figure)
    ours, theirs = figure.subplots(1, 2)
    x, y = np.meshgrid(np.linspace(0, 3, 7)[:: turned[0]], np.linspace(-1, 2, 9)[:: turned[1]])
    x, y = x.transpose(nodes), y.transpose(nodes)
    light = np.zeros(x.shape)
    light[2, 1] = 1
    look: dict[str, Any] = {"cmap": "gray", "strength": 0.0, "lighting": False, "samples": 3}
    flowtex.axes(ours, x, y, np.ones(x.shape), np.ones(x.shape), scalars=light, **look)
    theirs.set(xlim=ours.get_xlim(), ylim=ours.get_ylim(), facecolor="black")
    only = np.where(light > 0, 40.0, np.nan)
    theirs.quiver(x, y, only, 0 * light, color="white", pivot="mid", scale=200)
    pixel = 3.0 / ours.get_window_extent().width
    found, expected = brightest(figure, ours), brightest(figure, theirs)
    assert expected == pytest.approx([x[2, 1], y[2, 1]], abs=3 * pixel)
    assert found == pytest.approx(expected, abs=3 * pixel)
