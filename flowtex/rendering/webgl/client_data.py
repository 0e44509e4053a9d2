"""The data from which a client in a browser draws a flow.

The header has the numbers from which the client computes the uniforms, so that it answers a slider
without asking; see :mod:`flowtex.rendering.uniforms` for what they are. Arrays come in the smallest
type that does: slopes in half precision, as on every graphics card, normals in sixteen bits.
Positions and scalars keep single precision.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from dataclasses import field as data_field
from functools import cache, cached_property

import numpy as np

from flowtex._util.array_types import Bytes, Floats, Floats32
from flowtex._util.colours import CMAPS, ENTRIES, ColourScale, colour_table, is_diverging
from flowtex.field import FlowField
from flowtex.field.earth.coast import Coast
from flowtex.field.formula.formula import Formula
from flowtex.field.interpolation import steps_around
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, CameraValues
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.tile_choice import CELL_PIXELS
from flowtex.rendering.uniforms import client_constants, variants
from flowtex.rendering.webgl import velocity
from flowtex.rendering.webgl.bodies import Bodies
from flowtex.rendering.webgl.earth import dates_of, earth_header, earth_parts
from flowtex.rendering.webgl.marks import Marks
from flowtex.rendering.webgl.protocol import FORMAT, Header, Parts, plain_list
from flowtex.rendering.webgl.velocity import (
    Packing,
    client_formula,
    formula_header,
    half,
    packing_of,
    parameter_rows,
)
from flowtex.settings import NEEDS, TABLE, Settings
from flowtex.textures.images import ImageTextures
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.blocks import BLOCK_CELLS, block_places
from flowtex.textures.tiles.pyramid import PATH_CELLS, Pyramid, TileKey
from flowtex.textures.triangle_geometry import TriangleGeometry

#: Shaders of the client.
SHADERS = ("vertex", "fragment", "place", "surface", "full_vertex", "probe", "even", "colour")
SHADER_PAIRS = ("line", "ground", "body", "arrow")  #: Pairs of a vertex and a fragment shader.
TRACE_SHADERS = ("trace", "layers")  #: Shaders of a client that traces.
_COMMENTS = re.compile(r"[ \t]*//[^\n]*|^[ \t]+|\n(?=\s*(?://[^\n]*)?\n)", re.MULTILINE)
FIRST_ASPECT = 1.5  #: Width over height of the picture that a first camera is made for.
NORMAL_MAX = 32767  #: Greatest value of a component of a normal in sixteen bits.
SINGLE_MAX = float(np.finfo(np.float32).max)  #: Greatest number in single precision.


@dataclass(frozen=True, eq=False)
class Colours:
    """How the surface is coloured."""

    #: Name of the scalar, ``None`` for a plain surface, and text for the legend.
    name: str | None = None
    unit: str = ""
    values: Floats | None = None  #: Values at all nodes of the field, (T or 1, J, I).
    scale: ColourScale = data_field(default_factory=ColourScale)  #: Their colours.
    #: Number of colours of a map that is chosen instead, and whether it is reversed.
    entries: int = ENTRIES
    flip: bool = False
    #: Colours from 0 to 1 where there are no values, and behind the surface: ``None`` for that of
    #: the page around.
    plain: tuple[float, float, float] = (0.63, 0.63, 0.63)
    background: tuple[float, float, float] | None = None
    lighting: bool = False  #: Whether the surface is lit.
    opacity: float = 1.0  #: How much of the background it hides, 0 to 1.
    bar: bool = True  #: Whether there is a legend.
    #: Numbers and values of other scalars, sent as well where nobody can be asked later.
    others: tuple[tuple[int, Floats], ...] = ()
    number: int = 0  #: Number of the scalar among the scalars of the field.
    #: Scalars that a user may choose for the colours: name, label, unit, automatic range, and
    #: whether it varies.
    choices: tuple[Header, ...] = ()
    #: Name of the colour map, empty if it has no name, and whether its range is automatic.
    cmap: str = ""
    auto: bool = True
    label: str = ""
    flat: bool = False  #: Whether the values belong to cells.
    coastlines: bool = False  #: Whether these lines are drawn on a map of the Earth.
    coast: Coast | None = None  #: Lines in place of the coasts of the package.
    graticule: bool = False
    #: Colour from 0 to 1 of places without data on a map; ``None`` where they are not drawn.
    land: tuple[float, float, float] | None = None


@dataclass(frozen=True, eq=False)
class ClientData:
    """A flow and its colours, ready to be sent."""

    textures: TextureSet
    colours: Colours = data_field(default_factory=Colours)
    chosen: tuple[int, ...] = ()  #: Numbers of the times that are sent, increasing; empty for all.
    pyramid: Pyramid | None = None  #: Tiles of a large flow, if this is its root.
    finest: int = 0  #: Finest level that is sent.
    depth: int = 0  #: Level of the root, if this is a tile.
    traces: bool = False  #: Whether the client receives the velocity, where it can trace it.
    bodies: Bodies | None = None  #: Other meshes.
    marks: Marks | None = None  #: Its structure.

    @cached_property
    def traced(self) -> bool:
        """Whether the client traces the slices."""
        # Pathlines lead through all steps, and not only through those that are sent.
        is_whole = not self.chosen or self.textures.store.streamlines
        return self.traces and is_whole and velocity.can_trace(self.textures)

    @cached_property
    def formula(self) -> Formula | None:
        """The formula that is sent in place of the velocity."""
        if self.traced and self.pyramid is None:
            return client_formula(self.textures)
        return None

    @property
    def _parameters(self) -> list[Header]:
        if self.formula is None:
            return []
        return parameter_rows(self.formula)

    @cached_property
    def packing(self) -> Packing:
        """The slices, packed."""
        return packing_of(self.textures)

    def recoloured(self, colours: Colours) -> ClientData:
        """Return the same flow in other colours."""
        other = replace(self, colours=colours)
        if "packing" in vars(self):
            vars(other)["packing"] = self.packing
        return other

    @property
    def field(self) -> FlowField:
        """The flow that is drawn."""
        return self.textures.geometry.field

    @property
    def steps(self) -> int:
        """Number of destination times that are sent."""
        return len(self.chosen) or self.textures.store.steps

    @property
    def times(self) -> Floats:
        """Destination times, (steps,), in the field's own unit."""
        times = self.textures.geometry.field.times
        if self.chosen:
            return times[list(self.chosen)]
        return times

    @property
    def first_time(self) -> float:
        """The time that is shown first: of those that are sent, the first when something moves."""
        if self.chosen:
            return float(self.times[0])
        return self.field.first_time

    def first_camera(self, aspect: float = FIRST_ASPECT) -> Camera:
        """Return the camera that shows the whole surface in a picture of a shape."""
        return Camera.fit(self.textures.geometry.field.surface, aspect)

    def header(
        self,
        settings: Settings,
        *,
        camera: CameraValues | None = None,
        time: float | None = None,
        clock: float = 0.0,
    ) -> Header:
        """Return all that is not an array, for JSON; by default of the whole and the first time."""
        return {
            **self.constants(),
            "settings": dict(settings) | {row["name"]: row["default"] for row in self._parameters},
            "camera": self.first_camera().to_dict() if camera is None else dict(camera),
            "time": float(self.first_time if time is None else time),
            "clock": float(clock),
        }

    def constants(self) -> Header:
        """Return the part of the header that changes only with the textures or the colours."""
        textures = self.textures
        colours = self.colours
        variant = sorted(variants(textures, unsteady=self.steps > 1))
        return {
            "format": FORMAT,
            "name": textures.geometry.field.name,
            "variant": variant,
            "shaders": dict(_shaders(tuple(variant), traces=self.traces)),
            "geometry": self._geometry(),
            "slices": self._slices(),
            "lengthUnit": self.field.length_unit,
            "speed": self._speed(),
            "scalars": self._scalars(),
            "colour": plain_list(colours.plain),
            "background": colours.background and plain_list(colours.background),
            "lighting": bool(colours.lighting),
            "opacity": float(colours.opacity),
            "image": None if textures.image is None else _image(textures.image),
            "constants": client_constants(),
            "mesh": {"tileCells": BLOCK_CELLS},
            "earth": self._earth(),
            "bodies": None if self.bodies is None else self.bodies.header(),
            "structure": None if self.marks is None else self.marks.header(),
            "pyramid": None if self.pyramid is None else _pyramid(self.pyramid, self.finest),
            "limits": {**asdict(CAMERA_LIMITS), "aspect": FIRST_ASPECT},
            "table": [*self._parameters, *_table()],
            **(formula_header(self.formula, self.textures.grid.shape) if self.formula else {}),
        }

    def _scalars(self) -> Header:
        """Return the part of the header about the scalar that is drawn, and the others."""
        colours = self.colours
        scale = colours.scale
        names = ("name", "unit", "number", "cmap", "auto", "bar", "flat", "entries", "flip")
        header: Header = {name: getattr(colours, name) for name in names}
        beyond: list[list[float] | None] = []
        for colour in (scale.below, scale.above, scale.nan):
            if colour is None:
                beyond.append(None)
            else:
                beyond.append(plain_list(colour))
        choices = []
        for choice in colours.choices:
            steps = 1
            if choice["steps"] > 1:
                steps = self.steps
            choices.append({**choice, "steps": steps})
        steps = 1
        if colours.values is not None and len(colours.values) > 1:
            steps = self.steps
        header.update(
            label=colours.label or colours.name or "",
            low=float(scale.low),
            high=float(scale.high),
            log=scale.log_scale,
            ticks=[{"value": value, "text": text} for value, _, text in scale.marks],
            beyond=beyond,
            steps=steps,
            choices=choices,
            maps=list(CMAPS),
            diverging=list(filter(is_diverging, CMAPS)),
        )
        return header

    def surface(self) -> Parts:
        """Return the arrays that are the same at all times, the smallest first."""
        geometry = self.textures.geometry
        colours = self.colours
        parts: Parts = {}
        if len(colours.scale.table) and (colours.choices or colours.name is not None):
            parts["cmap"] = colours.scale.part
        if colours.choices:
            parts["maps"] = _maps()
        if isinstance(geometry, TriangleGeometry):
            parts["blocks"] = geometry.blocks.astype("<u2")
            parts["triangles"] = geometry.triangles.astype("<u4")
        elif not geometry.cells.all():
            parts["cells"] = geometry.cells.astype(np.uint8)
        if not (geometry.planar or (self.traced and self.textures.grid.is_smooth)):
            parts["normal"] = np.rint(geometry.normal * NORMAL_MAX).astype("<i2")
        if self.pyramid is not None:
            parts["places"] = self._places(self.pyramid)
        parts["mesh"] = self._mesh
        if self.traced:
            parts |= velocity.surface_parts(self.textures, self._depth)
        else:
            parts["position"] = np.ascontiguousarray(geometry.position, "<f4")
        if (image := self.textures.image) is not None:
            parts["step"] = half(image.step)
            parts["image"] = half(image.texels)
        if self.bodies is not None:
            parts |= self.bodies.parts(geometry)
        land = colours.land is not None
        tiled = self.pyramid is not None
        earth = earth_parts(geometry, has_land=land, tiled=tiled, coast=colours.coast)
        return {**parts, **earth}

    def _places(self, pyramid: Pyramid) -> Floats32:
        """Return the places of the blocks of all levels, (N, 5), one level after the other."""
        found = []
        for level in range(pyramid.depth + 1):
            # Blocks of which no finer ones are sent are drawn however large their cells are.
            if level > self.finest:
                places = pyramid.smooth_places(level)
            else:
                places = pyramid.places(level)
            found.append(places.reshape(-1, 5))
        return np.concatenate(found).astype("<f4")

    def step(self, step: int) -> Parts:
        """Return the arrays of a time step, the smallest first.

        Raises
        ------
        IndexError
            When the step does not exist.
        """
        if not 0 <= step < self.steps:
            raise IndexError(f"time step {step} does not exist: expected 0 to {self.steps - 1}")
        parts = self.values(step)
        if self.formula is not None:
            return parts
        for kind in self.marks.kinds if self.marks and self.marks.carried else ():
            parts |= self.mark(kind, step)
        if self.traced:
            parts[f"flow/{step}"] = velocity.velocity_part(self.textures, self.source(step))
            return parts
        packed = self.packing.step(self.source(step))
        parts[f"extra/{step}"] = packed.extra
        parts[f"slices/{step}"] = packed.slopes
        return parts

    def mark(self, kind: str, step: int) -> Parts:
        """Return the marks of a kind of :data:`MARK_PARTS` at one destination time, if any."""
        if self.marks is None:
            return {}
        return self.marks.parts(kind, self.source(step), step, self.textures.geometry)

    def values(self, step: int, *, shown: bool = False) -> Parts:
        """Return the values of one destination time, or only those that are shown."""
        parts: Parts = {}
        if self.formula is not None:
            return parts
        for number, values in self._values.items():
            if not shown or number == self.colours.number:
                if len(values) > 1:
                    source = step
                else:
                    source = 0
                if number:
                    name = f"scalars/{source}/{number}"
                else:
                    name = f"scalars/{source}"
                parts[name] = single(values[source])
        return parts

    def tile(self, textures: TextureSet, values: Callable[[str], Floats]) -> ClientData:
        """Return the data of a tile; ``values`` returns the values of a scalar at its nodes."""
        colours = self.colours
        colours = replace(
            colours,
            values=None if colours.name is None else values(colours.name),
            others=tuple((n, values(colours.choices[n]["name"])) for n, _ in colours.others),
        )
        return ClientData(textures, colours, self.chosen, depth=self._depth, traces=self.traces)

    @property
    def _depth(self) -> int:
        if self.pyramid is None:
            return self.depth
        return self.pyramid.depth

    @cached_property
    def tile_header(self) -> Header:
        """Part of a tile's header that differs from the root's header."""
        return {"geometry": self._geometry(), "slices": self._slices()}

    def source(self, step: int) -> int:
        """Return the field's own number of a step that is sent."""
        if self.chosen:
            return self.chosen[step]
        return step

    def moment(self, time: float) -> tuple[int, ...]:
        """Return the steps that are needed to show a time, one or two."""
        before, after, _ = steps_around(self.times, time)
        shown: tuple[int, ...] = (before, after)
        if before == after:
            shown = (before,)
        if not self.traced or self.textures.store.streamlines:
            return shown
        around = (velocity.steps_around(self.textures, step) for step in shown)
        return tuple(sorted(set().union(*around)))

    @property
    def _values(self) -> dict[int, Floats]:
        """Drawn values at the times that are sent, (steps or 1, J, I), by scalar."""
        colours = self.colours
        values = dict(colours.others)
        if colours.values is not None:
            values[colours.number] = colours.values
        flat = {n for n, choice in enumerate(colours.choices) if choice.get("flat")}
        flat |= {colours.number} if colours.flat else set()
        steps = list(self.chosen) or slice(None)
        drawn = self.textures.geometry.drawn_values
        found = {}
        for number, nodal in values.items():
            found[number] = drawn(
                nodal[steps if len(nodal) > 1 else slice(None)], on_cells=number in flat
            )
        return found

    @cached_property
    def _mesh(self) -> Floats32:
        geometry = self.textures.geometry
        if isinstance(geometry, TriangleGeometry):
            return np.asarray(geometry.block_places, dtype="<f4")
        return np.asarray(block_places(np.nan_to_num(geometry.points)), dtype="<f4")

    def _geometry(self) -> Header:
        geometry = self.textures.geometry
        rows, columns = (
            {"before": int(b), "size": int(n)}
            for b, n in zip(geometry.padding, geometry.size, strict=True)
        )
        return {
            "triangles": isinstance(geometry, TriangleGeometry),
            "shape": [int(n) for n in geometry.shape],
            "rows": rows,
            "columns": columns,
            "levels": int(geometry.levels),
            "periodic": [bool(p) for p in geometry.periodic],
            "planar": geometry.planar,
            "extent": float(geometry.extent),
            "center": plain_list(geometry.center),
            "frame": plain_list(geometry.frame),
            "reach": 0.0 if self.bodies is None else self.bodies.reach(geometry),
        }

    def _speed(self) -> Header:
        field = self.field
        return {
            "label": field.speed_label,
            "unit": field.speed_unit,
            "typical": float(self.textures.typical_speed * field.speed_scale),
        }

    def _earth(self) -> Header | None:
        colours = self.colours
        has_land = colours.land is not None
        earth = earth_header(self.textures.geometry, has_land=has_land, coast=colours.coast)
        if earth is None:
            return None
        return {
            **earth,
            "coastlines": colours.coastlines,
            "graticule": colours.graticule,
            "land": None if colours.land is None else plain_list(colours.land),
        }

    def _slices(self) -> Header:
        textures = self.textures
        return {
            "count": int(textures.count),
            "channels": 4 if self.traced else self.packing.channels,
            "extra": self.packing.extra,
            "lags": plain_list(textures.lags),
            "sides": int(textures.sides),
            "unit": float(textures.unit),
            "lagUnit": float(textures.unit / textures.pace),
            "byTime": textures.store.parameter == "time",
            "pace": float(textures.typical_speed if self.steps > 1 else textures.pace),
            "cell": float(textures.cell),
            "critical": float(textures.critical_cell),
            "steps": int(self.steps),
            "times": plain_list(self.times),
            "timeUnit": textures.geometry.field.time_unit,
            "dates": dates_of(self.field, self.times),
            **({"trace": velocity.trace_header(textures, self._depth)} if self.traced else {}),
        }


def single(values: Floats) -> Floats32:
    """Return values in single precision, clipped to its greatest number."""
    return np.ascontiguousarray(np.clip(values, -SINGLE_MAX, SINGLE_MAX), "<f4")


def tile_parts(key: TileKey, tile: ClientData | None, *steps: int) -> Parts:
    """Return the arrays of a tile for some times, with its header as JSON; None is empty."""
    text = json.dumps(None if tile is None else tile.tile_header)
    parts: Parts = {"header": np.frombuffer(text.encode(), np.uint8)}
    if tile is not None:
        parts |= tile.surface()
        for name in ("cmap", "maps"):  # those of the root
            parts.pop(name, None)
        for step in steps:
            parts |= tile.step(step)
    prefix = f"tile/{key.level}/{key.row}/{key.column}"
    return {f"{prefix}/{name}": part for name, part in parts.items()}


def _pyramid(pyramid: Pyramid, finest: int) -> Header:
    levels = range(pyramid.depth + 1)
    return {
        "depth": pyramid.depth,
        "finest": finest,
        "blocks": [list(pyramid.places(level).shape[:2]) for level in levels],
        "shapes": [list(pyramid.shape(level)) for level in levels],
        "tileBlocks": pyramid.tile_blocks,
        "cellPixels": CELL_PIXELS,
        "pathCells": PATH_CELLS,
    }


def _image(image: ImageTextures) -> Header:
    deviations = None
    if isinstance(image, NoiseTextures):
        deviations = image.deviations
    return {
        "size": list(image.texels.shape[1::-1]),
        "deviations": deviations,
        "repeated": list(image.repeated),
        "stepSize": list(image.step.shape[::-1]),
        "repeat": [bool(r) for r in image.repeat],
        "alongI": plain_list(image.along_i),
        "alongJ": plain_list(image.along_j),
    }


@cache
def _maps() -> Bytes:
    return np.stack([colour_table(name)[:, :3] for name in CMAPS])


@cache
def _shaders(variant: tuple[str, ...], *, traces: bool) -> dict[str, str]:
    pairs = (f"{name}_{part}" for name in SHADER_PAIRS for part in SHADERS[:2])
    names = (*SHADERS, *pairs, *(TRACE_SHADERS if traces else ()))
    texts = ((name, shader_text(f"webgl2/{name}.glsl", variant)) for name in names)
    # Comments are a third of them, and the names of the client are lineVertex, ...
    return {re.sub("_.", lambda m: m[0][1].upper(), n): _COMMENTS.sub("", t) for n, t in texts}


def _table() -> list[Header]:
    names = (
        *("name", "label", "default", "affects", "text", "low", "high", "logarithmic"),
        "condition",
    )
    return [
        {
            **{name: getattr(row, name) for name in names},
            # The client has sliders by the logarithm, which need no narrow range.
            "control": "slider" if row.logarithmic else row.control,
            "whole": row.kind is int,
            "choices": list(row.choices),
            "needs": [list(need) for need in NEEDS.get(row.name, ())],
        }
        for row in TABLE.values()
    ]
