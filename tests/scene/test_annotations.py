"""What is written on pictures: what there is, where it stands, and that nothing is cut."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from camera_moves import rotate
from earth_fields import winds
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test

import flowtex
from flowtex import FlowField
from flowtex._util.colours import colour_table, rgb
from flowtex.errors import Notice
from flowtex.field.dates import time_text
from flowtex.field.earth.on_land import on_land
from flowtex.field.earth.projection import Projection
from flowtex.plotting.offscreen.movie import frames
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.shade import mean_colours
from flowtex.rendering.map_overlay import missing_colour
from flowtex.rendering.webgl.marks import KIND_MARKS, LINE_COLORS, NULLCLINE_COLORS
from flowtex.scene.annotations import (
    Plate,
    _Writer,
    layout,
    length_text,
    round_length,
)
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

SIZES = [(300, 200), (640, 400), (1600, 1000), (300, 400), (3840, 2160)]


def patch(
    *, steps: int = 3, curved: bool = False, name: str = "patch", **options: Any
) -> FlowField:
    """A patch of 4 x 2 metres in which all moves along x, with a scalar that has a unit."""
    x, y = np.meshgrid(np.linspace(0, 4, 24), np.linspace(0, 2, 16))
    points = np.stack([x, y, np.sin(x) * curved], axis=-1)
    velocity = np.stack([1 + 0.1 * y, 0 * x, 0 * x], axis=-1)
    words = {"name": name, "length_unit": "m", "time_unit": "s", "units": {"pressure": "Pa"}}
    return FlowField.from_arrays(
        points,
        velocity if steps == 1 else np.repeat(velocity[None], steps, axis=0),
        times=None if steps == 1 else 0.5 * np.arange(steps),
        scalars={"pressure": 101_325 + x},
        **{**words, **options},
    )


def written(
    scene: Scene, size: tuple[int, int] = (640, 400), camera: Camera | None = None, **options: Any
) -> dict[str, Plate]:
    camera = camera or Camera.fit(scene.field.surface, size[0] / size[1])
    return {plate.name: plate for plate in layout(scene, size, camera, **options).plates}


@pytest.fixture
def texts(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Texts in the order in which they are written."""
    seen: list[str] = []
    write = _Writer._write

    def record(self: Any, draw: Any, x: int, y: int, text: str) -> None:
        seen.append(text)
        write(self, draw, x, y, text)

    monkeypatch.setattr(_Writer, "_write", record)
    yield seen


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("background", ["white", "black"])
def test_nothing_is_cut_and_nothing_overlaps(size: tuple[int, int], background: str) -> None:
    scene = Scene.of(patch(), scalars="pressure")
    found = written(scene, size, background=background)
    assert set(found) == {"legend", "time", "scale bar", "title"}
    for left, top, right, bottom in (plate.box for plate in found.values()):
        assert left > 0 and top > 0 and right < size[0] and bottom < size[1]
    for plate in found.values():
        # Nothing reaches the border of its own plate.
        ink = np.asarray(plate.image.convert("RGB")).astype(int)
        for line in (ink[0], ink[-1], ink[:, 0], ink[:, -1]):
            assert (line == ink[0, 0]).all()
        light = ink[0, 0].mean() > 128
        assert light == (background == "white")
        assert abs(ink - ink[0, 0]).max() > 200  # black on white, or white on black


@property_test(60)
@given(
    st.tuples(st.integers(1, 500), st.integers(1, 500)),
    st.text(max_size=40),
    st.sampled_from(["s", "turnover times", "diameters / free-stream speed"]),
)
def test_whatever_the_size_and_the_words_are(size: tuple[int, int], name: str, unit: str) -> None:
    found = written(Scene(patch(name=name, time_unit=unit)), size)
    boxes = np.array([plate.box for plate in found.values()]).reshape(-1, 4)
    cover = np.zeros((size[1], size[0]), int)
    for left, top, right, bottom in boxes:
        assert 0 < left < right < size[0] and 0 < top < bottom < size[1]
        cover[top:bottom, left:right] += 1
    assert cover.max() <= 1


def test_what_has_no_room_is_left_out_the_title_first(opengl: None) -> None:
    scene = Scene(patch(name="a name that is as long as this"))
    assert list(written(scene, (640, 400))) == ["legend", "time", "scale bar", "title"]
    assert list(written(scene, (180, 150))) == ["legend", "time", "scale bar"]
    assert list(written(scene, (40, 30))) == []
    with pytest.warns(Notice, match="a picture of 180 x 150 has no room for: title$"):
        flowtex.render(scene.field, size=(180, 150), samples=3, annotations=True)


@pytest.mark.parametrize("size", [(100, 80), (320, 240), (150, 400), (500, 120)])
@pytest.mark.parametrize("options", [{}, {"critical_points": 3, "clim": (-1.2345e7, 9.87654e7)}])
def test_annotations_cover_no_flow_in_small_pictures(
    size: tuple[int, int], options: dict[str, Any]
) -> None:
    scene = Scene.of(patch(name="speed", units={"pressure": "kg m-1 s-2, as measured"}), **options)
    found = layout(scene, size, Camera.fit(scene.field.surface, size[0] / size[1]))
    assert found.plates and found.above + found.below < 0.6 * size[1]
    for _, top, _, bottom in (plate.box for plate in found.plates):
        assert bottom <= found.above or top >= size[1] - found.below


@pytest.mark.parametrize(
    ("field", "options", "missing"),
    [
        (patch(steps=1), {}, {"time"}),
        (patch(curved=True), {}, {"scale bar"}),
        (patch(name=""), {}, {"title"}),
        (patch(), {"scalars": False}, {"legend"}),
        (patch(), {"show_level": True}, {"legend"}),
        (patch(), {"visible": False}, {"legend"}),
    ],
)
def test_what_tells_nothing_is_not_there(
    field: FlowField, options: dict[str, Any], missing: set[str]
) -> None:
    found = written(Scene.of(field, **options))
    assert {"legend", "time", "scale bar", "title"} - set(found) == missing


def test_a_flat_surface_seen_aslant_or_in_perspective_has_no_scale_bar() -> None:
    scene = Scene(patch())
    camera = Camera.fit(scene.field.surface, 1.6)
    assert "scale bar" in written(scene, camera=camera)
    assert "scale bar" not in written(scene, camera=rotate(camera, 0.2, 0, 1.6))
    near = Camera(camera.position, camera.focal_point, camera.up)
    assert "scale bar" not in written(scene, camera=near)


def test_a_scale_bar_is_as_long_as_it_says(texts: list[str]) -> None:
    scene = Scene(patch())
    plate = written(scene, (640, 400))["scale bar"]
    assert "0.5 m" in texts
    # 4 m fill the width but for the margins.
    row = np.asarray(plate.image.convert("L"))[-8:].min(axis=0)
    length = 0.5 / 4 * 640 * 0.92
    assert (row < 100).sum() == pytest.approx(length, abs=1)


@pytest.mark.parametrize("lat", [0.0, 40.0, 75.0])
def test_a_scale_bar_of_a_map_is_true_in_the_middle_of_the_view(
    texts: list[str], lat: float
) -> None:
    field = winds("mercator")
    assert field.projection is not None
    focus = field.projection.positions(np.array(0.0), np.array(lat))
    camera = Camera.fit(field.surface, 1.6, zoom=2.5, focus=focus)
    plate = written(Scene(field), (640, 400), camera)["scale bar"]
    (text,) = (text for text in texts if text.endswith(" km"))
    row = np.asarray(plate.image.convert("L"))[-8:].min(axis=0)
    on_map = 1000 * float(text.removesuffix(" km")) / np.cos(np.radians(lat))
    assert (row < 100).sum() == pytest.approx(on_map * 400 / (2 * camera.height), abs=1)


def test_a_legend_has_name_unit_and_round_values(texts: list[str]) -> None:
    written(Scene.of(patch(), scalars="pressure"))
    assert texts[:5] == ["pressure (Pa)", *(str(value) for value in range(101325, 101329))]
    texts.clear()
    written(Scene.of(patch(), scalars="pressure", clim=(1, 10_000), log_scale=True))
    assert texts[1:4] == ["1", "100", "10000"]
    texts.clear()
    written(Scene.of(patch(), scalars="pressure", clim=(-0.1, 0.1)))
    assert texts[1:4] == ["-0.1", "0", "0.1"]


def test_a_legend_has_the_colours_of_the_picture() -> None:
    scene = Scene.of(patch(), cmap="magma", strength=0.4)
    table = mean_colours(colour_table("magma"), scene.settings)
    image = np.asarray(written(scene, (1600, 1000))["legend"].image)
    line = image[image.shape[0] // 2, :, :3]
    for colour in table[[0, 100, 255], :3]:
        assert (line == colour).all(axis=-1).any()


@pytest.mark.parametrize("tips", [(False, False), (True, False), (True, True)])
def test_colours_end_in_a_tip_where_values_lie_beyond(tips: tuple[bool, bool]) -> None:
    low, high = Scene.of(patch()).scalar_range("speed")
    inside = 0.2 * (high - low)
    scene = Scene.of(patch(), clim=(low + tips[0] * inside, high - tips[1] * inside))
    image = np.asarray(written(scene, (1600, 1000))["legend"].image)[..., :3].astype(int)
    coloured = np.ptp(image, axis=-1) > 30
    rows = np.flatnonzero(coloured.sum(axis=1) > coloured.shape[1] / 2)
    first, middle = rows[0], rows[len(rows) // 2]
    ends = [np.flatnonzero(coloured[row])[[0, -1]] for row in (first, middle)]
    assert (bool(ends[0][0] > ends[1][0]), bool(ends[0][1] < ends[1][1])) == tips


@pytest.mark.parametrize(
    ("times", "unit", "time", "text"),
    [
        (np.arange(4.0), "s", 2.5, "t = 2.50 s"),
        (0.04 * np.arange(4), "", 0.1, "t = 0.100"),
        (3600.0 * np.arange(4), "s", 9000, "t = 9000 s"),
        (1e-9 * np.arange(4), "ms", 2.5e-9, "t = 2.5e-09 ms"),
        (np.arange(4.0), "diameters / speed", 2.5, "t = 2.50"),
        ([6.0], "", 6.0, "t = 6.00"),
        ([np.datetime64("2002-01-05")], "", 0.0, "2002-01-05"),
    ],
)
def test_a_time_tells_the_steps_apart(times: Any, unit: str, time: float, text: str) -> None:
    field = patch(steps=len(times))
    field = FlowField.from_arrays(field.points, field.velocity, times=times, time_unit=unit)
    assert time_text(field, time) == text


def test_a_picture_has_them_only_when_asked(opengl: None) -> None:
    field = patch()
    options: dict[str, Any] = {"size": (640, 400), "samples": 3}
    plain = flowtex.render(field, **options)
    with_text = flowtex.render(field, **options, annotations=True, show_scalar_bar=True)
    changed = np.zeros(plain.shape[:2], bool)
    scene = Scene(field)
    for left, top, right, bottom in (plate.box for plate in written(scene).values()):
        changed[top:bottom, left:right] = True
    differs = (plain != with_text).any(axis=-1)
    assert differs.any() and not (differs & ~changed).any()
    without = flowtex.render(field, **options, annotations=True, show_scalar_bar=False)
    assert (without == plain)[200:, 320:].all() and (without != plain).any()


def test_two_views_say_how_they_differ(opengl: None, texts: list[str]) -> None:
    field = patch()
    options: dict[str, Any] = {"size": (801, 300), "samples": 3, "beside": {"lod": False}}
    flowtex.render(field, **options, annotations=True)
    assert [*dict.fromkeys(t for t in texts if "lod" in t)] == [
        "patch, lod = True",
        "patch, lod = False",
    ]


def test_each_frame_of_a_movie_has_its_time(opengl: None, texts: list[str]) -> None:
    list(frames(patch(), size=(300, 200), seconds=0.5, fps=8, samples=3, annotations=True))
    # The same velocity at the end as at the beginning: a loop, without its last time.
    first, *times = [t for t in texts if t.startswith("t = ")]  # the first one is for the room
    assert first == times[0] and times == ["t = 0.00 s", "t = 0.25 s", "t = 0.50 s", "t = 0.75 s"]


@pytest.mark.parametrize(
    ("length", "unit", "text"),
    [
        (1.0, "diameters", "1 diameter"),
        (20.0, "body lengths", "20 body lengths"),
        (1.0, "metre", "1 metre"),
        (500.0, "m", "500 m"),
        (2e6, "m", "2000 km"),
        (2000.0, "mm", "2000 mm"),
    ],
)
def test_a_length_has_its_unit(length: float, unit: str, text: str) -> None:
    assert length_text(length, unit) == text


@pytest.mark.parametrize(
    ("greatest", "length"),
    [(7.3, 5), (0.019, 0.01), (20, 20), (999, 500), (0, 0), (float("inf"), 0)],
)
def test_a_scale_bar_has_a_round_length(greatest: float, length: float) -> None:
    assert round_length(greatest) == pytest.approx(length)


def test_kinds_of_marked_points_are_named(texts: list[str]) -> None:
    field = flowtex.examples.double_gyre_field(shape=(41, 81))
    camera = Camera.fit(field.surface, 4 / 3)
    for count, named in ((0, []), (100, ["saddle", "centre"])):
        scene = Scene(field, Settings(critical_points=count))
        found = {plate.name: plate for plate in layout(scene, (800, 600), camera).plates}
        assert [text for text in texts if text in KIND_MARKS] == named
        assert ("structure" in found) == bool(named)
    bar, kinds = found["scale bar"], found["structure"]
    assert kinds.box[3] < bar.top
    # Each has a dot of its colour.
    pixels = np.asarray(kinds.image)[..., :3]
    for name in named:
        color = np.rint(255 * np.array(rgb(KIND_MARKS[name].color)))
        assert (np.abs(pixels - color).max(axis=-1) <= 1).sum() > 10


def test_lines_of_the_structure_are_named(texts: list[str]) -> None:
    rate = "(1 - x**2 - y**2) * (x**2 + y**2 - 2.25)"
    field = flowtex.formula(f"x*({rate}) - y", f"y*({rate}) + x", x=(-2, 2), resolution=65)
    camera = Camera.fit(field.surface, 4 / 3)
    names = ["stable orbit", "unstable orbit", "u = 0", "v = 0"]
    scene = Scene(field, Settings(separatrices=1, nullclines=True))
    (plate,) = [p for p in layout(scene, (800, 600), camera).plates if p.name == "structure"]
    assert [text for text in texts if text in (*LINE_COLORS, *NULLCLINE_COLORS)] == names
    pixels = np.asarray(plate.image)[..., :3]
    for name in names:
        color = np.rint(255 * np.array(rgb({**LINE_COLORS, **NULLCLINE_COLORS}[name])))
        assert (np.abs(pixels - color).max(axis=-1) <= 1).sum() > 5


def gappy_ocean(name: str = "platecarree") -> FlowField:
    """Currents around Iberia, which is land, and none in a strip of the Atlantic."""
    projection = Projection(name)
    lon, lat = np.meshgrid(np.linspace(-60.0, 10.0, 71), np.linspace(36.0, 44.0, 17))
    lacking = ((lon > -40) & (lon < -20)) | on_land(lon, lat)
    east = np.where(lacking, np.nan, 1.0)
    return FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, east, 0 * lon),
        length_unit="m",
        time_unit="s",
        projection=projection,
    )


@pytest.mark.parametrize("background", ["white", "black"])
@pytest.mark.parametrize("projection", ["platecarree", "globe"])
def test_places_without_data_are_named(texts: list[str], projection: str, background: str) -> None:
    field = gappy_ocean(projection)
    plate = written(Scene.of(field, land="red"), (800, 600), background=background)["structure"]
    assert [text for text in texts if text in ("land", "no data")] == ["land", "no data"]
    pixels = np.asarray(plate.image)[..., :3]
    for colour in (rgb("red"), missing_colour(rgb(background))):
        assert (pixels == np.rint(255 * np.asarray(colour))).all(axis=-1).sum() > 20
    for hidden in ({"land": None}, {"visible": False}):
        assert "structure" not in written(Scene.of(field, **hidden), (800, 600))


def test_land_alone_needs_no_legend() -> None:
    assert "structure" not in written(Scene(winds("robinson")), (800, 600))


def test_a_legend_of_one_value_has_it_once(texts: list[str]) -> None:
    field = flowtex.FlowField.from_arrays(
        (np.arange(3.0), np.arange(3.0)),
        np.ones((3, 3, 2)),
        scalars={"level": np.full((3, 3), 3.0)},
    )
    written(Scene.of(field, scalars="level"))
    assert texts[0] == "level" and len(set(texts[1:3])) == len(texts[1:3])
