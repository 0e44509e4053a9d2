from __future__ import annotations

import base64
import io
import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from heard import Heard, names_of
from page_reader import Reader
from PIL import Image
from triangle_meshes import sphere, surface_of
from waiting import PATIENCE_S, wait_until

import flowtex
from flowtex import FieldError, examples
from flowtex._util.colours import colour_table
from flowtex.examples.analytic import gyre_nodes as nodes_of
from flowtex.host import feed, still
from flowtex.host.view import MOST_THREADS, in_pool
from flowtex.rendering.camera import Camera
from flowtex.settings import TABLE

pytest.importorskip("anywidget")

import traitlets
from IPython.core.formatters import DisplayFormatter

from flowtex.host.flow_widget import FlowWidget

#: Pixels by pixels of noise: a picture to lay on the surface.
SQUARES = (np.indices((8, 8)).sum(axis=0) % 2 * 255).astype(np.uint8)


def gyre(times: int = 1, nodes: int = 30) -> flowtex.FlowField:
    at = nodes_of((nodes, nodes))
    series = [examples.double_gyre_velocity(at, float(t)) for t in range(times)]
    return flowtex.FlowField.from_arrays(at, np.stack(series), name="gyre")


@pytest.fixture
def make() -> Iterator[Callable[..., FlowWidget]]:
    made: list[FlowWidget] = []

    def call(field: Any = None, **options: Any) -> FlowWidget:
        made.append(FlowWidget(gyre() if field is None else field, **{"samples": 9, **options}))
        return made[-1]

    yield call
    for widget in made:
        widget.close()


Make = Callable[..., FlowWidget]


def test_every_setting_is_a_trait_of_both_sides(make: Make) -> None:
    widget = make(contrast=0.5)
    synced = set(widget.traits(sync=True))
    assert set(TABLE) <= synced
    assert {"camera", "time", "clock", "playing", "point", "size", "bar"} <= synced
    assert {name: getattr(widget, name) for name in TABLE} == dict(widget.settings)
    assert (widget.contrast, widget.samples) == (0.5, 9)
    widget.samples = 21
    assert widget.settings.samples == 21
    widget.settings.spacing = 2.0
    assert widget.spacing == 2.0


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("samples", 999, r"^samples is 999; expected a whole number from 1 to 200"),
        ("kernel", "gauss", r"^kernel is 'gauss'; expected 'hann' or 'box' or 'ramp'"),
        ("noise", "image", r"^noise is 'image', but no image is given"),
        ("time", 5.0, r"^time is 5.0; expected 0 to 2"),
        ("time", "2002-01-05", r"^time is '2002-01-05'; expected a number, because the times"),
        ("time", None, r"^time is None; expected a number"),
        ("camera", {"zoom": 2}, r"^camera is {'zoom': 2}; expected a mapping with some of"),
        (
            "camera",
            {"position": [1, 2]},
            r"^camera\.position is \[1, 2\]; expected three finite numbers$",
        ),
        (
            "camera",
            {"parallel_scale": -1.0},
            r"^camera\.parallel_scale is -1\.0; expected a positive length$",
        ),
        ("size", (3,), r"^size is \(3,\); expected \(width, height\) in pixels"),
    ],
)
def test_what_does_not_fit_is_refused_on_both_sides(
    make: Make, monkeypatch: pytest.MonkeyPatch, name: str, value: Any, said: str
) -> None:
    widget = make(gyre(3))
    was = getattr(widget, name)
    with pytest.raises((FieldError, traitlets.TraitError), match=said):
        setattr(widget, name, value)
    assert getattr(widget, name) == was

    told: list[Any] = []

    def send_state(_: Any, key: Any = None) -> None:  # the oldest ipywidgets give a set
        told.extend([key] if isinstance(key, str) else key)

    monkeypatch.setattr(type(widget), "send_state", send_state)
    widget.set_state({name: value, "strength": 0.25})  # as from the browser
    assert getattr(widget, name) == was
    assert set(told) == {name}  # set back there
    assert widget.settings.strength == 0.25  # and what fits is taken


@pytest.mark.parametrize("value", ["2002-01-02", np.datetime64("2002-01-02"), 86_400, "last"])
def test_time_is_set_as_in_a_plotter(make: Make, value: Any) -> None:
    steady = gyre(1)
    times = np.array(["2002-01-01", "2002-01-02"], dtype="datetime64[s]")
    velocity = np.concatenate([steady.velocity, steady.velocity])
    widget = make(flowtex.FlowField.from_arrays(steady.points, velocity, times=times))
    widget.time = value
    assert widget.time == widget.scene.time == 86_400.0


def test_a_camera_is_changed_by_parts(make: Make) -> None:
    widget = make()
    was = dict(widget.camera)
    widget.camera = {"parallel_scale": 0.25}
    assert widget.camera == {**was, "parallel_scale": 0.25}
    assert make(zoom=4).camera["parallel_scale"] == pytest.approx(was["parallel_scale"] / 4)


def test_time_goes_both_ways(make: Make) -> None:
    widget = make(gyre(3))
    assert widget.time == widget.scene.time == 0.0  # a series begins at its first step
    widget.time = 0.5
    assert widget.scene.moment == (0, 1, 0.5)
    widget.scene.time = 1.5
    assert widget.time == 1.5


def test_a_client_that_is_ready_gets_what_it_needs(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    widget = make(gyre(5, nodes=12))
    widget.time = 1.5
    heard = Heard(widget, monkeypatch)
    heard.say(kind="ready")
    heard.wait(lambda: {"flow/1", "flow/2"} <= set(heard.arrays))
    # Those of the first moment may still be on their way.
    assert not {"flow/3", "flow/4"} & set(heard.arrays)
    assert {"padded", "unit", "cmap", "scalars/1"} <= set(heard.arrays)
    scene = widget._feeds[0].source.scene
    np.testing.assert_array_equal(heard.arrays["flow/1"], scene.step(1)["flow/1"])
    np.testing.assert_array_equal(heard.arrays["padded"], scene.surface()["padded"])
    heard.say(kind="load", request="a", key=None, steps=[3])
    heard.wait(lambda: "flow/3" in heard.arrays)
    heard.say(kind="load", request="b", key=None, steps=["x"])
    heard.say(kind="what")
    assert "flow/4" not in heard.arrays


@pytest.fixture
def refine(monkeypatch: pytest.MonkeyPatch) -> Iterator[threading.Event]:
    """Yield what lets finer forms of a large field follow the coarse one."""
    may, now = threading.Event(), feed.Feed._complete

    def later(*arguments: Any) -> None:
        may.wait(PATIENCE_S)
        now(*arguments)

    monkeypatch.setattr(feed.Feed, "_complete", later)
    yield may
    may.set()


@pytest.mark.threads
def test_a_large_field_comes_coarse_first(
    make: Make, monkeypatch: pytest.MonkeyPatch, refine: threading.Event
) -> None:
    monkeypatch.setattr(feed, "LARGE_NODES", 2000)
    monkeypatch.setattr(feed, "COARSE_STEADY", 400)
    widget = make(gyre(nodes=60))
    assert widget._header["geometry"]["shape"] == [20, 20]
    refine.set()
    heard = Heard(widget, monkeypatch)
    heard.say(kind="ready")
    heard.wait(lambda: heard.arrays.get("padded", np.zeros(1)).shape == (62, 62, 3))
    heard.wait(lambda: names_of(heard.messages[-1])[-1] == "flow/0")
    assert widget._header["geometry"]["shape"] == [60, 60]
    # Each array comes under the header that it belongs to.
    assert all(message["generation"] == message["header"] for message in heard.messages)
    assert [m["generation"] for m in heard.messages] == sorted(
        m["generation"] for m in heard.messages
    )


def test_triangles_come_at_once_and_have_tiles(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(feed, "LARGE_NODES", 100)
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 500)
    points, triangles = sphere(4)
    field = flowtex.FlowField.from_triangles(points, triangles, np.cross([0, 0, 1], points))
    widget = make(field)
    header = widget._header
    assert header["geometry"]["triangles"]
    assert header["pyramid"]["depth"] > 0
    heard = Heard(widget, monkeypatch)
    heard.say(kind="ready")
    heard.wait(lambda: {"triangles", "blocks", "slices/0", "places"} <= set(heard.arrays))
    assert heard.arrays["triangles"].max() < header["geometry"]["shape"][1] < len(points)
    assert widget._feeds[0].settled.wait(PATIENCE_S)
    assert widget._header is header
    key = [header["pyramid"]["depth"] - 1, 0, 0]
    heard.say(kind="load", request="a", key=key, steps=[0])
    name = f"tile/{key[0]}/0/0"
    heard.wait(lambda: {f"{name}/triangles", f"{name}/slices/0"} <= set(heard.arrays))
    # The triangle that was clicked is one of a coarser level.
    widget.set_state({"point": {"position": [0, -1.01, 0], "index": [0.5, 3.2], "values": {}}})
    at = surface_of(field).at(np.array(widget.point["index"]))
    np.testing.assert_allclose(at, [0, -1, 0], atol=0.01)
    told = widget.point
    widget.set_state({"point": {"position": "here"}})
    assert widget.point == told


def test_a_setting_sends_what_it_changes_and_no_more(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    widget = make(image=SQUARES)
    heard = Heard(widget, monkeypatch)
    heard.settle()
    assert "image" in heard.arrays
    widget.contrast = 2.0
    widget.samples = 30
    assert heard.messages == []
    was = heard.arrays["image"]
    widget.set_image(255 - SQUARES)
    heard.wait(lambda: not np.array_equal(was, heard.arrays["image"]))
    assert "position" not in {name for m in heard.messages for name in names_of(m)}
    widget.noise = "procedural"
    wait_until(lambda: "FLOWTEX_IMAGE" not in widget._header["variant"])


def test_an_error_while_tracing_is_told(
    make: Make, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    widget = make()
    heard = Heard(widget, monkeypatch)

    def fail() -> None:
        msg = "out of memory"
        raise MemoryError(msg)

    monkeypatch.setattr(widget._views[0], "data", fail)
    widget.parameter = "time"
    heard.wait(lambda: any(m["kind"] == "error" for m in heard.messages))
    told = [m["text"] for m in heard.messages if m["kind"] == "error"]
    assert told == ["MemoryError: out of memory"]
    assert "out of memory" in capsys.readouterr().err


def test_an_error_is_not_told_while_the_interpreter_ends(
    make: Make, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Threads still run then, but libraries refuse their work."""
    widget = make()
    heard = Heard(widget, monkeypatch)
    heard.settle()
    refused = threading.Event()

    def refuse() -> None:
        refused.set()
        msg = "cannot schedule new futures after shutdown"
        raise RuntimeError(msg)

    monkeypatch.setattr(widget._views[0], "data", refuse)
    ended = SimpleNamespace(main_thread=threading.Thread, Event=threading.Event)
    monkeypatch.setattr(feed, "threading", ended)
    widget.parameter = "time"
    assert refused.wait(PATIENCE_S)
    for thread in threading.enumerate():
        if thread.name == "flowtex-build":
            thread.join(PATIENCE_S)
    assert not any(m["kind"] == "error" for m in heard.messages)
    assert capsys.readouterr().err == ""


@pytest.mark.threads
def test_a_notebook_that_is_read_elsewhere_has_a_picture(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    free, draw = threading.Event(), still.still_png

    def held(*arguments: Any, **options: Any) -> bytes:
        free.wait(PATIENCE_S)
        return draw(*arguments, **options)

    monkeypatch.setattr(still, "still_png", held)
    widget = make(gyre(nodes=20))
    data, _ = widget._repr_mimebundle_()
    assert "image/png" not in data  # it was not waited for
    free.set()
    assert "gyre: 20 x 20" in data["text/plain"]
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == widget.model_id
    stills = [feed.still for feed in widget._feeds]
    assert stills[0] is not None and stills[0].result(PATIENCE_S)
    data, _ = widget._repr_mimebundle_()
    with Image.open(io.BytesIO(base64.b64decode(data["image/png"]))) as picture:
        assert picture.size == (800, 400)
        pixels = np.asarray(picture.convert("RGB"), dtype=float)
    assert pixels[200, 350:450].std() > 10
    assert (pixels[0, 0] == 255).all()
    widget._handle_custom_msg({"kind": "frame"}, [memoryview(b"png")])
    data, _ = widget._repr_mimebundle_()
    assert base64.b64decode(data["image/png"]) == b"png"
    widget._handle_custom_msg({"kind": "frame"}, [memoryview(b"\xff\xd8jpeg")])
    data, _ = widget._repr_mimebundle_()
    assert base64.b64decode(data["image/jpeg"]) == b"\xff\xd8jpeg"


def test_nothing_is_left_after_closing(make: Make) -> None:
    before = set(threading.enumerate())
    widget = make(gyre(3))
    settings = widget.settings
    widget.close()
    widget.close()
    assert settings._changed._listeners == []
    assert repr(widget).endswith("closed)")

    def left() -> list[str]:
        names = [thread.name for thread in set(threading.enumerate()) - before]
        return [name for name in names if name.startswith("flowtex")]

    wait_until(lambda: not left(), left)


@pytest.mark.parametrize("missing", ["anywidget", "ipywidgets", "traitlets"])
def test_a_missing_extra_is_named(missing: str) -> None:
    code = (
        f"import sys; sys.modules[{missing!r}] = None\nimport flowtex\n"
        "try:\n    flowtex.FlowWidget\nexcept ModuleNotFoundError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert f"the notebook widget needs {missing}, which is not installed" in done.stdout
    assert "[notebook]" in done.stdout


class Shell:
    """What IPython has in a notebook."""

    def __init__(self) -> None:
        self.kernel, self.display_formatter = object(), DisplayFormatter()

    execution_count = 3


def test_show_displays_once_in_a_notebook(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    import IPython
    from IPython import display as displays

    shown: list[Any] = []
    monkeypatch.setattr(IPython, "get_ipython", Shell)
    monkeypatch.setattr(displays, "display", lambda data, **_: shown.append(data))
    widget = flowtex.show(gyre(), samples=9)
    assert isinstance(widget, FlowWidget)
    assert len(shown) == 2  # the widget and its still
    widget._ipython_display_()  # as the value of the same cell
    assert len(shown) == 2
    widget._ipython_display_()
    assert len(shown) == 4
    monkeypatch.setattr(Shell, "execution_count", 4)
    widget._ipython_display_()
    assert len(shown) == 6
    with pytest.raises(FieldError, match="scalar_bar_args"):
        flowtex.show(gyre(), scalar_bar_args={"title": "speed"})
    widget.close()
    count = len(shown)
    widget.close()  # as its collection does
    assert len(shown) == count


def test_boxes_have_the_pictures_of_what_is_in_them(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    import IPython
    from IPython import display as displays
    from ipywidgets import Button, HBox, VBox

    shell, shown = Shell(), []
    monkeypatch.setattr(IPython, "get_ipython", lambda: shell)
    monkeypatch.setattr(
        displays, "display", lambda data, display_id=None, **_: shown.append((display_id, data))
    )
    first, other = make(), make()
    first._handle_custom_msg({"kind": "frame"}, [memoryview(b"\xff\xd8one")])
    format_: Any = shell.display_formatter.format
    assert format_(VBox([HBox([first, Button()]), other])) == ({}, {})
    (_, view), (name, still) = shown[:2]  # and again once it is drawn
    assert view["application/vnd.jupyter.widget-view+json"]["model_id"]
    assert still["text/html"].count("data:image/jpeg;base64,/9hvbmU=") == 1
    assert f'data-flowtex="{first._key} {other._key}"' in still["text/html"]
    # The last picture of each takes the place of the one before.
    other._handle_custom_msg({"kind": "frame"}, [memoryview(b"\xff\xd8two")])
    assert shown[-1][0] == name
    assert shown[-1][1]["text/html"].count("data:image/jpeg") == 2
    other.close()
    assert shown[-1][1]["text/html"].count("data:image/jpeg") == 1
    # Other boxes are IPython's affair.
    count = len(shown)
    assert "application/vnd.jupyter.widget-view+json" in format_(HBox([Button()]))[0]
    assert len(shown) == count


def test_it_is_written_as_a_page_from_where_it_is(
    make: Make, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.host.export.PREVIEW", (24, 16))
    widget = make(gyre(nodes=12))
    widget.camera = {"parallel_scale": 0.123}
    text = widget.to_html()
    assert text is not None
    assert Reader(text).header()["camera"]["parallel_scale"] == 0.123
    assert widget.to_html(tmp_path / "page.html", title="here") is None
    assert "<title>here</title>" in (tmp_path / "page.html").read_text()


@pytest.mark.threads
def test_messages_of_any_thread_have_the_session_of_the_widget(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    session: ContextVar[str] = ContextVar("session", default="none")
    session.set("Ada")
    widget = make(gyre(nodes=12))
    sent: list[tuple[str, str]] = []

    def send(_self: FlowWidget, content: Any, buffers: Any = None) -> None:
        sent.append((session.get(), threading.current_thread().name))

    monkeypatch.setattr(FlowWidget, "send", send)
    session.set("Bob")
    widget._handle_custom_msg({"kind": "ready"}, [])
    wait_until(lambda: sent)
    assert all(name == "Ada" for name, _ in sent)
    assert any(thread != threading.current_thread().name for _, thread in sent)


@pytest.mark.threads
def test_still_is_drawn_before_later_requests_are_answered(make: Make) -> None:
    widget, free = make(), threading.Semaphore(0)
    holders = [in_pool(free.acquire, lambda: False) for _ in range(MOST_THREADS)]
    try:
        widget._feeds[0].draw((24, 16), **widget._look())
        widget._handle_custom_msg({"kind": "ready"}, [])  # waits behind the still
        free.release()
        still = widget._feeds[0].still
        assert still is not None and still.result(PATIENCE_S)
    finally:
        free.release(len(holders))


def test_many_views_of_one_mesh_share_what_is_made_of_it(make: Make) -> None:
    first, other = make(gyre(nodes=100)), make(gyre(nodes=100), contrast=2.0)  # made twice
    assert first.field is other.field
    first_scene, other_scene = (w._feeds[0].source.scene for w in (first, other))
    assert first_scene.textures is other_scene.textures
    different = make(gyre(nodes=101))
    assert different.field is not first.field
    assert make(gyre(nodes=100), image=SQUARES).scene.store is first.scene.store


def test_two_views_are_one_widget(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    widget = make(gyre(3), beside={"cmap": "magma", "resolution": 32})
    assert widget._header_beside["own"] == {"resolution": 32}
    assert widget._header["differs"] == widget._header_beside["differs"] == ["resolution"]
    heard = Heard(widget, monkeypatch)
    heard.say(kind="ready")
    heard.wait(lambda: {0, 1} <= {m["view"] for m in heard.messages})
    # The second follows the first but in what is its own.
    second = widget._views[1].scene.settings
    widget.samples = 33
    assert second.samples == 33
    widget.lines = "streamlines"
    assert second.lines == "streamlines"
    with pytest.raises(ValueError, match=r"^beside has plane, which selects data; both views"):
        make(beside={"plane": "k=2"})
    text = widget.to_html()
    assert text is not None
    part = r'<script type="text/plain" data-view="1" data-part="[^"]*&quot;{}&quot;[^"]*">([^<]?)'
    assert [bool(found) for found in re.findall(part.format("cmap"), text)] == [True]
    # What the first view has as well lies in the page once.
    assert [bool(found) for found in re.findall(part.format("flow/0"), text)] == [False]


def test_another_flow_takes_the_place_of_the_first(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    widget = make(gyre(3), samples=30, contrast=0.5)
    heard = Heard(widget, monkeypatch)
    heard.settle()
    widget.time, widget.camera = 2.0, {"focal_point": [0.5, 0.25, 0]}
    camera, first = dict(widget.camera), heard.arrays["flow/0"]
    resent: list[Any] = []
    widget.observe(resent.append, "_shaders")
    widget.field = gyre(2, nodes=20)
    heard.wait(lambda: heard.arrays["flow/0"].shape != first.shape)
    assert widget._header["geometry"]["shape"] == [20, 20]
    assert (widget.samples, widget.contrast, widget.camera) == (30, 0.5, camera)
    assert widget.time == widget.scene.time == 1.0  # the nearest that it has
    assert resent == [] and widget._header["shaders"] is None  # the text of 60 kB stays
    # Settings reach what is shown now.
    widget.set_image(SQUARES)
    heard.wait(lambda: "image" in heard.arrays)


@pytest.mark.parametrize(
    ("scale", "shift", "same"), [(2.0, 0.1, True), (5.0, 0.0, False), (1.0, 3.0, False)]
)
def test_a_camera_that_would_miss_another_flow_shows_it_whole(
    make: Make, scale: float, shift: float, same: bool
) -> None:
    widget = make(gyre(), zoom=4.0)
    camera, at = dict(widget.camera), scale * nodes_of((9, 9)) + shift
    widget.field = flowtex.FlowField.from_arrays(at, at + 1)
    whole = Camera.fit(widget.field.surface, 480 / 300).to_dict()
    assert widget.camera == (camera if same else whole)
    points, triangles = sphere(2)
    points += widget.field.surface.center
    widget.field = flowtex.FlowField.from_triangles(points, triangles, points[:, ::-1])
    assert not widget.camera["parallel"]


def test_a_flow_that_does_not_fit_leaves_what_is_shown(make: Make) -> None:
    import pyvista as pv

    at = nodes_of((9, 9))
    warm = flowtex.FlowField.from_arrays(at, at, scalars={"heat": at[..., 0]})
    widget = make(warm, beside={"scalars": "heat"})
    field, header = widget.field, widget._header
    wrong = [
        ("mesh", r"mesh"),
        (np.zeros((3, 3)), r"velocity has shape \(3, 3\)"),
        (pv.Plane(), r"vectors"),
        (gyre(), r"^the field has no scalar 'heat'"),  # which the second view shows
    ]
    for value, said in wrong:
        with pytest.raises((ValueError, TypeError, OSError), match=said):
            widget.field = value
    assert widget.field is field and widget._header is header
    widget.cmap = "magma"
    assert widget.scene.field is field


def coloured(times: int = 1) -> flowtex.FlowField:
    field = gyre(times)
    heights = field.points[..., 1] - 0.4
    return flowtex.FlowField.from_arrays(
        field.points, field.velocity, times=field.times, scalars={"height": heights}
    )


def test_an_appearance_is_sent_without_the_slices(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    widget = make(coloured())
    heard = Heard(widget, monkeypatch)
    heard.settle()
    generation = widget._header["generation"]
    widget.scalars = "height"
    heard.wait(lambda: "scalars/0/1" in heard.arrays)
    np.testing.assert_allclose(heard.arrays["scalars/0/1"], widget.field.scalars["height"][0])
    widget.cmap = "coolwarm"
    heard.wait(lambda: (heard.arrays["cmap"] == colour_table("coolwarm")).all())
    names = {name for message in heard.messages for name in names_of(message)}
    assert names <= {"cmap", "mesh", "scalars/0/1"}
    scalars = widget._header["scalars"]
    assert (scalars["name"], scalars["number"], scalars["cmap"]) == ("height", 1, "coolwarm")
    assert scalars["low"] == -scalars["high"]  # zero is in the middle
    assert widget._header["generation"] == generation
    headers: list[Any] = []
    widget.observe(lambda change: headers.append(change["new"]), "_header")
    widget.clim, widget.opacity, widget.visible = (0, 1), 0.5, False
    wait_until(lambda: headers and headers[-1]["opacity"] == 0)
    assert (headers[-1]["scalars"]["low"], headers[-1]["scalars"]["high"]) == (0, 1)
    assert not headers[-1]["scalars"]["bar"]


def test_derived_scalars_are_sent_and_offered_while_they_are_shown(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    widget = make(coloured(2))
    heard = Heard(widget, monkeypatch)
    heard.settle()
    for name in ("vorticity", "velocity_x"):
        heard.arrays.clear()
        widget.scalars = name
        heard.wait(lambda: "scalars/0/2" in heard.arrays)
        expected = make(coloured(2), scalars=name)
        np.testing.assert_array_equal(
            heard.arrays["scalars/0/2"], np.float32(expected.field.scalars[name][0])
        )
        assert widget._header["scalars"] == expected._header["scalars"]


def test_colours_that_are_chosen_in_the_browser_are_taken(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    widget = make(coloured(), beside={"cmap": "gray"})
    heard = Heard(widget, monkeypatch)
    heard.say(kind="appearance", changes={"scalars": "height", "cmap": "magma", "clim": [0, 1]})
    assert (widget.scalars, widget.cmap, widget.clim) == ("height", "magma", (0.0, 1.0))
    second = widget._views[1].scene.appearance
    assert (second.scalars, second.cmap) == ("height", "gray")  # its own stays
    wrong_ones = ({"cmap": "nix"}, {"scalars": ["x"]}, {"clim": "ab"}, {"opacity": 3})
    for wrong in (*wrong_ones, {"lod": False}, 3, None):
        heard.say(kind="appearance", changes=wrong)
    assert (widget.scalars, widget.cmap, widget.clim) == ("height", "magma", (0.0, 1.0))
    assert widget.opacity == 1.0


def test_the_point_follows_the_time_and_ends_with_its_field() -> None:
    y, x = np.mgrid[0:1:9j, 0:2:17j]
    steps = np.array([1.0, 2.0, 4.0])[:, None, None, None] * np.ones((*x.shape, 2))
    points = np.stack([x, y], axis=-1)
    field = flowtex.FlowField.from_arrays(points, steps, times=[0.0, 5.0, 10.0])
    widget = flowtex.FlowWidget(field)
    clicked = {"position": [1.0, 0.5, 0.0], "index": [8.0, 4.0], "values": {"speed": 2**0.5}}
    widget.set_state({"point": clicked})
    for time in (5.0, 7.5, 0.0):
        widget.time = time
        expected = field.at(1.0, 0.5, time=time)
        assert expected is not None
        assert widget.point["values"]["speed"] == pytest.approx(expected.speed)
        assert widget.point["position"] == clicked["position"]
    widget.field = flowtex.FlowField.from_arrays(points, steps[0])
    assert widget.point is None
    widget.close()


@pytest.mark.threads
def test_a_setting_from_the_browser_may_come_while_a_scene_is_announced(make: Make) -> None:
    widget = make(gyre(times=2))
    (sent,) = widget._feeds
    sent.settled.wait(PATIENCE_S)
    announcing, changing = threading.Event(), threading.Event()
    lock, announce = widget._state_lock, sent._announce

    class Told:
        """The lock of the widget's state, which tells that it is held."""

        def __enter__(self) -> None:
            lock.__enter__()
            changing.set()

        def __exit__(self, *_: Any) -> None:
            lock.__exit__(None, None, None)

    def announced(header: Any) -> None:
        sent._announce = announce
        announcing.set()
        assert changing.wait(PATIENCE_S)
        announce(header)

    sent._announce = announced
    widget.parameter = "time"
    assert announcing.wait(PATIENCE_S)
    widget._state_lock = Told()  # type: ignore[assignment]
    browser = threading.Thread(target=widget.set_state, args=({"lines": "pathlines"},), daemon=True)
    browser.start()
    browser.join(PATIENCE_S)
    assert not browser.is_alive()
    assert sent.settled.wait(PATIENCE_S)
    assert sent.source.scene.textures is widget.scene.textures
