"""Frames a second on a graphics card: ``python benchmarks/card.py``.

Draws by OpenGL what the client in the browser draws, by its own shaders and the parts that it is
sent, in a view that the surface fills. Prints frames a second, as a share of :data:`GOAL` as well,
nanoseconds a pixel and sample, and the time of the passes that trace the slices of the surface or
of its tiles, of each and of a million nodes. On Linux the context is made by EGL, of the device
``GLCONTEXT_DEVICE_INDEX``, without a window. ``--picture FILE`` writes the last picture.

To draw takes NumPy and moderngl alone; to make the parts takes flowtex, but neither VTK nor a
browser. ``--write FOLDER`` writes them on one machine, and ``--read FOLDER`` draws them on another.
"""

from __future__ import annotations

import argparse
import json
import math
import struct
import sys
import time
import zlib
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

#: Rows and columns of nodes of the double gyre; "c" stands for a grid whose lines are crooked.
MESHES = ("70x120", "70x120c", "500x1000", "500x1000c", "2000x4000")
SAMPLES, SIZE = (25, 49), (1920, 1080)
#: Frames a second, and the zoom at which the surface fills the picture.
GOAL, ZOOM = 1000, 1.5
#: Seconds of a series of frames, at least; the fastest of three counts.
SERIES_S = 0.5
#: Processor time is that of the driver as well; nanoseconds are those a pixel and sample. The last
#: are milliseconds in which a layer is traced, the surface or a tile, and a million nodes are.
HEADINGS = (
    "nodes | samples | layers | triangles | ms | processor ms | frames/s | of goal | ns | "
    "ms a trace | ms a million"
)

#: What client/src/programs.ts has before a shader's text, and texture units of the samplers.
PREAMBLE = "#version 300 es\nprecision highp float;\nprecision highp int;\n"
UNITS = {"u_slices": 0, "u_cmap": 4, "u_shares": 5, "u_nodes": 7, "u_open": 9, "u_places": 10}
UNITS |= {"u_strides": 13, "u_below": 14, "u_texture": 15, "u_source": 16, "u_means": 17}
#: What stands for no value at a node.
NO_VALUE = -1e9

#: What client/src/tracer.ts has: the lag up to which paths are followed, units of the textures of a
#: pass, what stands in the fourth channel of a layer, and the length of paths that do not end.
DIRECT_LAG, ENDLESS = 4, 1e30
PASS_UNITS = {"flow": 0, "cells": 1, "padded": 2, "speed": 3, "before": 4, "earlier": 5, "last": 5}
NOTHING, SPEED, REACH = range(3)


class Drawing(NamedTuple):
    """What a picture is drawn from: ``about`` is plain for JSON, with the shaders and uniforms.

    The surface and its tiles are layers, whose arrays have names such as ``"0/slices"``.
    """

    about: dict[str, Any]
    arrays: dict[str, NDArray[Any]]

    def write(self, path: Path) -> None:
        """Write a file that :meth:`read` takes."""
        about = np.array(json.dumps(self.about, default=float))
        np.savez_compressed(path, about=about, **self.arrays)

    @classmethod
    def read(cls, path: Path) -> Drawing:
        """Return what was written to a file."""
        with np.load(path) as file:
            arrays = dict(file)
        return cls(json.loads(str(arrays.pop("about"))), arrays)


def drawing_of(view: Any, camera: Any, size: tuple[int, int], name: str = "") -> Drawing:
    """Return what the client draws of a WebView: flat, steady, coloured, without perspective.

    Its texture is less its local mean.
    """
    from flowtex.rendering.even import EvenBlocks
    from flowtex.rendering.tile_choice import finer_part
    from flowtex.rendering.uniforms import ViewState, uniforms
    from flowtex.textures.tiles.blocks import BLOCK_CELLS
    from flowtex.textures.tiles.grid_pyramid import TILE_BLOCKS

    whole, settings = replace(view.data(), traces=True), view.scene.settings
    header, pyramid = whole.header(settings), whole.pyramid
    geometry, half = whole.textures.geometry, camera.parallel_scale
    ground = header["background"] or (1.0, 1.0, 1.0)  # that of a page
    focus, pixel = np.asarray(camera.focal_point), 2 * half / size[1]
    state = ViewState(focus=focus, eye=camera.eye, pixel=pixel)
    matrix = camera.matrix(size[0] / size[1], geometry.center)
    matrix[:, :3] = matrix[:, :3] @ geometry.frame.T
    matrix[2] *= np.array([1, 1, 1, 0]) / (0.51 * geometry.extent)  # depth from the middle on
    look = {f"u_{name}": header[name] for name in ("colour", "opacity")}
    look |= {"u_lit": header["lighting"], "u_ground": ground}
    look |= {"u_mapped": True, "u_matrix": matrix.T.ravel().tolist()}
    look["u_toEye"] = (geometry.frame @ -camera.axes[2]).tolist()
    across, upward = (2 * half / size[1] * axis for axis in camera.axes[:2])
    corner = focus - geometry.center - across * size[0] / 2 - upward * size[1] / 2
    rays = {"u_rayCorner": corner, "u_rayX": across, "u_rayY": upward}
    look |= {name: (geometry.frame @ way).tolist() for name, way in rays.items()}
    rows, columns = pyramid.shape(0) if pyramid else geometry.shape
    look |= {"u_lastNode": (columns - 1, rows - 1, 0), "u_closed": geometry.periodic[::-1]}
    look |= {"u_blockCells": BLOCK_CELLS}
    finest = (
        pyramid.blocks if pyramid else tuple(-(-(n - 1) // BLOCK_CELLS) for n in geometry.shape)
    )
    strides, drawn = np.zeros(finest, np.uint8), []
    for key, data, parts, finer in _shown(whole, settings, camera, size):
        blocks = np.ones(parts["mesh"].shape[:2], dtype=bool)
        for child in finer:
            blocks[finer_part(pyramid, child, key)] = False
        step, *place = key or (pyramid.depth if pyramid else 0, 0, 0)
        for block in np.argwhere(blocks):
            top, left = (block + TILE_BLOCKS * np.array(place)) << step
            strides[top : top + (1 << step), left : left + (1 << step)] = step
        above, before = data.textures.geometry.padding
        values = {**uniforms(data.textures, settings, state), **look, "u_padding": (before, above)}
        start = TILE_BLOCKS * BLOCK_CELLS * np.array(place[::-1]) << step
        values |= {"header": data.tile_header, "u_part": (*start.tolist(), step)}
        if blocks.any():
            own = {**_arrays(data, parts), "blocks": BLOCK_CELLS * np.argwhere(blocks)[:, ::-1]}
            drawn.append((values, own))
    layers, arrays = [values for values, _ in drawn], {"cmap": whole.colours.scale.texels}
    arrays["strides"] = strides
    for n, (_, own) in enumerate(drawn):
        arrays |= {f"{n}/{part}": array for part, array in own.items()}
    # Where there are tiles, hardly anything of the root is seen, and all have one variant.
    near = any(values["near"] for values in layers[pyramid is not None :] or layers)
    variant = {"FLOWTEX_MOVING": layers[0]["moving"], "FLOWTEX_CELLS": near}
    defines = "".join(f"#define {define}\n" for define, is_on in variant.items() if is_on)
    names = ("fullVertex", "trace", "layers", "even", "colour")
    shaders = {name: header["shaders"][name] for name in names}
    shaders |= {k: defines + header["shaders"][k] for k in ("vertex", "place", "fragment")}
    about = {"name": name, "size": size, "samples": settings.samples, "layers": layers}
    about |= {"shaders": shaders, "background": ground}
    width, height = size
    about["even"] = asdict(EvenBlocks.of(settings.grain, (0, width, 0, height)))
    return Drawing(about, arrays)


def _shown(whole: Any, settings: Any, camera: Any, size: tuple[int, int]) -> Iterator[Any]:
    """Give the key, data and parts of the root and of tiles, and the tiles that cover some."""
    from flowtex.host.view import TileSource
    from flowtex.rendering import tile_choice as choice

    shown: dict[Any, Any] = {None: []}
    if whole.pyramid is not None:
        (right, up, _), half, focus = camera.axes, camera.parallel_scale, camera.focal_point
        reaches = (right, half * size[0] / size[1]), (up, half)
        sides = [(by * axis, reach) for axis, reach in reaches for by in (1, -1)]
        planes = np.array([[*side, reach - side @ focus] for side, reach in sides])
        sight = choice.TileView(None, half, size[1], planes, choice.cell_pixels(settings))
        shown = choice.cover(choice.choose_tiles(whole.pyramid, sight), lambda key: True)
    yield None, whole, {**whole.surface(), **whole.step(0)}, shown.pop(None)
    source = TileSource(whole)
    for key, finer in shown.items():
        tile = source.tile(key, [0])
        if tile is not None:  # something of it is drawn
            parts = {n.split("/", 4)[4]: p for n, p in source.parts(key, [0]).items()}
            yield key, tile, parts, finer


def _arrays(data: Any, parts: Any) -> dict[str, NDArray[Any]]:
    """Return the nodes of what the client is sent, and what slices are traced from."""
    colours, trace = data.colours, data.tile_header["slices"]["trace"]
    (rows, columns), (top, left) = data.textures.geometry.shape, trace["drawn"]
    drawn = parts["padded"][1 + top : 1 + top + rows, 1 + left : 1 + left + columns]
    (values,) = (part for name, part in parts.items() if name.startswith("scalars/"))
    share = (values - colours.scale.low) / ((colours.scale.high - colours.scale.low) or 1.0)
    share = np.where(np.isfinite(share), share, NO_VALUE).astype(np.float32)
    return {
        "position": (drawn + np.float32(trace["middle"])).astype(np.float32),
        "shares": np.stack([share] * 2, axis=-1),
        "flow": parts["flow/0"],
        "unit": parts["unit"],
        "padded": parts["padded"],
    }


def drawings(meshes: list[str], samples: list[int]) -> Iterator[Drawing]:
    """Make what is drawn of each mesh with each number of samples, coloured by speed."""
    from scenes import gyre_field

    from flowtex.host.view import web_views
    from flowtex.rendering.camera import Camera
    from flowtex.scene.options import Options

    for mesh in meshes:
        rows, columns = (int(n) for n in mesh.removesuffix("c").split("x"))
        flow = gyre_field(columns, rows, crooked=mesh.endswith("c"))
        camera = Camera.fit(flow.surface, SIZE[0] / SIZE[1], zoom=ZOOM)
        name = f"{columns} x {rows}" + ", crooked" * mesh.endswith("c")
        for count in samples:
            yield drawing_of(web_views(flow, Options.split(samples=count))[0], camera, SIZE, name)


def opened_card() -> Any:
    """Return a context of OpenGL without a window."""
    import moderngl

    by = {"backend": "egl"} if sys.platform == "linux" else {}
    context = moderngl.create_context(standalone=True, **by)
    context.enable_only(moderngl.DEPTH_TEST)
    context.gc_mode, context.depth_func = "auto", "<"
    return context


class Tracing:
    """The passes that trace a layer's slices of a steady flow, as client/src/tracer.ts has them.

    Surfaces with poles or blanked nodes are left out.
    """

    def __init__(
        self, context: Any, shaders: dict[str, str], header: dict[str, Any], arrays: dict[str, Any]
    ) -> None:
        self._context, (geometry, slices) = context, (header["geometry"], header["slices"])
        self._lags, self._sides, self.count = (slices[k] for k in ("lags", "sides", "count"))
        trace, flow = slices["trace"], arrays["flow"].astype(np.float32)
        self.nodes = rows, columns = trace["nodes"]
        self.size = width, height = geometry["columns"]["size"], geometry["rows"]["size"]
        unit = (arrays["unit"].astype(np.float32) * trace["unit"]).reshape(rows, columns)
        speed = flow[..., 2]
        pace = speed / unit
        texels = [
            np.stack([flow[..., 0] * pace, flow[..., 1] * pace, speed, unit], axis=-1),
            np.broadcast_to(np.float32([1, 0, 0, 0]), (rows, columns, 4)),
            np.pad(arrays["padded"], ((0, 0), (0, 0), (0, 1))),
            np.pad(flow[..., -1:], ((0, 0), (0, 0), (0, 3))),
        ]
        self._constant = [self._texture(t.shape[1::-1], "f4", t.tobytes()) for t in texels]
        # Paths at the first lag, at the last two, and where they are put next.
        self._pool = [self._texture((columns, rows), "u4") for _ in range(4)]
        self.layer = self._texture(self.size, "f2")
        targets = [*self._pool, self.layer]
        self._frames = {texture: context.framebuffer([texture]) for texture in targets}
        self._values: dict[str, Any] = {
            **{f"u_{name}": number for name, number in PASS_UNITS.items()},
            "u_longest": trace.get("longest", ENDLESS),
            "u_nodes": (columns, rows),
            "u_closed": trace["closed"][::-1],
            "u_first": trace["first"][::-1],
            "u_texels": (width, height),
            "u_offsetJ": np.ravel(trace["offset"])[:3],
            "u_offsetI": np.ravel(trace["offset"])[3:],
            "u_timed": 0.0,
            "u_unit": slices["unit"],
            "u_cell": slices["cell"] / slices["unit"],
            "u_planar": float(geometry["planar"]),
            "u_mostReach": 2 * self._lags[-1],
            **{f"u_{name}": trace[name] for name in ("rest", "pace")},
        }
        self._follow = self._pass(shaders, "trace")
        self._compose = self._pass(shaders, "trace", "COMPOSED")
        self._slopes = self._pass(shaders, "layers", "FLOATS", "SLOPES")
        self._tangents = self._pass(shaders, "layers", "FLOATS")

    def _texture(self, size: Any, dtype: str, data: bytes | None = None) -> Any:
        texture = self._context.texture(tuple(size), 4, data, dtype=dtype)
        texture.filter = self._context.NEAREST, self._context.NEAREST
        return texture

    def _pass(self, shaders: dict[str, str], kind: str, *defines: str) -> Any:
        text = "".join(f"#define FLOWTEX_{define}\n" for define in defines) + shaders[kind]
        vertex, fragment = PREAMBLE + shaders["fullVertex"], PREAMBLE + text
        program = self._context.program(vertex_shader=vertex, fragment_shader=fragment)
        return self._context.vertex_array(program, [])

    def _draw(self, target: Any, triangle: Any, textures: Any = (), **values: Any) -> None:
        self._frames[target].use()
        for n, texture in enumerate((*self._constant, *textures)):
            texture.use(n)
        values = self._values | {f"u_{name}": value for name, value in values.items()}
        for name in values.keys() & set(triangle.program):
            uniform, value = triangle.program[name], values[name]
            uniform.value = value if np.ndim(value) == 0 else tuple(map(float, value))
        triangle.render(vertices=3)

    def layers(self) -> Iterator[int]:
        """Trace, and give the numbers of layers; each is in ``layer`` until the next one."""
        self._context.disable(self._context.DEPTH_TEST)
        lags, layer = self._lags, partial(self._draw, self.layer)
        layer(self._tangents, inCells=0.0)
        yield 0
        if self.count > 1 + self._sides * len(lags):
            layer(self._tangents, inCells=1.0)
            yield self.count - 1
        for side in range(self._sides):
            sign, start = 2 * side - 1, 1 + side * len(lags)
            first = before = now = self._pool[0]
            for m, lag in enumerate(lags):
                begin, earlier = (lags[k] if k >= 0 else 0.0 for k in (m - 1, m - 2))
                composes = lag > DIRECT_LAG and earlier > 0
                then = next(t for t in self._pool if t not in (first, before, now))
                times = {"lagEarlier": earlier, "from": begin, "to": lag, "side": float(sign)}
                self._draw(
                    then, self._compose if composes else self._follow, (now, before), **times
                )
                before, now = now, then
                first = first if m else now
                if m:
                    fourth = SPEED if m == 1 and not side else NOTHING
                    layer(self._slopes, (now, now), fourth=float(fourth), lag=sign * lag)
                    yield start + m
            layer(self._slopes, (first, now), fourth=float(REACH), lag=sign * lags[0])
            yield start
        self._context.enable(self._context.DEPTH_TEST)


class Means:
    """The local means of a texture, as client/src/even.ts draws them in two passes."""

    def __init__(self, context: Any, shaders: dict[str, str], blocks: dict[str, Any]) -> None:
        self._program = context.program(
            vertex_shader=PREAMBLE + shaders["fullVertex"],
            fragment_shader=PREAMBLE + shaders["even"],
        )
        self._screen = context.vertex_array(self._program, [])
        columns, rows = blocks["size"]
        (right, high), (left, low) = blocks["end"], blocks["first"]
        self._across, self._upward = right - left, high - low
        self._by_row = context.texture((columns, self._upward), 1, dtype="f4")
        self.texture = context.texture((columns, rows), 1, dtype="f4")
        for texture in (self._by_row, self.texture):
            texture.filter = context.NEAREST, context.NEAREST
        self._frames = [context.framebuffer([t]) for t in (self._by_row, self.texture)]
        self._first = left, low
        self._program["u_source"].value = UNITS["u_source"]
        for name in ("side", "variance", "reach"):
            self._program[f"u_{name}"].value = blocks[name]

    def draw(self, texture: Any) -> None:
        """Draw the means along the rows of a texture, and of these along the columns."""
        self._draw(0, texture, self._first, (1, 0), self._across)
        self._draw(1, self._by_row, (0, 0), (0, 1), self._upward)

    def _draw(
        self, frame: int, source: Any, first: Any, along: tuple[int, int], count: int
    ) -> None:
        self._frames[frame].use()
        source.use(UNITS["u_source"])
        self._program["u_from"].value = first
        self._program["u_along"].value = along
        self._program["u_count"].value = count
        self._screen.render(vertices=3)


class Picture:
    """A picture whose arrays are on the card."""

    def __init__(self, context: Any, drawing: Drawing) -> None:
        self._context, (self._about, self._arrays) = context, drawing
        shaders, size = self._about["shaders"], tuple(self._about["size"])
        texts = (("vertex", "place"), ("fullVertex", "fragment"), ("fullVertex", "colour"))
        #: Of the places, of the sums and of the colours.
        self._programs = [
            context.program(
                vertex_shader=PREAMBLE + shaders[vertex],
                fragment_shader=PREAMBLE + shaders[fragment],
            )
            for vertex, fragment in texts
        ]
        self._triangles, *self._screens = (context.vertex_array(p, []) for p in self._programs)
        self._target = context.simple_framebuffer(size)
        places = context.texture(size, 4, dtype="u4")
        below, self._texture = (context.texture(size, 4, dtype=of) for of in ("f1", "f2"))
        self._places = context.framebuffer([places], context.depth_renderbuffer(size))
        self._sums = context.framebuffer([below, self._texture])
        self._means = Means(context, shaders, self._about["even"])
        colours, strides = self._arrays["cmap"], self._arrays["strides"]
        constant = {
            "u_cmap": context.texture((len(colours), 1), 4, colours.tobytes(), dtype="f4"),
            "u_places": places,
            "u_below": below,
            "u_texture": self._texture,
            "u_means": self._means.texture,
            "u_open": context.texture((1, 1), 1, b"\1", alignment=1, dtype="u1"),
            "u_strides": context.texture(
                strides.shape[::-1], 1, strides.tobytes(), alignment=1, dtype="u1"
            ),
        }
        for texture in constant.values():
            texture.filter = context.NEAREST, context.NEAREST
        self._constant = constant
        self._tracings: list[Tracing] = []
        self._layers = [self._layer(n, own) for n, own in enumerate(self._about["layers"])]
        self._written: dict[tuple[int, str], bytes] = {}

    def _layer(self, n: int, uniforms: dict[str, Any]) -> tuple[Any, ...]:
        """Return the blocks, the textures and the uniforms of a layer."""
        context = self._context
        names = ("position", "blocks", "flow", "unit", "padded", "shares")
        own = {k: self._arrays[f"{n}/{k}"] for k in names}
        tracing = Tracing(context, self._about["shaders"], uniforms["header"], own)
        self._tracings.append(tracing)
        slices = context.texture_array((*tracing.size, tracing.count), 4, dtype="f2")
        for layer in tracing.layers():
            slices.write(tracing.layer.read(), (0, 0, layer, *tracing.size, 1))
        slices.repeat_x = slices.repeat_y = False
        slices.build_mipmaps(0, int(uniforms["u_deepest"]))
        rows, columns, _ = own["shares"].shape
        shares = context.texture((columns, rows), 2, own["shares"].tobytes(), dtype="f4")
        nodes = context.texture_array((columns, rows, 1), 3, own["position"].tobytes(), dtype="f4")
        shares.filter = nodes.filter = context.NEAREST, context.NEAREST
        blocks = {f"u_{name}": self._about["even"][name] for name in ("first", "side")}
        given = uniforms | UNITS | blocks | {"u_layer": n + 1}
        values = [self._values(program, given) for program in self._programs]
        return own["blocks"], {"u_slices": slices, "u_shares": shares, "u_nodes": nodes}, values

    @staticmethod
    def _values(program: Any, given: dict[str, Any]) -> list[tuple[Any, bytes]]:
        values = []
        for name in given.keys() & set(program):
            uniform, number = program[name], np.ravel(given[name])
            # An array may have more places than are used.
            numbers = np.zeros(uniform.array_length * uniform.dimension, "if"["f" in uniform.fmt])
            numbers[: len(number)] = number
            values.append((uniform, numbers.tobytes()))
        return values

    def _set(self, program: int, values: list[tuple[Any, bytes]]) -> None:
        for uniform, data in values:
            if self._written.get((program, uniform.name)) != data:  # of the layer before
                uniform.write(data)
                self._written[program, uniform.name] = data

    def draw(self) -> None:
        """Draw a frame: the places of all layers, their sums, local means, and then colours."""
        # The passes that trace have other textures there.
        for name, texture in self._constant.items():
            texture.use(UNITS[name])
        self._context.enable(self._context.DEPTH_TEST)
        self._places.use()
        self._places.clear()
        for blocks, textures, values in self._layers:
            textures["u_nodes"].use(UNITS["u_nodes"])
            self._set(0, values[0])
            rows, columns = textures["u_shares"].size[::-1]
            cells = int(self._about["layers"][0]["u_blockCells"])
            for x, y in blocks:
                across, upward = min(cells, columns - 1 - x), min(cells, rows - 1 - y)
                self._programs[0]["u_block"].value = float(x), float(y), 0.0, float(across)
                self._triangles.render(vertices=6 * int(across) * int(upward))
        self._context.disable(self._context.DEPTH_TEST)
        self._sums.use()
        self._sums.clear()
        for _, textures, values in self._layers:
            for name, texture in textures.items():
                texture.use(UNITS[name])
            self._draw_pixels(1, values)
        self._means.draw(self._texture)
        self._target.use()
        self._target.clear(*self._about["background"], 1.0)
        for _, _, values in self._layers:
            self._draw_pixels(2, values)

    def _draw_pixels(self, program: int, values: Any) -> None:
        self._set(program, values[program])
        self._screens[program - 1].render(vertices=3)

    def pixels(self) -> NDArray[Any]:
        """Draw a frame and return it, (H, W, 3)."""
        self.draw()
        read = np.frombuffer(self._target.read(components=3), np.uint8)
        return read.reshape(self._about["size"][1], -1, 3)[::-1]

    def row(self) -> tuple[Any, ...]:
        """Measure frames, and return a row of the table."""

        def trace() -> None:
            for tracing in self._tracings:
                for _ in tracing.layers():
                    pass

        def series(count: int, work: Callable[[], None] = self.draw) -> NDArray[Any]:
            self._context.finish()
            start = time.perf_counter(), time.process_time()
            for _ in range(count):
                work()
            self._context.finish()
            return np.subtract((time.perf_counter(), time.process_time()), start)

        about = self._about
        count, spent = 1, np.minimum(series(1), series(1))  # the first is slow by itself
        while spent[0] < SERIES_S:
            count *= min(max(math.ceil(1.2 * SERIES_S / spent[0]), 2), 10)
            spent = series(count)
        seconds, work = np.min([spent, series(count), series(count)], axis=0) / count
        blocks = (len(a) for n, a in self._arrays.items() if n.endswith("/blocks"))
        triangles = 2 * about["layers"][0]["u_blockCells"] ** 2 * sum(blocks)
        rate = 1 / seconds
        each = 1e9 * seconds / (math.prod(about["size"]) * about["samples"])
        times = f"{1e3 * seconds:.2f}", f"{1e3 * work:.2f}", f"{rate:.3g}", f"{rate / GOAL:.2g}"
        whole = about["name"], about["samples"], len(about["layers"]), triangles
        traced = 1e3 * min(series(1, trace)[0] for _ in range(2))
        nodes = sum(math.prod(tracing.nodes) for tracing in self._tracings)
        a_layer, a_million = traced / len(self._tracings), 1e6 * traced / nodes
        return *whole, *times, f"{each:.3g}", f"{a_layer:.3g}", f"{a_million:.3g}"


def png(picture: NDArray[Any]) -> bytes:
    """Return a picture (H, W, 3) as a file."""
    height, width, _ = picture.shape
    rows = np.insert(picture.reshape(height, -1), 0, 0, axis=1)  # each begins with its filter, none
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = b"IHDR" + header, b"IDAT" + zlib.compress(rows.tobytes()), b"IEND"
    sizes = (struct.pack(">I", len(chunk) - 4) for chunk in chunks)
    sums = (struct.pack(">I", zlib.crc32(chunk)) for chunk in chunks)
    return b"\x89PNG\r\n\x1a\n" + b"".join(sum(zip(sizes, chunks, sums, strict=True), ()))


def main() -> None:
    """Measure, or write what is measured elsewhere."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meshes", nargs="*", default=MESHES)
    parser.add_argument("--samples", nargs="*", type=int, default=SAMPLES)
    for name in ("write", "read", "picture"):
        parser.add_argument(f"--{name}", type=Path)
    given = parser.parse_args()
    made = drawings(given.meshes, given.samples)
    if given.write:
        given.write.mkdir(parents=True, exist_ok=True)
        for n, drawing in enumerate(made):
            drawing.write(given.write / f"{n:02}.npz")
        return
    if given.read:
        made = (Drawing.read(path) for path in sorted(given.read.glob("*.npz")))
    context = opened_card()
    sys.stdout.write("{GL_RENDERER}, OpenGL {GL_VERSION}\n\n".format(**context.info))
    sys.stdout.write(f"| {HEADINGS} |\n|{' --- |' * (HEADINGS.count('|') + 1)}\n")
    for drawing in made:
        picture = Picture(context, drawing)
        sys.stdout.write(f"| {' | '.join(map(str, picture.row()))} |\n")
        sys.stdout.flush()
        if given.picture:
            given.picture.write_bytes(png(picture.pixels()))


if __name__ == "__main__":
    main()
