"""PyVista's backend ``"flowtex"``, with PyVista's own way of choosing one, without a notebook."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("anywidget")

import pyvista as pv
import pyvista.jupyter as registry
from PIL import Image

from flowtex import examples
from flowtex._util.colours import colour_table
from flowtex.host.flow_widget import FlowWidget


@pytest.fixture
def notebook(opengl: Any) -> Iterator[Any]:
    """Yield a plotter that believes to be in a notebook."""
    plotter: Any = pv.Plotter(notebook=True, window_size=[120, 80])
    yield plotter
    plotter.close()


@pytest.fixture
def only_flowtex(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have no other backend installed; PyVista then takes the first that it finds."""
    pv.registered_jupyter_backends()
    only = {"flowtex": registry._custom_backends["flowtex"]}
    monkeypatch.setattr(registry, "_custom_backends", only)
    monkeypatch.setattr("pyvista.jupyter.notebook._custom_backends", only)


def add(plotter: Any, **options: Any) -> Any:
    return plotter.flowtex.add(
        examples.double_gyre_field(), samples=9, show_scalar_bar=False, **options
    )


def shown(plotter: Any, **options: Any) -> Any:
    return plotter.show(return_viewer=True, **options)


def test_a_widget_looks_as_the_plotter(notebook: Any) -> None:
    notebook.set_background("black")
    handle = add(notebook, cmap="cividis", clim=(0.0, 0.2))
    notebook.camera.position = (1.5, 0.5, 9.0)
    notebook.camera.focal_point = (1.5, 0.5, 0.0)
    notebook.camera.parallel_scale = 0.125
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)  # old ipywidgets use what is deprecated today
        widget = shown(notebook, jupyter_backend="flowtex")
    assert isinstance(widget, FlowWidget)
    assert dict(widget.settings) == dict(handle.settings)
    assert widget.settings is not handle.settings
    header = widget._header
    assert (header["scalars"]["low"], header["scalars"]["high"]) == (0.0, 0.2)
    assert header["background"] == [0, 0, 0]
    assert widget.size == [120, 80]
    assert widget.camera["parallel"]
    assert widget.camera["parallel_scale"] == 0.125
    np.testing.assert_allclose(widget.camera["focal_point"], (1.5, 0.5, 0.0))
    table = widget._views[0].data().colours.scale.table
    assert table is not None
    np.testing.assert_array_equal(table[:, :3], colour_table("cividis")[:, :3])
    widget.close()


def test_what_stands_beside_the_flow_comes_along(notebook: Any) -> None:
    add(notebook)
    notebook.add_mesh(pv.Sphere(), name="ball")
    notebook.add_text("words", name="words")
    with pytest.warns(UserWarning, match=r"does not show: 'words' \(vtk.*Another jupyter_backend"):
        widget = shown(notebook, jupyter_backend="flowtex")
    [faces] = [run["faces"] for run in widget._header["bodies"]["runs"] if run["faces"][1]]
    assert faces == [0, 1680]
    widget.close()


def test_without_a_flow_it_says_how_to_add_one(notebook: Any) -> None:
    notebook.add_mesh(pv.Sphere())
    with pytest.raises(ValueError, match=r"^this plotter has no flow texture; add one"):
        shown(notebook, jupyter_backend="flowtex")


@pytest.mark.usefixtures("only_flowtex")
def test_it_does_not_become_the_default(notebook: Any) -> None:
    assert registry._resolve_backend() == "flowtex"
    add(notebook)
    picture = shown(notebook)
    assert isinstance(picture, Image.Image)


def test_the_theme_can_ask_for_it(notebook: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook.theme, "_jupyter_backend", "flowtex")
    add(notebook)
    widget = shown(notebook)
    assert isinstance(widget, FlowWidget)
    widget.close()


@pytest.mark.usefixtures("only_flowtex")
@pytest.mark.parametrize("name", ["trame", "client", "server", "html"])
def test_a_named_backend_that_is_missing_is_an_error(notebook: Any, name: str) -> None:
    add(notebook)
    with (
        pytest.warns(UserWarning, match="No handler registered"),
        pytest.raises(ModuleNotFoundError, match=rf"'{name}', which needs trame-pyvista"),
    ):
        shown(notebook, jupyter_backend=name)
