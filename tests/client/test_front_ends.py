"""One table of flows: range, unit, name, colours and masked areas in every front end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LogNorm, Normalize, PowerNorm
from matplotlib.figure import Figure
from webgl_page import ClientPage, packed

import flowtex
from flowtex import FlowField, FlowWidget
from flowtex.host.view import WebView
from flowtex.plotting import component  # noqa: F401  which PyVista finds by its entry point
from flowtex.rendering.camera import Camera
from flowtex.scene.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("opengl")]

SIZE = (400, 200)
#: The surface is from (0, 0) to (1, 0.5), and its left quarter has no data in some of the flows.
HEIGHT, EDGE = 0.5, 0.25
CAMERA = Camera((0.5, 0.25, 1), (0.5, 0.25, 0), (0, 1, 0), parallel=True, parallel_scale=0.25)
#: Colours of what has no data, and of values that are missing.
GROUND, MISSING = (255, 0, 255), (255, 255, 0)
COLOURS: dict[str, Any] = {"strength": 0.0, "lighting": False, "nan_color": "yellow"}
#: Columns of pixels that are compared, away from the edge and the borders, and the row.
COLUMNS, ROW = np.r_[8:85, 120:390], 100


@dataclass(frozen=True)
class Case:
    """A flow, and what every front end shows of it."""

    flow: Callable[[], Any]
    limits: tuple[float, float]
    title: str
    values: Callable[[Any], Any]  #: The values along x, from 0 to 1.
    options: dict[str, Any] = field(default_factory=dict)
    #: Colour of the left quarter, where it is not that of the values.
    left: tuple[int, int, int] | None = None
    norm: Any = None


def sheet(speed: Callable[[Any], Any], **options: Any) -> Callable[[], FlowField]:
    """Return what makes a sheet with a speed along x, and a scalar p that grows from 2 to 6."""

    @cache
    def make() -> FlowField:
        x, y = np.linspace(0, 1, 41), np.linspace(0, HEIGHT, 21)
        across = np.broadcast_to(x, (21, 41))
        velocity = np.stack([speed(across), np.zeros((21, 41))], axis=-1)
        p = np.where((across < EDGE) & options.get("hollow", False), np.nan, 2 + 4 * across)
        valid = ~((across < EDGE) & options.get("blank", False))
        words = {k: v for k, v in options.items() if k not in ("hollow", "blank")}
        scalars, units = {"p": p}, {"p": "Pa"}
        return FlowField.from_arrays(
            (x, y), velocity, valid=valid, scalars=scalars, units=units, **words
        )

    return make


@cache
def volume() -> pv.ImageData:
    """A volume of the same width and height, in which U and B also grow with z."""
    grid = pv.ImageData(dimensions=(41, 21, 5), spacing=(1 / 40, HEIGHT / 20, 0.25))
    x, _, z = grid.points.T
    grid["U"] = np.stack([3 * (1 + x) * (1 + z), 0 * x, 4 * (1 + x) * (1 + z)], axis=-1)
    grid["B"] = np.stack([x, 2 * x, 2 * x], axis=-1)
    return grid


CUT: dict[str, Any] = {"vectors": "U", "slice": "z=0.5"}
CASES = {
    "speed with a unit": Case(
        sheet(lambda x: 1 + x, length_unit="m", time_unit="s"),
        (1, 2),
        "speed (m/s)",
        lambda x: 1 + x,
    ),
    "vectors that are no velocity": Case(
        sheet(lambda x: 1 + x, vectors="B", velocity_unit="T"), (1, 2), "|B| (T)", lambda x: 1 + x
    ),
    "blanked nodes": Case(
        sheet(lambda x: 1 + x, blank=True),
        (2 + 4 * EDGE, 6),
        "p (Pa)",
        lambda x: 2 + 4 * x,
        {"scalars": "p"},
        GROUND,
    ),
    "missing values": Case(
        sheet(lambda x: 1 + x, hollow=True),
        (2 + 4 * EDGE, 6),
        "p (Pa)",
        lambda x: 2 + 4 * x,
        {"scalars": "p"},
        MISSING,
    ),
    "limits": Case(
        sheet(lambda x: 1 + x),
        (3, 5),
        "p (Pa)",
        lambda x: 2 + 4 * x,
        {"scalars": "p", "clim": (3, 5)},
    ),
    "logarithm": Case(
        sheet(lambda x: 1 + x),
        (2, 6),
        "p (Pa)",
        lambda x: 2 + 4 * x,
        {"scalars": "p", "log_scale": True},
        norm=LogNorm(2, 6),
    ),
    "norm": Case(
        sheet(lambda x: 1 + x),
        (2, 6),
        "p (Pa)",
        lambda x: 2 + 4 * x,
        {"scalars": "p", "norm": PowerNorm(0.5)},
        norm=PowerNorm(0.5, 2, 6),
    ),
    "full vectors on a slice": Case(
        volume, (5, 20), "speed", lambda x: 7.5 * (1 + x), {**CUT, "scalars": "U"}
    ),
    "one component on a slice": Case(
        volume, (4, 16), "U_z", lambda x: 6 * (1 + x), {**CUT, "scalars": "U", "component": "z"}
    ),
    "other vectors on a slice": Case(
        volume, (0, 3), "|B|", lambda x: 3 * x, {**CUT, "scalars": "B"}
    ),
    "speed in a slice": Case(volume, (3, 12), "speed in the surface", lambda x: 4.5 * (1 + x), CUT),
}
pytestmark.append(pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"))


def check_colours(case: Case, row: Any, middles: Any = None) -> None:
    """Compare a row of pixels with matplotlib's colours, and the left quarter."""
    x = (COLUMNS + 0.5) / SIZE[0] if middles is None else middles
    norm = case.norm or Normalize(*case.limits)
    wanted = 255 * colormaps["viridis"](norm(case.values(x)))[:, :3]
    if case.left is not None:
        wanted[x < EDGE - 1 / 40] = case.left
    off = np.abs(np.asarray(row, dtype=float)[..., :3] - wanted).max(axis=-1)
    between = (x > EDGE - 1 / 30) & (x < EDGE + 1 / 30)
    # A colour may begin half a pixel aside.
    assert (off[~between] > 6).mean() < 0.02


@pytest.mark.parametrize("name", CASES)
def test_images_and_plotters(name: str) -> None:
    case = CASES[name]
    options: Any = {**COLOURS, **case.options}
    view: dict[str, Any] = {"camera": CAMERA, "background": GROUND, "show_scalar_bar": False}
    picture = flowtex.render(case.flow(), size=SIZE, **view, **options)
    check_colours(case, picture[ROW, COLUMNS])
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.background_color = GROUND
    handle = plotter.flowtex.add(case.flow(), **options)
    plotter.disable_anti_aliasing()
    assert handle.actor.mapper.scalar_range == pytest.approx(case.limits)
    (bar,) = plotter.scalar_bars.values()
    assert bar.GetTitle() == case.title
    handle.show_scalar_bar = False
    plotter.camera_position = [CAMERA.position, CAMERA.focal_point, CAMERA.up]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = CAMERA.parallel_scale
    check_colours(case, plotter.screenshot(return_img=True)[ROW, COLUMNS])
    plotter.close()


@pytest.mark.parametrize("name", CASES)
def test_axes(name: str) -> None:
    case = CASES[name]
    figure = Figure(figsize=(4, 2.5))
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_subplot(facecolor=np.divide(GROUND, 255), xlim=(0, 1))
    image = flowtex.axes(axes, case.flow(), **{**COLOURS, **case.options})
    assert image.colour_label == case.title
    assert image.get_clim() == pytest.approx(case.limits)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    box = axes.get_window_extent()
    columns = np.arange(int(box.x0) + 5, int(box.x1) - 5)
    middles = (columns + 0.5 - box.x0) / box.width
    check_colours(case, pixels[len(pixels) - round((box.y0 + box.y1) / 2), columns], middles)


def check_header(case: Case, header: Any) -> None:
    scalars = header["scalars"]
    unit = f" ({scalars['unit']})" if scalars["unit"] else ""
    assert scalars["label"] + unit == case.title
    assert (scalars["low"], scalars["high"]) == pytest.approx(case.limits)


@pytest.mark.parametrize("name", CASES)
def test_pages_and_widgets(client: ClientPage, name: str) -> None:
    case = CASES[name]
    options: Any = {**COLOURS, **case.options}
    widget = FlowWidget(case.flow(), **options)
    check_header(case, widget._header)
    widget.close()
    view = WebView(Scene.of(case.flow(), samples=5, **options), background=GROUND)
    data = view.page_data()  # of pages and exports
    header = data.header(view.scene.settings, camera=CAMERA.to_dict()) | {"axes": "none"}
    check_header(case, header)
    viewer = client.mount(packed(data, header), (600, 400), density=1)
    pixels = client.picture(viewer)
    height, width = pixels.shape[:2]
    x = 0.5 + (np.arange(width) + 0.5 - width / 2) / height * HEIGHT
    seen = (x > 0.02) & (x < 0.98)
    check_colours(case, pixels[height // 2, seen], x[seen])
    name_of = "(n) => viewers[n].root.shadowRoot.querySelector('.legend .name').textContent"
    assert client.page.evaluate(name_of, viewer) == case.title
