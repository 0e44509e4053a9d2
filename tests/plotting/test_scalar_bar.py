"""Where scalar bars stand: inside the view, and none over another."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from earth_fields import ocean, winds
from matplotlib.colors import BoundaryNorm

from flowtex import FieldError, FlowField

pytestmark = pytest.mark.usefixtures("opengl")

LONG = "a rather long name of a pressure"
TEXTS = ["GetTitleTextProperty", "GetLabelTextProperty"]
SIZES = [(300, 200), (640, 400), (1600, 1000)]


@cache
def sheet(height: float = 0.0) -> FlowField:
    x, y = np.meshgrid(np.linspace(0, 4, 24), np.linspace(0, 2, 16))
    points = np.stack([x, y, np.full_like(x, height)], axis=-1)
    velocity = np.stack([1 + 0 * x, 0.2 * np.sin(x)], axis=-1)
    values = {"height": x, LONG: -1e-4 * y, "width": y}
    return FlowField.from_arrays(points, velocity, scalars=values, units={LONG: "kg/(m s²)"})


def pixels(
    size: tuple[int, int],
    names: tuple[str, ...],
    *,
    scale: int = 1,
    dpi: int = 72,
    **options: Any,
) -> Any:
    """A grey picture with the bars of these scalars; the surface has one colour, grey."""
    made: Any = pv.Plotter(off_screen=True, window_size=list(size))
    made.set_background("gray")
    made.render_window.SetDPI(dpi)
    for number, name in enumerate(names):
        look = {"cmap": np.full((2, 3), 128, np.uint8), "strength": 0.0, "samples": 1}
        made.flowtex.add(sheet(0.1 * number), scalars=name, opacity=0.0, **look, **options)
    shot = made.screenshot(return_img=True, scale=scale)
    bars = list(made.scalar_bars.values())
    boxes = [(*bar.GetPosition(), bar.GetWidth(), bar.GetHeight()) for bar in bars]
    made.close()
    return shot.astype(int), boxes


@pytest.mark.parametrize(
    ("size", "names"),
    [(SIZES[0], names) for names in (("speed",), ("speed", LONG), ("speed", "height"))]
    + [(SIZES[-1], (LONG,))],
)
def test_bars_are_inside_and_apart(size: tuple[int, int], names: tuple[str, ...]) -> None:
    shot, boxes = pixels(size, names)
    ink = (np.abs(shot - shot[0, -1]) > 8).any(axis=-1)
    assert ink.any()
    for line in (ink[0], ink[-1], ink[:, 0], ink[:, -1]):
        assert not line.any()
    for n, (x, y, width, height) in enumerate(boxes):
        for x2, y2, width2, height2 in boxes[:n]:
            aside = x >= x2 + width2 or x2 >= x + width
            assert aside or y >= y2 + height2 or y2 >= y + height


@pytest.mark.parametrize("vertical", [True, False])
def test_bar_of_a_scaled_picture_is_that_of_a_large_window(vertical: bool) -> None:
    options: dict[str, Any] = {"scalar_bar_args": {"vertical": vertical}}
    width, height = SIZES[0]
    scaled, _ = pixels(SIZES[0], ("speed",), scale=3, **options)
    large, _ = pixels((3 * width, 3 * height), ("speed",), dpi=3 * 72, **options)
    ends = []
    for shot in (scaled, large):
        rows, columns = np.nonzero((np.abs(shot - shot[0, -1]) > 8).any(axis=-1))
        ends.append(np.array([rows.min(), rows.max(), columns.min(), columns.max()]))
    difference = np.abs(ends[0] - ends[1])
    assert difference[:2].max() <= 3
    # VTK makes a horizontal bar of such a picture as short as if its labels were not enlarged.
    assert difference[2:].max() <= (3 if vertical else 40)


def test_text_lies_on_a_plate_and_keeps_its_size_on_a_large_view() -> None:
    shots = [pixels(size, ("speed",))[0] for size in ((900, 800), (1000, 1000))]
    widths = [(shot.max(axis=-1) > 200).any(axis=0).sum() for shot in shots]
    assert 40 < widths[0] < 120
    assert widths[1] == pytest.approx(widths[0], abs=6)


def test_bars_move_when_the_view_changes_its_size() -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=[600, 400])
    made.flowtex.add(sheet())
    made.screenshot(return_img=True)
    bar = made.scalar_bars["speed"]
    before = bar.GetWidth()
    made.window_size = [300, 400]
    made.screenshot(return_img=True)
    assert bar.GetWidth() == pytest.approx(2 * before, rel=0.1)
    made.close()


def shown_bar(made: Any, **options: Any) -> Any:
    """Return the only bar of a plotter after a frame."""
    made.flowtex.add(sheet(), scalar_bar_args=options, opacity=0.0, samples=1)
    made.render()
    [bar] = made.scalar_bars.values()
    return bar


@pytest.fixture(scope="module")
def shared_plotter() -> Iterator[Any]:
    made: Any = pv.Plotter(off_screen=True)
    made.set_background("gray")
    made.show(auto_close=False)  # before which PyVista draws no frame
    yield made
    made.close()


@pytest.fixture
def plotter(shared_plotter: Any) -> Iterator[Any]:
    """Yield a plotter without a flow; a new one would take most of the time of a test."""
    shared_plotter.window_size = [450, 300]
    yield shared_plotter
    shared_plotter.flowtex.clear(render=False)


@pytest.mark.parametrize("vertical", [True, False])
@pytest.mark.parametrize(
    "given",
    [
        {"position_x": 0.5},
        {"position_y": 0.3},
        {"position_x": 0.1, "position_y": 0.2},
        {"width": 0.2},
        {"height": 0.3},
        {"title_font_size": 22},
        {"label_font_size": 9},
    ],
)
def test_a_bar_keeps_what_is_given(plotter: Any, given: dict[str, Any], vertical: bool) -> None:
    bar = shown_bar(plotter, **given, vertical=vertical)
    plotter.window_size = [500, 300]
    plotter.render()
    x, y = bar.GetPosition()
    title, label = (getattr(bar, name)().GetFontSize() for name in TEXTS)
    found = {"position_x": x, "position_y": y, "width": bar.GetWidth(), "height": bar.GetHeight()}
    found |= {"title_font_size": title, "label_font_size": label}
    assert {name: found[name] for name in given} == pytest.approx(given)


@pytest.mark.parametrize("size", SIZES)
def test_a_horizontal_bar_has_the_size_of_those_of_pyvista(size: tuple[int, int]) -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=list(size))
    bar = shown_bar(made, vertical=False)
    theme = pv.global_theme.colorbar_horizontal
    assert bar.GetWidth() == pytest.approx(theme.width)
    assert 0.5 * theme.height < bar.GetHeight() < 0.25
    assert bar.GetOrientation() == 0
    made.close()


@pytest.mark.parametrize("vertical", [True, False])
@pytest.mark.parametrize(
    "given",
    [
        {},
        {"title": LONG},
        {"title": ""},
        {"position_x": 0.7},
        {"position_y": 0.6},
        {"width": 0.15},
        {"height": 0.2},
        {"n_labels": 3},
        {"n_labels": 0},
        {"title_font_size": 20, "label_font_size": 18},
        {"bold": True, "italic": True, "font_family": "times"},
        {"below_label": "low", "above_label": "high"},
    ],
)
def test_a_bar_is_whole_with_any_arguments(
    plotter: Any, given: dict[str, Any], vertical: bool
) -> None:
    shown_bar(plotter, **given, vertical=vertical)
    shot = plotter.screenshot(return_img=True).astype(int)
    ink = (np.abs(shot - shot[0, 0]) > 8).any(axis=-1)
    assert ink.any()
    for line in (ink[0], ink[-1], ink[:, 0], ink[:, -1]):
        assert not line.any()


def test_two_horizontal_bars_are_in_two_rows() -> None:
    _, boxes = pixels((600, 400), ("speed", "height"), scalar_bar_args={"vertical": False})
    (_, y, _, height), (_, y2, _, _) = boxes
    assert y2 > y + height


def test_arguments_of_a_bar_stay_when_the_handle_changes(plotter: Any) -> None:
    given = {"vertical": False, "position_x": 0.1, "n_labels": 3, "width": 0.4}
    handle = plotter.flowtex.add(sheet(), scalar_bar_args=given)
    for change in ({"scalars": "height"}, {"cmap": "magma"}, {"clim": (0.0, 3.0)}):
        for name, value in change.items():
            setattr(handle, name, value)
        plotter.render()
        [bar] = plotter.scalar_bars.values()
        assert (bar.GetOrientation(), bar.GetNumberOfLabels()) == (0, 3)
        assert bar.GetPosition()[0] == pytest.approx(0.1)
        assert bar.GetWidth() == pytest.approx(0.4)


@pytest.mark.parametrize("name", ["tilte", "cmap", "unique_bar"])
def test_an_argument_that_bars_lack_is_an_error(plotter: Any, name: str) -> None:
    with pytest.raises(FieldError, match=rf"'{name}'; expected some of title"):
        plotter.flowtex.add(sheet(), scalar_bar_args={name: 1})
    assert not plotter.renderer.actors


@pytest.mark.parametrize(
    ("limits", "digits"), [((0.0, 1 / 3), 3), ((1000.0, 1001.0), 6), ((-2e-7, 1e-7), 3)]
)
def test_a_number_of_labels_is_written_with_few_digits(
    plotter: Any, limits: tuple[float, float], digits: int
) -> None:
    plotter.flowtex.add(sheet(), clim=limits, scalar_bar_args={"n_labels": 3})
    plotter.render()
    [bar] = plotter.scalar_bars.values()
    assert bar.GetLabelFormat() in (f"%.{digits}g", f"{{:.{digits}g}}")


@pytest.mark.parametrize(
    "limits", [(0.0, 7.25), (-3e-7, 1.3e-6), (1e5, 3.7e5), (99.2, 101.1), (0.0006, 6.1)]
)
def test_labels_are_multiples_of_one_two_or_five(limits: tuple[float, float]) -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=[640, 480])
    made.flowtex.add(sheet(), scalars="height", clim=limits)
    made.screenshot(return_img=True)
    bar = made.scalar_bars["height"]
    assert bar.GetUseCustomLabels()
    values = pv.convert_array(bar.GetCustomLabels())
    made.close()
    step = float(np.diff(values).mean())
    assert 3 <= len(values) <= 6 and limits[0] <= values[0] and values[-1] <= limits[1]
    assert f"{step:.6e}"[0] in "125" and f"{step:.6e}"[1:8] == ".000000"
    np.testing.assert_allclose(values / step, np.rint(values / step), atol=1e-6)


def test_number_and_format_of_labels_can_be_chosen() -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=[640, 480])
    made.flowtex.add(sheet(), scalar_bar_args={"n_labels": 7, "fmt": "%.1f"})
    made.screenshot(return_img=True)
    bar = made.scalar_bars["speed"]
    assert (bar.GetNumberOfLabels(), bar.GetUseCustomLabels()) == (7, 0)
    assert bar.GetLabelFormat() in ("%.1f", "{:.1f}")
    made.close()


@pytest.mark.parametrize("background", ["white", "black", "gray", "navy", "yellow"])
def test_labels_are_readable_on_any_background(background: str) -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=[300, 200])
    made.flowtex.add(sheet(), opacity=0.0)
    made.set_background(background)
    made.screenshot(return_img=True)
    ground = np.array(made.background_color.float_rgb)
    for text in (getattr(made.scalar_bars["speed"], name)() for name in TEXTS):
        plate, share = np.array(text.GetBackgroundColor()), text.GetBackgroundOpacity()
        for behind in (ground, 1 - ground):
            colours = np.array([text.GetColor(), share * plate + (1 - share) * behind])
            linear = np.where(colours < 0.04, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
            dark, light = np.sort(linear @ (0.2126, 0.7152, 0.0722))
            assert (light + 0.05) / (dark + 0.05) > 4.5  # as WCAG requires
    made.close()


def test_a_bar_of_levels_with_values_beyond_them_is_placed(plotter: Any) -> None:
    levels = BoundaryNorm([0.0, 1.0, 2.0], 256)  # of 4
    plotter.flowtex.add(sheet(), scalars="height", norm=levels)
    plotter.render()
    [bar] = plotter.scalar_bars.values()
    assert bar.GetWidth() != pytest.approx(0.08)  # which it has before
    assert bar.GetDrawAboveRangeSwatch()


def swatch_rows(plotter: Any, colour: tuple[int, int, int]) -> Any:
    """Return the rows of the picture that have a colour at the left, where the bar is."""
    shot = plotter.screenshot(return_img=True).astype(int)
    left = shot[:, : shot.shape[1] // 3]
    return np.flatnonzero((np.abs(left - colour) <= 2).all(axis=-1).sum(axis=1) > 8)


def test_the_bar_names_missing_values_from_the_first_frame_on(plotter: Any) -> None:
    mesh: Any = pv.ImageData(dimensions=(24, 16, 1))
    mesh["velocity"] = np.tile([1.0, 0.2, 0.0], (mesh.n_points, 1))
    mesh["height"] = mesh.points[:, 0].astype(float)
    x = np.asarray(mesh.points[:, 0], dtype=float)
    mesh["part"] = np.where(x > 20, np.nan, x)
    look: Any = {"nan_color": (255, 0, 255), "reset_camera": False, "samples": 1}
    plotter.camera.position = (0.0, 0.0, -1.0)  # from where the surface is not seen
    plotter.camera.focal_point = (0.0, 0.0, -2.0)
    handle = plotter.flowtex.add(mesh, vectors="velocity", scalars="height", **look)
    [bar] = plotter.scalar_bars.values()
    assert not len(swatch_rows(plotter, (255, 0, 255))) and not bar.GetDrawNanAnnotation()
    handle.scalars = "part"
    [bar] = plotter.scalar_bars.values()
    assert len(swatch_rows(plotter, (255, 0, 255))) > 5
    assert bar.GetDrawAnnotations() and bar.GetNanAnnotation() == "no data"
    mesh["part"] = mesh["height"]
    plotter.render()
    assert not len(swatch_rows(plotter, (255, 0, 255)))
    mesh["part"][3] = np.nan
    mesh.Modified()
    plotter.render()
    assert len(swatch_rows(plotter, (255, 0, 255))) > 5


def test_the_bar_of_a_map_names_places_without_data() -> None:
    for field, has_swatch in ((ocean("globe"), True), (winds("robinson"), False)):
        made: Any = pv.Plotter(off_screen=True, window_size=[300, 240])
        made.set_background((0.0, 0.0, 1.0))
        made.flowtex.add(field, samples=1)
        [bar] = made.scalar_bars.values()
        made.render()
        assert bar.GetDrawNanAnnotation() == has_swatch
        if has_swatch:
            assert bar.GetLookupTable().nan_color.float_rgb == pytest.approx(
                (0.1, 0.1, 1.0), abs=0.01
            )
        made.close()
