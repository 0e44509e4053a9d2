"""What the page tells about a point: the tip, the card, and where things lie in the view."""

from __future__ import annotations

import json
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from earth_fields import winds
from triangle_meshes import sphere

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.app.controllers.point_info import (
    PathCard,
    PointInfo,
    PointText,
    clip_line,
    number_text,
    with_unit,
)
from flowtex.app.streaming.viewport import Viewport
from flowtex.camera import Camera
from flowtex.options import Appearance
from flowtex.probe import locate, probe, values_at
from flowtex.scene import Scene
from flowtex.settings import Settings


def flat(*, tilted: bool = False) -> FlowField:
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    points = np.stack([x, y, 0.5 * y if tilted else 0 * y], axis=-1)
    velocity = np.stack([1 + 0 * x, 0.25 * x, 0 * x], axis=-1)
    return FlowField.from_arrays(
        points,
        velocity,
        periodic="",
        scalars={"warmth": 10 * x},
        length_unit="m",
        time_unit="s",
    )


def ball() -> FlowField:
    lon, lat = np.meshgrid(np.linspace(0, 2 * np.pi, 49), np.linspace(0, np.pi, 25))
    points = np.stack([np.sin(lat) * np.cos(lon), np.sin(lat) * np.sin(lon), np.cos(lat)], axis=-1)
    return FlowField.from_arrays(points, np.stack([-points[..., 1], points[..., 0], 0 * lon], -1))


def test_a_point_on_triangles_is_told_by_its_place() -> None:
    points, triangles = sphere(2)
    field = FlowField.from_triangles(points, triangles, np.cross([0, 0, 1], points))
    shown: list[Any] = []
    viewport = SimpleNamespace(field=field)
    info: Any = SimpleNamespace(viewport=viewport, show_path=shown.append)
    place = np.array([0.6, 0.64, 0.48])
    for junk in ([0.5, 3.0], [0.0, 1.0], "abc", [1, 2, "3"], [1, 2, np.nan], [1, 2, 3, 4], None):
        PointInfo.take_point(info, junk)
    assert shown == []
    PointInfo.take_point(info, (1.2 * place).tolist())
    ((j, i),) = shown
    np.testing.assert_allclose(field.surface.at(np.array([i, j])), place, atol=0.05)


class Seen(Viewport):
    """A viewport without a window: a field, and a camera with z or y upwards."""

    aspect, pane_size = 1.6, (320, 200)

    def __init__(
        self,
        position: tuple[float, float, float],
        focus: tuple[float, float, float],
        *,
        scale: float | None = None,
        field: FlowField | None = None,
    ) -> None:
        parallel = scale is not None
        self.window = SimpleNamespace(place=lambda camera: None)  # type: ignore[assignment]
        self.camera = Camera(position, focus, (0, 1, 0.3), parallel, scale or 1.0)
        self.whole, self._shown = self.camera, field

    @property
    def field(self) -> FlowField:
        assert self._shown is not None
        return self._shown

    @property
    def handle(self) -> Any:
        scene = SimpleNamespace(whole=self.field)
        return SimpleNamespace(time=self.field.times[0], scene=scene, field=self.field)

    @property
    def panes(self) -> Any:  # type: ignore[override]
        return [self]


def view_of(field: FlowField, **settings: object) -> Scene:
    chosen = Settings()
    chosen.update(**settings)
    return Scene(field, chosen)


# --- places ---------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [None, 0.8])
def test_places_are_those_of_the_pixels(scale: float | None, rng: np.random.Generator) -> None:
    viewport = Seen((0.5, -3.0, 2.0), (0.1, 0.2, -0.1), scale=scale)
    points = rng.uniform(-0.5, 0.5, (9, 3))
    clip = (
        np.concatenate([points, np.ones((9, 1))], axis=1)
        @ viewport.camera.matrix(viewport.aspect).T
    )
    places = viewport.camera.project(points, viewport.aspect)
    assert places == pytest.approx(clip[:, :2] / clip[:, 3:], abs=1e-9)


def test_a_line_is_cut_where_the_view_ends() -> None:
    line = np.array([[-9.0, 0.0], [0.0, 0.0], [1.0, 1.0], [1.0, 9.0], [5.0, 9.0]])
    (run,) = clip_line(line)
    assert run == [[-2, 0], [0, 0], [1, 1], [1, 2]]
    # Twice through the view, and once past it.
    again = np.array([[-9.0, 1.0], [9.0, 1.0], [9.0, 0.0], [-9.0, 0.0]])
    assert clip_line(again) == [[[-2, 1], [2, 1]], [[2, 0], [-2, 0]]]
    assert clip_line(np.array([[-9.0, 0.0], [0.0, 9.0]])) == []
    # What lies behind the camera is left out, and so is a single point.
    gap = np.array([[0.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [1.0, 1.0], [0.0, 1.0]])
    assert clip_line(gap) == [[[0, 0], [1, 0]], [[1, 1], [0, 1]]]
    assert clip_line(np.zeros((1, 2))) == clip_line(np.zeros((0, 2))) == []
    assert clip_line(line, reach=1.0) == [[[-1, 0], [0, 0], [1, 1]]]


# --- words ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("x", "text"),
    [
        (0.0, "0"),
        (0.123456, "0.1235"),
        (-12345.6, "-12350"),
        (123456.0, "1.23e5"),
        (-1e-4, "-1.00e-4"),
        (3.0, "3"),
        (np.nan, "–"),
    ],
)
def test_numbers_are_short(x: float, text: str) -> None:
    assert number_text(x) == text


def test_a_deep_zoom_has_more_digits() -> None:
    assert number_text(0.00012345678, 9) == "0.00012345678"
    assert number_text(1.23456789012, 10) == "1.23456789"


def test_a_long_unit_is_left_out() -> None:
    assert with_unit(2.0, "m") == "2 m"
    assert with_unit(2.0, "") == "2"
    assert with_unit(2.0, "diameters / free-stream speed") == "2"


# --- the tip --------------------------------------------------------------------------------


def test_the_tip_of_a_flat_surface() -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0, field=flat())
    hover = PointText(viewport)
    got = dict(hover(0.5, -0.5) or ())
    assert got == {
        "position": "(0.8, -0.5) m",
        "velocity": "(1, 0.2) m/s",
        "speed": "1.02 m/s",
        "warmth": "8",
    }
    assert hover(0.5, 1.01) is None
    assert viewport.surface_point(0.5, 1.5) == pytest.approx([0.8, 1.5, 0.0])


def test_a_flow_that_leaves_the_surface_has_all_its_velocity() -> None:
    inside = flat()
    velocity = inside.velocity + np.array([0.0, 0.0, 0.6])
    field = FlowField.from_arrays(inside.points, velocity[0], periodic="")
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0, field=field)
    got = dict(PointText(viewport)(0.5, -0.5) or ())
    assert got == {
        "position": "(0.8, -0.5)",
        "velocity": "(1, 0.2, 0.6)",
        "speed in the surface": "1.02",
    }


def test_a_tilted_plane_has_three_coordinates() -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), field=flat(tilted=True))
    hover = PointText(viewport)
    got = dict(hover(0.1, 0.3) or ())
    assert got["position"].count(",") == got["velocity"].count(",") == 2
    at = hover.index(0.1, 0.3)
    assert at is not None
    point = probe(view_of(flat(tilted=True)), at, pixel=0.01).field_values.position
    assert viewport.camera.project(point, viewport.aspect) == pytest.approx([0.1, 0.3])


def test_a_plane_seen_edge_on_or_from_below_says_nothing() -> None:
    edge = Seen((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), field=flat())
    away = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 9.0), field=flat())
    for viewport in (edge, away):
        assert PointText(viewport)(0.0, 0.0) is None


def test_the_tip_of_a_curved_surface_asks_what_is_hit() -> None:
    viewport = Seen((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), field=ball())
    asked: list[tuple[float, float]] = []

    def hit(x: float, y: float, pane: int = 0) -> Floats | None:
        asked.append((x, y))
        return np.array([0.999, 0.01, 0.01]) if y < 0.5 else None

    viewport.surface_point = hit  # type: ignore[method-assign]
    hover = PointText(viewport)
    lines = hover(0.0, 0.1)
    assert lines is not None
    assert [word for word, _ in lines] == ["position", "velocity", "speed"]
    assert hover(0.2, 0.9) is None
    assert asked == [(0.0, 0.1), (0.2, 0.9)]


def test_the_tip_of_curved_triangles_does_not_ask_what_was_drawn() -> None:
    points, triangles = sphere(4)
    field = FlowField.from_triangles(points, triangles, np.cross([0.0, 0.0, 1.0], points))
    viewport = Seen((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), field=field)
    assert not hasattr(viewport.panes[0].handle, "meshes")
    point = viewport.surface_point(0.0, 0.0)
    assert point == pytest.approx([1.0, 0.0, 0.0], abs=2e-3)
    assert viewport.surface_point(0.99, 0.99) is None
    assert PointText(viewport)(0.0, 0.0) is not None


def test_the_digits_follow_the_zoom() -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0, field=flat())
    viewport.zoom_by(1e5, 0.3333, 0.1)
    got = dict(PointText(viewport)(0.3333, 0.1) or ())
    x = float(got["position"].strip("()").split(",")[0])
    assert x == pytest.approx(0.53328, abs=1e-8)
    assert len(got["position"]) > 12


# --- the card -------------------------------------------------------------------------------


@pytest.fixture(scope="module", name="card")
def a_card() -> PathCard:
    view = view_of(flat(), samples=21)
    at = locate(view.field, (0.3, 0.1))
    return PathCard(probe(view, at, pixel=0.01))  # type: ignore[arg-type]


def test_the_card_can_be_sent(card: PathCard) -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0)
    over, bars, lines = json.loads(
        json.dumps([card.over(viewport), card.bars(), card.lines()], allow_nan=False)
    )
    place = viewport.camera.project([0.3, 0.1, 0.0], 1.6)
    assert over["point"] == pytest.approx(place)
    assert len(bars) == len(over["samples"]) == 21 and dict(lines)["samples"] == "21"
    assert max(bar["weight"] for bar in bars) == 1.0
    assert bars[10]["lag"] == 0
    assert [over["samples"][10][axis] for axis in "xy"] == pytest.approx(list(place))
    greys = [int(bar["grey"][1:3], 16) / 255 for bar in bars]
    assert greys == pytest.approx(card.probe.greys, abs=1 / 500)


def test_the_card_says_it_in_words(card: PathCard) -> None:
    lines = dict(card.lines())
    assert lines["samples"] == "21"
    assert lines["grain"] == "0.015 m, 1.5 pixels"
    assert lines["step"] == "0.0105 m"
    assert lines["value"].endswith(f"= {card.probe.value:+.2f}")


def test_the_card_begins_with_the_point() -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0, field=flat())
    got = probe(view_of(flat(), samples=21), (10.0, 20.0), pixel=0.01)
    lines = PathCard(got, PointText(viewport).lines(got.field_values)).lines()
    words = [word for word, _ in lines]
    assert words[:5] == ["position", "velocity", "speed", "warmth", "samples"]


def test_a_number_of_samples_that_is_not_the_one_set_has_a_reason() -> None:
    def said(**settings: object) -> str:
        got = probe(view_of(flat(), **settings), (10.0, 20.0), pixel=0.01)
        return dict(PathCard(got).lines())["samples"]

    assert said(samples=21) == said(samples=21, two_sided=False) == "21"
    assert said(samples=20) == "21: 20 are set, and the point itself is one more"
    assert said(samples=20, two_sided=False) == "20"
    assert said(samples=20, motion="speed") == "39: 20 are set, in motion it takes twice as many"
    assert said(samples=1, motion="speed") == "1"


def test_a_path_without_a_sign_is_not_directed() -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0)
    got = probe(view_of(flat()), (10.0, 20.0), pixel=0.01)
    assert PathCard(got).over(viewport)["directed"]
    assert not PathCard(got, directed=False).over(viewport)["directed"]


def test_a_path_that_ends_says_so() -> None:
    got = PathCard(probe(view_of(flat()), (10.0, 0.5), pixel=0.02))
    words = dict(got.lines())["samples"]
    assert words == f"{len(got.probe.lags)} of 49: the path ends"


def test_a_card_where_nothing_moves() -> None:
    y, x = np.mgrid[-1:1:9j, -1:1:9j]
    speed = np.where(x > 0, 1.0, 0.0)
    field = FlowField.from_arrays(np.stack([x, y], -1), np.stack([speed, 0 * x], -1), periodic="")
    got = PathCard(probe(view_of(field), (4.5, 1.5), pixel=0.01))
    json.dumps(got.bars(), allow_nan=False)
    assert dict(got.lines())["step"] == "–"
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0, field=flat())
    over = got.over(viewport)
    assert (over["path"], over["sampled"], len(over["samples"])) == ([], [], 1)


def test_a_picture_shows_its_colours() -> None:
    dye = np.zeros((4, 4, 4), np.uint8)
    dye[...] = [255, 0, 0, 51]
    view = Scene(flat(), Settings(), Appearance(image=dye))
    view.settings.noise = "image"
    got = PathCard(probe(view, (10.0, 20.0), pixel=0.01))
    assert {bar["grey"] for bar in got.bars()} == {"#ffcccc"}
    assert "value" not in dict(got.lines())


@pytest.mark.parametrize("move", [lambda v: v.rotate(0.2, 0.1), lambda v: v.zoom_by(40, 0.1, 0.1)])
def test_the_path_follows_the_camera(card: PathCard, move: Callable[[Viewport], None]) -> None:
    viewport = Seen((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), scale=1.0, field=flat())
    first = card.over(viewport)
    move(viewport)
    over = json.loads(json.dumps(card.over(viewport), allow_nan=False))
    assert over != first
    assert over["point"] == pytest.approx(viewport.camera.project([0.3, 0.1, 0.0], 1.6))
    for sample in over["samples"]:
        assert max(abs(sample["x"]), abs(sample["y"])) <= 2
    # The part with samples goes from the first of them to the last, and lies on the whole path.
    (line,) = over["sampled"]
    ends = viewport.camera.project(card.probe.points[[0, -1]], 1.6)
    if np.abs(ends).max() <= 2:
        assert [line[0], line[-1]] == [pytest.approx(end) for end in ends]
    assert np.abs(np.asarray(line)).max() <= 2


def test_a_place_on_the_earth_is_told_by_longitude_and_latitude() -> None:
    field = winds("globe", cells=36)
    for zoom, place in ((1.0, "20.00° E, 45.00° N"), (100.0, "20.0000° E, 45.0000° N")):
        panes = [SimpleNamespace(handle=SimpleNamespace(field=field))]
        viewport: Any = SimpleNamespace(panes=panes, zoom=zoom)
        lines = dict(PointText(viewport).lines(values_at(field, (27, 40))))
        assert lines["place"] == place
        assert lines["eastward"] == "7.068 m/s" or lines["eastward"].startswith("7.0")
        assert {"northward", "speed"} <= set(lines) and "position" not in lines
