"""Norms of matplotlib: the colours of images and of bars, where VTK draws."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Normalize, PowerNorm
from matplotlib.figure import Figure
from normed import HEIGHT, HIGH, LOW, NORMS, PLAIN, differences, ramp

import flowtex
from flowtex import FieldError
from flowtex.plotting import component  # noqa: F401  which PyVista finds by its entry point

pytestmark = pytest.mark.usefixtures("opengl")

SIZE = (400, 200)
#: A curve, a function of both signs, and steps.
SOME = ("log", "two slopes", "function", "open boundaries")
#: Middles of the pixels of an image of the whole surface.
MIDDLES = (np.arange(SIZE[0]) + 0.5) / SIZE[0]


def row_of(**options: Any) -> Any:
    return flowtex.render(ramp(), size=SIZE, margin=0, **PLAIN, **options)[SIZE[1] // 2]


@pytest.mark.parametrize("name", NORMS)
def test_an_image_has_the_colours_of_its_norm(name: str) -> None:
    norm = NORMS[name]()
    assert differences(row_of(norm=norm), MIDDLES, norm).max() < 2


@pytest.mark.parametrize("name", SOME)
def test_a_norm_that_is_set_later_draws_a_plotter_anew(name: str) -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.disable_anti_aliasing()
    handle = plotter.flowtex.add(ramp(), cmap="magma", show_scalar_bar=False, **PLAIN)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = HEIGHT / 2
    plotter.screenshot(return_img=True)
    handle.norm = norm = NORMS[name]()
    row = plotter.screenshot(return_img=True)[SIZE[1] // 2]
    assert differences(row, MIDDLES, norm, "magma").max() < 2
    table = handle.actor.mapper.lookup_table
    assert table.n_values >= 1020 or "boundaries" in name
    handle.clim = (0, 10)  # in place of the norm
    assert handle.norm is None
    row = plotter.screenshot(return_img=True)[SIZE[1] // 2]
    assert differences(row, MIDDLES, Normalize(0, 10), "magma").max() < 2
    plotter.close()


def axes_row(image: Any, figure: Any) -> tuple[Any, Any]:
    """Return pixels along the middle of axes, and their x."""
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())
    box = image.axes.get_window_extent()
    columns = np.arange(int(box.x0) + 3, int(box.x1) - 3)
    y = round((box.y0 + box.y1) / 2)
    places = np.stack([columns + 0.5, np.full(len(columns), y)], axis=-1)
    x = image.axes.transData.inverted().transform(places)[:, 0]
    return pixels[len(pixels) - y, columns, :3], x


@pytest.mark.parametrize("name", SOME)
def test_axes_follow_a_norm_and_its_limits(name: str) -> None:
    figure = Figure(figsize=(4, 2.5))
    FigureCanvasAgg(figure)
    image = flowtex.axes(figure.add_subplot(), ramp(), **PLAIN)
    figure.colorbar(image)
    figure.canvas.draw()
    norm: Any = NORMS[name]()
    image.set_norm(norm)
    assert image.norm is norm
    assert differences(*axes_row(image, figure), norm).max() < 2
    image.set_cmap("magma")
    if name not in ("boundaries", "open boundaries", "centred"):
        image.set_clim(1, 50)
        limited: Any = image.norm
        limited.vmax = 60
    assert differences(*axes_row(image, figure), norm, "magma").max() < 2


def test_missing_limits_are_those_of_the_values() -> None:
    whole = PowerNorm(0.5, LOW, HIGH)
    assert differences(row_of(norm=PowerNorm(0.5)), MIDDLES, whole).max() < 2
    image = flowtex.axes(Figure().add_subplot(), ramp(), norm=(norm := PowerNorm(0.5)), **PLAIN)
    assert image.norm is norm and (norm.vmin, norm.vmax) == (LOW, HIGH)
    image.set_norm("symlog")
    assert image.get_clim() == (LOW, HIGH)


def test_a_norm_that_decreases_raises_and_the_axes_stay() -> None:
    class Falling(Normalize):
        def __call__(self, value: Any, clip: bool | None = None) -> Any:
            return 1 - super().__call__(value, clip)

    image = flowtex.axes(Figure().add_subplot(), ramp(), **PLAIN)
    before = image.norm
    with pytest.raises(FieldError, match="Falling from -20 to 80, which does not increase"):
        image.set_norm(Falling())
    assert image.norm is before


def test_colours_are_few_reversed_and_beyond_the_range_as_in_pyvista() -> None:
    options: dict[str, Any] = {"clim": (0, 50), "n_colors": 5, "flip_scalars": True}
    beyond: dict[str, Any] = {"below_color": "red", "above_color": "blue", "nan_color": "lime"}
    row = row_of(cmap="plasma", **options, **beyond).astype(int)
    table = pv.LookupTable("plasma", n_values=5)
    values = LOW + (HIGH - LOW) * MIDDLES
    inside = np.asarray(table.values[::-1])[(np.clip(values / 50, 0, 0.999) * 5).astype(int), :3]
    wanted = np.where((values < 0)[:, None], (255, 0, 0), inside)
    wanted = np.where((values > 50)[:, None], (0, 0, 255), wanted)
    assert (np.abs(row - wanted).max(axis=-1) > 1).mean() < 0.02
    field = ramp()
    holes = np.where(field.points[..., 0] < 0.5, np.nan, 1.0)
    hollow = flowtex.FlowField.from_arrays(field.points, field.velocity, scalars={"p": holes})
    row = flowtex.render(hollow, size=SIZE, margin=0, **PLAIN, **beyond)[100]
    assert (row[:180] == (0, 255, 0)).all() and not (row[220:] == (0, 255, 0)).all(axis=-1).any()


def test_the_bar_of_a_norm_has_its_values_at_its_places() -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.flowtex.add(ramp(), scalars="p", norm=NORMS["boundaries"]())
    (bar,) = plotter.scalar_bars.values()
    table = bar.GetLookupTable()
    assert list(table.annotations.values()) == ["-20", "-10", "0", "5", "7", "60", "80"]
    np.testing.assert_allclose(list(table.annotations), np.linspace(0, 1, 7), atol=1e-9)
    plotter.close()
