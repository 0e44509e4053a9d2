"""The notebook widget: a flow drawn by the browser itself, in a cell.

Traits send header, settings, camera, time and clock to the client, and messages of a
:class:`~flowtex.host.feed.Feed` the arrays; the client answers which steps it needs. Nothing is
drawn in the kernel but a small picture for where widgets cannot be shown.
"""

from __future__ import annotations

import asyncio
import io
import sys
import uuid
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import wait
from contextlib import suppress
from contextvars import copy_context
from pathlib import Path
from typing import Any, TypeGuard, overload

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image

from flowtex._util.arguments import is_number
from flowtex._util.array_types import Bytes
from flowtex._util.colours import rgb
from flowtex._util.forks import ProcessLock
from flowtex.errors import FieldError, install_extra
from flowtex.field import FlowField
from flowtex.field.dates import time_within
from flowtex.field.locate import locate
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.field.quantities import values_at
from flowtex.field.steps import LazySteps
from flowtex.host.export import PREVIEW, page_text, write_page
from flowtex.host.feed import Feed
from flowtex.host.still import still_png
from flowtex.host.view import WebView, browser_options, client_module, is_choice, web_views
from flowtex.rendering.camera import Camera, CameraValues, can_share_camera
from flowtex.rendering.webgl.marks import MARK_PARTS
from flowtex.rendering.webgl.protocol import Header
from flowtex.scene.array_arguments import joins_arrays
from flowtex.scene.fields import read_field, share_field
from flowtex.scene.options import SPEED, Appearance, AppearanceAttributes, ViewOptions
from flowtex.scene.scene import NO_IMAGE, Change, Scene, lay_image, link_scenes
from flowtex.settings import TABLE, Setting, SettingsError
from flowtex.textures.images import load_image
from flowtex.textures.tiles.pyramid import TileKey

try:
    import traitlets

    from flowtex.host.cell import Displayed
except ModuleNotFoundError as error:
    if (error.name or "").split(".")[0] not in ("anywidget", "ipywidgets", "traitlets"):
        raise
    missing = (
        f"the notebook widget needs {error.name}, which is not installed. To install it:\n  "
        f"{install_extra('notebook')}"
    )
    raise ModuleNotFoundError(missing, name=error.name) from error


class TraitValueError(SettingsError, traitlets.TraitError):
    """A value is refused; traitlets restores the old one after its own errors alone."""


class CheckedTrait(traitlets.TraitType[Any, Any]):
    """A value that ``check`` returns, given the present one and another, or refuses."""

    def __init__(
        self, check: Callable[[Any, Any], Any], default: Any = None, text: str = ""
    ) -> None:
        self._check = check
        super().__init__(default, help=text)
        self.tag(sync=True)

    def validate(self, obj: traitlets.HasTraits | None, value: Any) -> Any:
        """Return the value in its own type."""
        return self._check(getattr(obj, "_trait_values", {}).get(self.name), value)


def _camera(present: CameraValues | None, value: Any) -> CameraValues:
    """Return a camera as a dictionary; values that are not given stay."""
    if not isinstance(value, Camera):
        base = None
        if present:
            base = Camera(**present)
        value = Camera.from_dict(value, base)
    values: CameraValues = value.to_dict()
    return values


def _size(_: Any, value: Any) -> list[int]:
    """Return width and height in pixels of the page; a width of 0 fills the cell."""
    try:
        width, height = map(int, value)
    except (TypeError, ValueError):
        width = -1
        height = 0
    if not (0 <= width <= 16384 and 1 <= height <= 16384):
        raise FieldError(f"size is {value!r}; expected (width, height) in pixels, or (0, height)")
    return [width, height]


def _trait_of(row: Setting) -> CheckedTrait:
    return CheckedTrait(lambda _, value: row.check(value), row.default, row.text)


def _class_of_settings() -> type[traitlets.HasTraits]:
    """Return a class with one trait for each setting, as the table of settings names them."""
    traits = {name: _trait_of(row) for name, row in TABLE.items()}
    return type("SettingTraits", (traitlets.HasTraits,), traits)


SettingTraits: Any = _class_of_settings()


class Host:
    """The session in which a widget was made, for calls from any thread.

    Solara and Shiny identify the session of a call by its context, and Shiny sends nothing before
    its next flush.
    """

    def __init__(self) -> None:
        self._context = copy_context()
        self._loop: asyncio.AbstractEventLoop | None = None
        with suppress(RuntimeError):
            self._loop = asyncio.get_running_loop()

    def call(self, function: Callable[..., Any], *arguments: Any) -> None:
        """Call a function in the session, and flush what it sends."""
        # A context cannot be entered twice at one time.
        self._context.copy().run(function, *arguments)
        reactive = sys.modules.get("shiny.reactive")
        if reactive is None or self._loop is None or self._loop.is_closed():
            return

        async def flush() -> None:
            async with reactive.lock():
                await reactive.flush()

        asyncio.run_coroutine_threadsafe(flush(), self._loop)


#: Width of a still where the widget fills the cell, in pixels.
USUAL_WIDTH = 800
#: Most pixels of the sides of a still.
MOST_SIDE = 4096
#: Share of the duration by which rounding may move a time outside of it.
SLACK = 1e-9


class FlowWidget(AppearanceAttributes, SettingTraits, Displayed):
    """A flow in a notebook, drawn by the browser.

    Every setting of :class:`~flowtex.Settings` is a trait of the same name, shared with the
    browser: ``widget.samples = 25``. The appearance can be changed as well, at any time:
    ``widget.cmap = "magma"``, ``widget.scalars = "pressure"``.

    Attributes
    ----------
    field
        The flow; ``widget.field = mesh`` shows another one with the same settings. The
        camera stays too, unless the other flow would be out of view.
    {appearance}
        Arguments of the constructor, which can be changed.
    camera
        The camera: ``position``, ``focal_point``, ``up`` (three numbers each, in the mesh's
        coordinates), ``parallel``, ``parallel_scale`` and ``view_angle`` (degrees). A dict with
        some of these changes only them.
    time
        The time shown of a time-varying field, in the field's unit. It may be set to ``"last"``,
        or to a date such as ``"2000-01-02 12:00"`` if the times of the field are dates.
    clock
        Clock of the streaming of a steady flow, in seconds.
    playing
        Whether the animation runs.
    point
        The point clicked last: ``position``, ``index`` (i, j) and ``values`` at the time shown;
        ``None`` before the first click, and after another field is assigned. On a surface of
        triangles, j is the index of the triangle plus the barycentric coordinate of its second
        corner, and i the barycentric coordinate of its third.
    size
        Width and height in CSS pixels; a width of 0 fills the cell.
    bar
        Whether the bar of controls is shown on the picture.
    axes
        Axes of the picture: ``"ticks"`` with coordinates, a ``"scale"`` bar, or ``"none"``;
        ``None`` means ticks if the surface is flat or a map.

    Examples
    --------
    >>> import flowtex
    >>> widget = flowtex.FlowWidget(flowtex.examples.airfoil_field(), size=(0, 300))
    >>> widget.samples = 25
    >>> widget.camera = {"parallel_scale": 0.5}
    >>> widget.close()
    """

    _esm = client_module()

    _header = traitlets.Dict().tag(sync=True)
    _header_beside = traitlets.Dict().tag(sync=True)
    #: The text of each view's shaders: most of a header, and rarely changed.
    _shaders: Any = traitlets.List([{}, {}]).tag(sync=True)
    _key = traitlets.Unicode().tag(sync=True)
    camera = CheckedTrait(_camera).tag(echo_update=False)
    #: A number, or a date until it is checked.
    time = traitlets.Union([traitlets.Float(0.0), traitlets.Instance(object)]).tag(
        sync=True, echo_update=False
    )
    clock = traitlets.Float(0.0).tag(sync=True, echo_update=False)
    playing = traitlets.Bool(default_value=False).tag(sync=True)
    point: Any = traitlets.Dict(allow_none=True, default_value=None).tag(
        sync=True, echo_update=False
    )
    size = CheckedTrait(_size)
    bar = traitlets.Bool(default_value=True).tag(sync=True)
    axes = CheckedTrait(lambda _, value: ViewOptions(axes=value).axes)

    @overload
    def __init__(
        self,
        mesh: Any,
        vectors: str | None = None,
        scalars: str | bool | None = None,  # noqa: FBT001 False is "by nothing", as in PyVista
        cmap: Any | None = None,
        *,
        size: tuple[int, int] = (0, 400),
        bar: bool = True,
        **options: Any,
    ) -> None: ...
    @overload
    def __init__(
        self, first: ArrayLike, second: ArrayLike, /, *others: Any, **options: Any
    ) -> None: ...
    @joins_arrays(1)
    @accepts_options(FieldOptions, Appearance, ViewOptions)
    def __init__(
        self,
        mesh: Any,
        vectors: Any = None,
        scalars: Any = None,
        cmap: Any = None,
        *,
        size: tuple[int, int] = (0, 400),
        bar: bool = True,
        **options: Any,
    ) -> None:
        """Make a widget from a mesh or a field.

        Parameters
        ----------
        mesh
            PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, path
            of a file, plain arrays by position, ``x, y, u, v`` as in ``plt.streamplot``, or a
            plotter with a flow texture, whose widget also shows its other meshes and its labels.
        size, bar
            As the attributes of these names.
        {options}

        Raises
        ------
        FieldError, SettingsError
            If the mesh or a setting is invalid.
        """
        chosen = {"vectors": vectors, "scalars": scalars, "cmap": cmap}
        shown, arguments = browser_options(mesh, **chosen, **options)
        views = web_views(shown, arguments)
        self._state_lock = ProcessLock()
        self._frame: bytes | None = None
        #: A still of all that a browser shows, until it has drawn or the scene changes.
        self._still: bytes | None = None
        self._fit = arguments.view.first_camera
        self._ends: list[Callable[[], None]] = []
        #: One view or two, from left to right. The second has the settings of the first except its
        #: own, and the browser links their cameras.
        self._feeds = self._made_feeds(views)
        for view in views[1:]:
            self._link(view)
        first = self._fit(views[0].field.surface, PREVIEW[0] / PREVIEW[1])
        super().__init__(
            _key=uuid.uuid4().hex,
            camera=first.to_dict(),
            time=self.scene.time,
            size=size,
            bar=bar,
            axes=arguments.view.axes,
            **dict(self.settings),
        )
        self._reading = arguments.field
        self._start()
        self._is_made = True

    def _made_feeds(self, views: Sequence[WebView]) -> list[Feed]:
        """Return what sends each view to the browser; all show the time of the first."""
        host = Host()

        def feed(number: int, view: WebView) -> Feed:
            def announce(header: Header) -> None:
                host.call(self._announce, number, header)

            def send(content: dict[str, Any], buffers: Any) -> None:
                host.call(self.send, {**content, "view": number}, buffers)

            return Feed(view, moment=lambda: views[0].scene.time, announce=announce, send=send)

        return [feed(number, view) for number, view in enumerate(views)]

    def _link(self, view: WebView) -> None:
        """Let a second view follow the settings of the first, except its own."""
        link_scenes(lambda: self.scene, lambda: view.scene, view.own)

    def _start(self) -> None:
        """Send the first headers, and connect the traits with the scene."""
        for number, each in enumerate(self._feeds):
            self._announce(number, each.header)
        self.on_msg(self._handle_message)
        self.observe(lambda c: setattr(self.settings, c["name"], c["new"]), list(TABLE))
        self.observe(self._to_time, "time")
        self._ends = [self.settings.observe(self._set), self.scene.observe(self._scene_changed)]
        for each in self._feeds:
            each.start()

    @property
    def scene(self) -> Scene:
        """The field, its appearance and its textures."""
        return self._feeds[0].view.scene

    @property
    def _views(self) -> list[WebView]:
        return [feed.view for feed in self._feeds]

    @property
    def field(self) -> FlowField:
        """The flow. Assign another flow or mesh to show it with the same settings.

        The camera stays too, unless the other flow would be out of view.
        """
        return self.scene.field

    @field.setter
    def field(self, mesh: Any) -> None:
        if isinstance(mesh, FlowField):
            reading = FieldOptions()
        else:
            reading = self._reading
        before = self.field.surface
        field = share_field(read_field(mesh, reading))
        for view in self._views:  # all, or none if it does not fit one of them
            view.scene.showing(field, keep_range=False).close()
        for view in self._views:
            view.show(field)
        self._frame = self._still = None
        self.point = None  # of the surface before
        if not can_share_camera(before, field.surface):
            self.camera = Camera.fit(field.surface, PREVIEW[0] / PREVIEW[1]).to_dict()

    def set_image(self, image: Any) -> None:
        """Advect another image, given as for the argument ``image``."""
        views = self._views
        scenes = [view.scene for view in views]
        lay_image(scenes, load_image(image), views[-1].own)

    def set_still(self, picture: Bytes) -> None:
        """Show a picture, (H, W, 3) uint8, where no browser draws, until the scene changes."""
        Image.fromarray(picture).save(file := io.BytesIO(), "PNG")
        self._still = file.getvalue()

    def to_html(self, path: str | Path | None = None, *, title: str | None = None) -> str | None:
        """Write the current view as a page that needs no server, as :func:`flowtex.export` does.

        Parameters
        ----------
        path
            File to write; without a path the page is returned as text.
        title
            Title of the page; the name of the field by default.
        """
        shown: dict[str, Any] = {"camera": dict(self.camera), "axes": self.axes}
        shown |= {"time": self.time, "clock": self.clock}
        if path is None:
            return page_text(self._views, title=title, picture=self._frame, **shown)
        write_page(self._views, path, title=title, picture=self._frame, **shown)
        return None

    def close(self) -> None:
        """Remove the widget from the page and free its memory."""
        if "_feeds" in vars(self):  # also a widget whose constructor failed is closed
            for end in self._ends:
                end()
            self._ends = []
            for feed in self._feeds:
                feed.close()
                feed.view.close()
        super().close()
        if not sys.is_finalizing():  # a kernel that ends leaves its stills
            self._update_stills(last=True)

    @traitlets.validate("noise")
    def _check_noise(self, proposal: Any) -> Any:
        is_made = "_feeds" in vars(self)
        if proposal["value"] == "image" and is_made and self.scene.image is None:
            raise TraitValueError(NO_IMAGE)
        return proposal["value"]

    @traitlets.validate("time")
    def _check_time(self, proposal: Any) -> float:
        """Return a time, which may be a date, as a number."""
        field = self.field
        value = proposal["value"]
        first = float(field.times[0])
        last = float(field.times[-1])
        if is_number(value):
            slack = SLACK * (last - first)
            if first - slack <= float(value) <= last + slack:
                return min(max(float(value), first), last)
        try:
            return time_within(field.start, field.times, value)
        except FieldError as error:
            raise TraitValueError(str(error)) from None

    @traitlets.validate("point")
    def _check_point(self, proposal: Any) -> Any:
        """Complete a point by its place in index space."""
        point = proposal["value"]
        field = self.field
        if point is None or field.triangles is None:
            return point
        try:  # the drawn triangles may differ from those of the field
            index = locate(field, point.get("position"), tolerance=np.inf)
        except FieldError as error:
            raise TraitValueError(str(error)) from error
        if index is not None:
            index = index[::-1]
        return {**point, "index": index}

    def set_state(self, sync_data: dict[str, Any]) -> None:
        """Set the values sent by the browser; invalid ones are reset there."""
        for name, value in sync_data.items():
            with self._state_lock:
                try:
                    super().set_state({name: value})
                except (traitlets.TraitError, FieldError):
                    self.send_state(name)

    def _announce(self, number: int, header: Header) -> None:
        """Send the header of a view to the browser."""
        if len(self._feeds) > 1:
            own = self._views[1].own_settings
            settings = self._views[number].scene.settings
            values = {}
            if number:
                values = {name: getattr(settings, name) for name in own}
            header = {**header, "differs": list(own), "own": values}
        # Not while the browser's values are being set, which would delay it until after the arrays
        # that belong to it.
        with self._state_lock:
            shaders = list(self._shaders)
            shaders[number] = header["shaders"]
            self._shaders = shaders
            if number:
                trait = "_header_beside"
            else:
                trait = "_header"
            setattr(self, trait, {**header, "shaders": None})

    def _handle_message(self, _: Any, message: Any, buffers: list[memoryview]) -> None:
        """Answer the client; invalid messages are ignored."""
        if not isinstance(message, dict):
            return
        kind = message.get("kind")
        number = message.get("view", 0)
        request = message.get("request")
        for feed in self._feeds:
            feed.acknowledged.set()
            if kind == "ready":
                feed.ready()
        if kind == "frame":
            self._frame = self._still = bytes(buffers[0])
            with suppress(OSError, ValueError, TypeError, KeyError):
                self._still = self._framed(self._frame, message)
            self._update_stills()
        if kind == "appearance" and isinstance(message.get("changes"), dict):
            chosen = {}
            for n, value in message["changes"].items():
                if is_choice(n, value):
                    chosen[n] = value
            with suppress(ValueError, KeyError, TypeError):
                self.scene.change(chosen)
        is_known = isinstance(number, int) and 0 <= number < len(self._feeds)
        if is_known and isinstance(request, str):
            feed = self._feeds[number]
            if kind == "drop":
                feed.drop(request)
            if kind == "load":
                self._load(feed, request, message)

    def _load(self, feed: Feed, request: str, message: Header) -> None:
        """Send the parts of a tile or a mark that the browser requests, if they can exist."""
        key = message.get("key")
        steps = message.get("steps")
        mark = message.get("mark", "")
        if not _are_whole(steps):
            return
        if key is None and mark in ("", *MARK_PARTS.values()):
            feed.load(request, None, steps, mark)
        elif _are_whole(key) and len(key) == len(TileKey._fields):
            feed.load(request, TileKey(*key), steps)

    def _framed(self, frame: bytes, message: Header) -> bytes:
        """Return a still of a frame of the browser, with axes and annotations."""
        image = Image.open(io.BytesIO(frame)).convert("RGB")
        count = len(self._feeds)
        (width, height) = map(int, message["size"])
        size = (min(width, MOST_SIDE) // count, min(height, MOST_SIDE))
        wide = image.width // count
        ground = rgb(message["ground"])
        look = self._look()
        stills = []
        for n, feed in enumerate(self._feeds):
            part = image.crop((n * wide, 0, (n + 1) * wide, image.height))
            data = feed.source.scene
            stills.append(still_png(feed.view, size, data=data, flow=part, ground=ground, **look))
        return _side_by_side(stills)

    def _picture(self, timeout_s: float) -> bytes | None:
        """Return a still of the browser's last frame, or one that NumPy draws."""
        if self._still is not None:
            return self._still
        width = self.size[0] or USUAL_WIDTH
        height = self.size[1]
        count = len(self._feeds)
        if timeout_s > 0:
            for feed in self._feeds:
                feed.draw((width // count, height // count), **self._look())  # in the same shape
        stills = [feed.still for feed in self._feeds if feed.still is not None]
        done, _ = wait(stills, max(timeout_s, 0))
        if len(done) < count:
            return None
        pictures = []
        for still in stills:
            if still.exception():
                return None
            pictures.append(still.result())
        return _side_by_side(pictures)

    def _look(self) -> Any:
        """Return arguments of stills: a camera that was not moved fits the shape of the picture."""
        surface = self.field.surface
        camera = Camera.from_dict(dict(self.camera))
        is_moved = camera != self._fit(surface, PREVIEW[0] / PREVIEW[1])

        def fitted(aspect: float) -> Camera:
            if is_moved:
                return camera
            return self._fit(surface, aspect)

        return {
            "camera": fitted,
            "axes": self.axes,
            "differs": self._views[-1].own_settings,
        }

    def _to_time(self, change: Any) -> None:
        """Show the time of the trait."""
        if change["new"] != self.scene.time:
            self.scene.time = change["new"]
        if self.point is not None and self.field.formula is None:  # whose parameters browsers know
            self.point = self._point_now(self.point)

    def _point_now(self, point: dict[str, Any]) -> dict[str, Any] | None:
        """Return a point with its values at the time shown; none where they would be read late."""
        index = point.get("index")
        if index is None or isinstance(self.field.velocity, LazySteps):
            return None
        i, j = index
        found = values_at(self.field, (j, i), self.scene.time)
        present = {SPEED: found.speed, **found.scalars}
        values = {}
        for name in point.get("values", {}):
            if name in present:
                values[name] = float(present[name])
        return {**point, "values": values}

    def _set(self, name: str, value: Any) -> None:
        if getattr(self, name) != value:
            setattr(self, name, value)

    def _scene_changed(self, affects: Change) -> None:
        if self._frame is None:
            self._still = None
        if affects != "appearance":
            self._set("time", self.scene.time)

    def __repr__(self) -> str:
        if self.comm is None:
            state = "closed"
        else:
            state = f"time {self.time:g}"
        return f"FlowWidget({self.field!r}, {state})"


def _are_whole(values: Any) -> TypeGuard[list[int]]:
    return isinstance(values, list) and all(isinstance(value, int) for value in values)


def _side_by_side(pictures: Iterable[bytes]) -> bytes:
    """Return pictures as one PNG, from left to right."""
    first, *others = pictures
    if not others:
        return first
    columns = []
    for png in (first, *others):
        columns.append(np.asarray(Image.open(io.BytesIO(png)).convert("RGB")))
    file = io.BytesIO()
    Image.fromarray(np.hstack(columns)).save(file, "PNG")
    return file.getvalue()
