"""Pictures in data coordinates: extents, and matplotlib axes that draw a flow."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import flowtex
from flowtex import FieldError, FlowField
from flowtex._util.array_types import Floats

pytestmark = pytest.mark.usefixtures("opengl")

#: Where a scalar goes from 0 to 1, between two columns of nodes, and between two rows.
EDGE_X, EDGE_Y = 0.525, 10.975
#: Colours alone, without the texture.
PLAIN: dict[str, Any] = {"scalars": "edge", "cmap": "gray", "strength": 0.0, "lighting": False}
PLAIN |= {"samples": 3}
AXES = np.eye(3)


def edge(right: int = 0, up: int = 1) -> FlowField:
    """A sheet of 4 x 2 from (-1, 10) along two axes of space, light to the right and above."""
    x, y = np.meshgrid(np.linspace(-1, 3, 81), np.linspace(10, 12, 41))
    points = x[..., None] * AXES[right] + y[..., None] * AXES[up]
    velocity = np.broadcast_to(AXES[right] + 0.5 * AXES[up], points.shape)
    light = ((x > EDGE_X) & (y > EDGE_Y)).astype(float)
    return FlowField.from_arrays(points, velocity, scalars={"edge": light})


def edge_of(line: Any, low: float, high: float, crossing: int = 0) -> float:
    """Where a row of pixels goes through the middle, in the coordinates of its ends."""
    values = np.asarray(line, dtype=float)
    above = values > 127.5
    n = int(np.flatnonzero(above[:-1] != above[1:])[crossing])
    share = (127.5 - values[n]) / (values[n + 1] - values[n])
    return float(low + (n + 0.5 + share) * (high - low) / len(values))


@pytest.mark.parametrize(
    ("axes", "options"),
    [
        ((0, 1), {"margin": 0, "size": (400, 200)}),
        ((0, 2), {"size": (333, 251)}),
        ((1, 2), {"zoom": 5.0, "focus": None, "size": (300, 300)}),
    ],
)
def test_an_extent_puts_an_edge_where_it_is(axes: tuple[int, int], options: dict[str, Any]) -> None:
    field = edge(*axes)
    if "focus" in options:
        options = {**options, "focus": tuple(0.6 * AXES[axes[0]] + 11.05 * AXES[axes[1]])}
    left, right, bottom, top = flowtex.extent(field, **options)
    picture = flowtex.render(field, **options, **PLAIN, background="black")[..., 0]
    height, width = picture.shape
    assert (right - left) / width == pytest.approx((top - bottom) / height)
    row = int((top - 11.1) / (top - bottom) * height)
    column = int((0.7 - left) / (right - left) * width)
    pixel = (right - left) / width
    assert edge_of(picture[row], left, right) == pytest.approx(EDGE_X, abs=0.5 * pixel)
    assert edge_of(picture[:, column], top, bottom, -1) == pytest.approx(EDGE_Y, abs=0.5 * pixel)


# --- axes ---------------------------------------------------------------------------------------


@pytest.fixture
def figure() -> Figure:
    made = Figure(figsize=(4, 3), dpi=100)
    FigureCanvasAgg(made)
    return made


def pixels(figure: Figure) -> Any:
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]


def data_edge(figure: Figure, ax: Any) -> tuple[float, float]:
    """Where the edge lies in data coordinates, read from the pixels of a figure."""
    shot = pixels(figure)[..., 0]
    height = len(shot)

    def line(along: int, start: tuple[float, float], end: tuple[float, float]) -> float:
        (x0, y0), (x1, y1) = ax.transData.transform([start, end])
        if along == 0:
            a, b = round(min(x0, x1)), round(max(x0, x1))
            at = edge_of(shot[int(height - y0), a:b], a, b)
            return float(ax.transData.inverted().transform((at, y0))[0])
        a, b = round(min(y0, y1)), round(max(y0, y1))
        at = edge_of(shot[height - b : height - a, int(x0)], b, a)
        return float(ax.transData.inverted().transform((x0, at))[1])

    return line(0, (0.3, 11.1), (0.8, 11.1)), line(1, (0.7, 10.8), (0.7, 11.15))


def test_axes_show_a_flow_where_it_is_at_every_zoom(figure: Figure) -> None:
    ax = figure.add_subplot()
    image = flowtex.axes(ax, edge(), **PLAIN)
    assert ax.get_xlim() == pytest.approx((-1, 3)) and ax.get_ylim() == pytest.approx((10, 12))
    seen = []
    for limits in (((-1, 3), (10, 12)), ((0.2, 0.9), (10.7, 11.2)), ((0.9, 0.2), (11.2, 10.7))):
        ax.set(xlim=limits[0], ylim=limits[1])
        x, y = data_edge(figure, ax)
        (x0, _), (x1, _) = ax.transData.inverted().transform([(0, 0), (1, 0)])
        assert x == pytest.approx(EDGE_X, abs=abs(x1 - x0))
        assert y == pytest.approx(EDGE_Y, abs=abs(x1 - x0))
        seen.append(image.make_image(None)[0].shape)
    box = ax.get_window_extent()
    assert seen[-1][1] == pytest.approx(box.width, abs=2)
    assert seen[-1][0] == pytest.approx(box.height, abs=2)


def test_axes_follow_time(figure: Figure) -> None:
    field = flowtex.examples.double_gyre_field(time_varying=True, shape=(11, 21))
    image = flowtex.axes(figure.add_subplot(), field, time=float(field.times[0]), samples=3)
    first = pixels(figure).copy()
    image.time = float(field.times[3])
    assert (pixels(figure) != first).any()
    with pytest.raises(ValueError, match=r"^time is -1; expected 0 to "):
        image.time = -1


def test_axes_elsewhere_are_empty_and_other_scales_are_stretched(figure: Figure) -> None:
    ax = figure.add_subplot()
    ax.set_facecolor("#ff0000")
    image = flowtex.axes(ax, edge(), **PLAIN)
    ax.set(xlim=(50, 54), ylim=(10, 12))
    pixels(figure)
    assert (image.make_image(None)[0] == (255, 0, 0, 255)).all()
    ax.set(xlim=(0.3, 0.8), ylim=(10, 12), aspect="auto")
    x, y = data_edge(figure, ax)
    assert x == pytest.approx(EDGE_X, abs=0.01) and y == pytest.approx(EDGE_Y, abs=0.02)


def test_axes_without_a_ground_are_clear_beside_a_flow(figure: Figure) -> None:
    ax = figure.add_axes((0, 0, 1, 1), facecolor="none")
    image = flowtex.axes(ax, edge(), scalars=False, color="white", strength=0, lighting=False)
    left, right, bottom, top = image.get_extent()
    ax.set(xlim=(2 * left - right, right), ylim=(2 * bottom - top, top))
    picture = image.make_image(None)[0].astype(int)
    clear = picture[..., 3] == 0
    assert 0.5 < clear.mean() < 0.95
    # Where the outline is smooth its colour is that of the flow.
    assert (picture[picture[..., 3] > 30][:, :3] > 200).all()


def test_a_colour_bar_has_the_range_and_the_colours(figure: Figure) -> None:
    ax = figure.add_subplot()
    image = flowtex.axes(ax, edge(), scalars="edge", clim=(1, 100), log_scale=True)
    bar = figure.colorbar(image)
    assert (image.norm.vmin, image.norm.vmax) == pytest.approx((1, 100))
    assert bar.ax.get_yscale() == "log"
    assert image.cmap.N == 256 and vars(image.cmap)["colorbar_extend"] == "min"
    pixels(figure)


def of_one_place(figure: Figure, image: Any) -> Any:
    """Picture of an image, whose axes leave their place to others."""
    shot = np.asarray(image.make_image(None)[0])
    image.axes.remove()
    return shot


@pytest.mark.parametrize(
    ("change", "option"),
    [
        (lambda image: image.set_cmap("magma"), {"cmap": "magma"}),
        (lambda image: image.set_alpha(0.3), {"opacity": 0.3}),
    ],
)
def test_changes_by_matplotlib_are_those_of_arguments(
    figure: Figure, change: Callable[[Any], None], option: dict[str, Any]
) -> None:
    field = flowtex.examples.double_gyre_field(shape=(11, 21))
    image = flowtex.axes(figure.add_subplot(), field, samples=3)
    image.make_image(None)
    change(image)
    shot = of_one_place(figure, image)
    expected = flowtex.axes(figure.add_subplot(), field, samples=3, **option)
    share = np.linspace(0, 1)
    np.testing.assert_array_equal(image.cmap(share), expected.cmap(share))
    np.testing.assert_array_equal(shot, of_one_place(figure, expected))


def section() -> tuple[Floats, Floats]:
    """Positions and velocity of cells in a section whose height counts by the logarithm."""
    x, y = np.meshgrid(np.linspace(-60, 60, 61), np.logspace(0, 3, 41))
    phase = np.pi * x / 30, np.pi * np.log10(y)
    velocity = 9 * np.sin(phase[0]) * np.cos(phase[1]), -0.7 * y * np.cos(phase[0])
    return np.stack([x, y], axis=-1), np.stack(velocity, axis=-1)


def drawn(ax: Axes, field: FlowField, **options: Any) -> Floats:
    """Picture of a flow in axes whose sides have units of different lengths."""
    image = flowtex.axes(ax, field, scalars=False, samples=9, **options)
    ax.set_aspect("auto")
    return np.asarray(image.make_image(None)[0], dtype=float)


def test_a_flow_on_logarithmic_axes_is_that_of_the_logarithm(figure: Figure) -> None:
    points, velocity = section()
    ours = drawn(figure.add_subplot(yscale="log"), FlowField.from_arrays(points, velocity))
    logs = np.stack([points[..., 0], np.log10(points[..., 1])], axis=-1)
    slopes = velocity / np.stack([1 + 0 * points[..., 1], np.log(10) * points[..., 1]], axis=-1)
    figure.clear()
    theirs = drawn(figure.add_subplot(), FlowField.from_arrays(logs, slopes))
    assert ours.shape == theirs.shape and theirs.std() > 20
    assert np.abs(ours - theirs).mean() < 1


def test_scales_and_limits_are_followed(figure: Figure) -> None:
    points, velocity = section()
    ax = figure.add_subplot()
    ax.set_ylim(500, 2)
    field = FlowField.from_arrays(points, velocity)
    image = flowtex.axes(ax, field, samples=5, scalars=False)
    assert ax.get_ylim() == (500, 2) and ax.get_aspect() == 1
    linear = np.asarray(image.make_image(None)[0], dtype=float)
    ax.set_yscale("log")
    ax.set_aspect("auto")
    down = image.make_image(None)[0]
    assert ax.get_ylim() == (500, 2) and np.abs(linear - down).mean() > 20
    ax.invert_yaxis()
    up = image.make_image(None)[0]
    # The axes end within a pixel, at one side or the other.
    moved = [np.roll(up[::-1, :, 0], rows, axis=0).ravel() for rows in (-1, 0, 1)]
    assert max(np.corrcoef(one, down[..., 0].ravel())[0, 1] for one in moved) > 0.97
    assert image.time == 0


def test_what_scales_do_not_have_is_blank(figure: Figure) -> None:
    y, x = np.mgrid[0:2:21j, -1:1:21j]
    field = FlowField.from_arrays(np.stack([x, y], -1), np.stack([1 + 0 * x, y], -1))
    ax = figure.add_subplot(xscale="log")
    picture = drawn(ax, field)
    assert ax.get_xlim() == pytest.approx((0.1, 1))
    assert (picture[..., :3] != 255).any(axis=-1).mean() > 0.95
    below = FlowField.from_arrays(np.stack([x - 5, y], -1), field.velocity[0])
    with pytest.raises(FieldError, match=r"^x is from -6 to -4 .*expected values that the axes"):
        flowtex.axes(figure.add_subplot(xscale="log"), below)
    for options, kind in (
        ({"yscale": "log"}, "with scales .*"),
        ({"projection": "polar"}, "polar"),
    ):
        with pytest.raises(
            FieldError, match=f"^ax is {kind}, but the data are of the Earth; expect"
        ):
            flowtex.axes(figure.add_subplot(**options), flowtex.examples.weather(), level=500)


#: What users do to polar axes.
POLAR: dict[str, Callable[[Any], Any]] = {
    "usual": lambda ax: None,
    "compass": lambda ax: (ax.set_theta_zero_location("N"), ax.set_theta_direction(-1)),
    "hole": lambda ax: ax.set_rorigin(-1),
    "logarithmic": lambda ax: ax.set_rscale("log"),
    # Beyond the flow: in its middle lines would wind without end.
    "inverted": lambda ax: ax.set_ylim(2.2, 0.5),
    "zoomed": lambda ax: ax.set_ylim(0.75, 1.25),
    "wedge": lambda ax: (ax.set_thetamin(20), ax.set_thetamax(130)),
}


def ring(least: float = 0.5) -> FlowField:
    """A flow past a cylinder by angle and radius, with a scalar that is light in a part."""
    theta, r = np.meshgrid(np.linspace(0, 2 * np.pi, 97), np.linspace(least, 2, 61))
    near = 0.25 / np.maximum(r, 0.5) ** 2
    velocity = np.stack([-(1 + near) * np.sin(theta), (1 - near) * np.cos(theta)], axis=-1)
    light = ((theta > 1) & (theta < 2) & (r > 1)).astype(float)
    return FlowField.from_arrays((theta, r), velocity, scalars={"edge": light})


@pytest.mark.parametrize("kind", POLAR)
def test_directions_on_polar_axes_are_those_of_quiver(figure: Figure, kind: str) -> None:
    ax: Any = figure.add_subplot(projection="polar")
    POLAR[kind](ax)
    field = ring()
    shown = flowtex.axes(ax, field, samples=3).flow
    assert shown.periodic == (False, True) and shown.scalars["speed"] == pytest.approx(field.speed)
    some = np.zeros(field.shape, dtype=bool)
    some[4:-2:9, 3:-1:8] = shown.valid[4:-2:9, 3:-1:8]
    theta, r, _ = field.points[some].T
    along, out, _ = np.asarray(field.velocity[0])[some].T
    arrows = ax.quiver(theta, r, along / r, out, angles="xy", units="xy")  # rates of both
    figure.canvas.draw()
    tips = np.array(
        [path.vertices[np.argmax(np.hypot(*path.vertices.T))] for path in arrows.get_paths()]
    )
    u, v, _ = np.asarray(shown.velocity[0])[some].T
    assert len(u) > 20
    # quiver goes a thousandth of the axes, which is an angle on logarithmic ones.
    assert np.abs(np.angle((u + 1j * v) * (tips @ (1, -1j)))).max() < np.radians(1)


@pytest.mark.parametrize(("kind", "dpi"), [*((kind, 50) for kind in POLAR), ("zoomed", 200)])
def test_polar_axes_show_a_flow_where_it_is(figure: Figure, kind: str, dpi: float) -> None:
    ax: Any = figure.add_subplot(projection="polar")
    ax.grid(visible=False)
    POLAR[kind](ax)
    flowtex.axes(ax, ring(), **PLAIN)
    figure.set_dpi(dpi)
    shot = pixels(figure)
    low, high = sorted(ax.get_ylim())
    distances = np.linspace(max(low, 0.5), min(high, 2), 13)[1:-1]
    theta, r = np.meshgrid(np.arange(0.6, 2.2, 0.1) + 0.05, distances)
    at = (np.abs(theta - 1) > 0.06) & (np.abs(theta - 2) > 0.06) & (np.abs(r - 1) > 0.04)
    x, y = ax.transData.transform(np.stack([theta[at], r[at]], axis=-1)).astype(int).T
    light = shot[len(shot) - 1 - y, x, 0] > 127
    assert (light == ((theta > 1) & (theta < 2) & (r > 1))[at]).all()


@pytest.mark.parametrize("closed", [True, False])
def test_what_is_derived_on_polar_axes_is_that_of_the_plane(figure: Figure, closed: bool) -> None:
    around = np.linspace(0, 2 * np.pi, 65, endpoint=closed)
    theta, r = np.meshgrid(around, np.linspace(0.5, 2, 41))
    field = FlowField.from_arrays((theta, r), np.stack([r**2, 0 * r], axis=-1), time_unit="s")
    image = flowtex.axes(figure.add_subplot(projection="polar"), field, scalars="vorticity")
    assert image.colour_label == "vorticity (1/s)"
    vorticity = image.flow.scalars["vorticity"][0][1:-1, :65]
    assert vorticity == pytest.approx(3 * r[1:-1], rel=1e-3)


def test_polar_axes_begin_at_the_centre_and_may_be_elsewhere(figure: Figure) -> None:
    ax: Any = figure.add_subplot(projection="polar", facecolor="#ff0000")
    image = flowtex.axes(ax, ring(0.0), samples=3)
    assert ax.get_ylim() == (0, 2) and ax.get_xlim() == pytest.approx((0, 2 * np.pi))
    # A uniform flow goes through the centre.
    x, y = image.flow.points[10, :, :2].T
    assert x.mean() == pytest.approx(y.mean(), abs=0.01)
    ax.set_rorigin(-1)
    pixels(figure)
    assert image.flow.valid[1:].all() and not image.flow.valid[0].any(), "the angle has no rate"
    ax.set_rorigin(None)
    ax.set_rlim(5, 6)
    x, y = ax.transData.transform((1.0, 5.5)).astype(int)
    for _ in range(2):
        assert tuple(pixels(figure)[-y, x]) == (255, 0, 0)


def test_who_has_no_holoviews_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "holoviews", None)
    with pytest.raises(FieldError, match="pip install holoviews"):
        flowtex.dynamic_map(flowtex.examples.double_gyre_field(shape=(9, 9)))
