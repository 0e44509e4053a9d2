"""Where scalar bars stand: inside the view, and none over another."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv

from flowtex import FlowField

pytestmark = pytest.mark.usefixtures("opengl")

LONG = "a rather long name of a pressure"
TEXTS = ["GetTitleTextProperty", "GetLabelTextProperty"]
SIZES = [(300, 200), (640, 400), (1600, 1000)]


def sheet(height: float = 0.0) -> FlowField:
    x, y = np.meshgrid(np.linspace(0, 4, 24), np.linspace(0, 2, 16))
    points = np.stack([x, y, np.full_like(x, height)], axis=-1)
    velocity = np.stack([1 + 0 * x, 0.2 * np.sin(x)], axis=-1)
    values = {"height": x, LONG: -1e-4 * y, "width": y}
    return FlowField.from_arrays(points, velocity, scalars=values, units={LONG: "kg/(m s²)"})


def pixels(size: tuple[int, int], names: tuple[str, ...], **options: Any) -> Any:
    """A grey picture with the bars of these scalars; the surface has one colour, grey."""
    made: Any = pv.Plotter(off_screen=True, window_size=list(size))
    made.set_background("gray")
    for number, name in enumerate(names):
        look = {"cmap": np.full((2, 3), 128, np.uint8), "strength": 0.0, "samples": 1}
        made.flowtex.add(sheet(0.1 * number), scalars=name, opacity=0.0, **look, **options)
    shot = made.screenshot(return_img=True)
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


@pytest.mark.parametrize("options", [{"position_x": 0.5}, {"title_font_size": 30}, {"width": 0.2}])
def test_a_bar_that_is_placed_by_hand_stays(options: dict[str, Any]) -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=[600, 400])
    made.flowtex.add(sheet(), scalar_bar_args=options)
    made.screenshot(return_img=True)
    bar = made.scalar_bars["speed"]
    assert bar.GetPosition()[0] == options.get("position_x", 0.02)
    assert bar.GetWidth() == options.get("width", 0.08)
    assert bar.GetTitleTextProperty().GetFontSize() == options.get("title_font_size", 16)
    made.close()


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
