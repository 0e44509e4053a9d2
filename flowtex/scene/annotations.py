"""Legends, time, scale bar and title, written on finished pictures.

Each has its own plate in a corner. Plates without room are left out, the title first and the legend
last. Text grows with the picture, so that small and large ones look alike; in small pictures, where
it cannot shrink further, plates stand above and below the flow and cover none of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image, ImageDraw, ImageFont

from flowtex._util.array_types import Bytes, Floats
from flowtex._util.colours import ColourScale, distinct_texts, is_light, rgb
from flowtex.field.dates import time_text
from flowtex.rendering.camera import Camera
from flowtex.rendering.map_overlay import ground_colours
from flowtex.rendering.webgl.marks import (
    KIND_MARKS,
    LINE_COLORS,
    MIDDLE_COLOR,
    NULLCLINE_COLORS,
    RIM_COLOR,
    KindMark,
)
from flowtex.scene.options import coast_of
from flowtex.scene.scene import Scene

Marks = list[tuple[str, Any]]  #: Characters on top of each other, with their colours.

TEXT_SHARE = 1 / 30  #: Height of the text as a share of the picture's height.
WIDEST_ASPECT = 1.6  #: Greatest ratio of width to height at which the text follows the height.
SMALL_TEXT_PX = (9, 11)  #: Limits of the height of the text in a small picture.
SMALL_TEXT_SHARE = 1 / 13  #: Height of the text as a share of a small picture's height.
MOST_STRIPS = 0.55  #: Greatest share of a small picture's height for plates.
CLOSER = 0.5  #: Factor of gaps and padding in a small picture.
MOST_COVER = 0.125  #: Share of the picture that a plate covers at most.
SCALE_BAR_WIDTH = 0.2  #: Greatest share of the picture's width that a scale bar has.
PADDING = 0.4  #: Padding around the text, in heights of the text.
GAP = 0.6  #: Gap between plates, in heights of the text.
RAMP_WIDTH = 9.0  #: Least width of a colour bar, in heights of the text.
RAMP_HEIGHT = 0.65  #: Height of a colour bar, in heights of the text.
LINE = 0.1  #: Width of thin lines, in heights of the text.
OPACITY = 0.8  #: How opaque a plate is.
TICK_PX = 4  #: Length of ticks in pixels.
BEYOND = 0.004  #: Share of the range by which a number may lie beyond an end: less than a pixel.
LEGEND_WIDTH = 0.6  #: Widest legend with all of its values, as a share of the width of the picture.
#: Names of plates; the structure stands beside the scale bar.
SCALE_BAR = "scale bar"
STRUCTURE = "structure"
METRES_PER_KM = 1000
SMOOTH = 4  #: Supersampling factor of the tips of a legend.


@dataclass(frozen=True)
class Plate:
    """One annotation: its name, its place in pixels from the top left, and its pixels (RGBA)."""

    name: str
    left: int
    top: int
    image: Image.Image

    @property
    def box(self) -> tuple[int, int, int, int]:
        """Left, top, right and bottom, in pixels."""
        return self.left, self.top, self.left + self.image.width, self.top + self.image.height


@dataclass(frozen=True)
class Layout:
    """Plates on a picture, the most important first, and the names of those without room.

    A small picture has no flow in its uppermost and lowermost rows, ``above`` and ``below``.
    """

    plates: list[Plate]
    left_out: list[str]
    above: int = 0
    below: int = 0


def annotate(picture: Bytes, scene: Scene, camera: Camera, **options: Any) -> Layout:
    """Write on a picture, (H, W, 3) uint8, in place; :func:`layout` has the parameters."""
    height, width = picture.shape[:2]
    result = layout(scene, (width, height), camera, **options)
    canvas = Image.fromarray(np.ascontiguousarray(picture))
    for plate in result.plates:
        canvas.paste(plate.image, plate.box, plate.image)
    picture[:] = np.asarray(canvas)
    return result


def annotate_views(
    picture: Bytes,
    scenes: Sequence[Scene],
    camera: Camera,
    changes: Mapping[str, Any],
    **options: Any,
) -> list[Layout]:
    """Write on a picture of scenes side by side, in place; labels say how they differ."""
    views = np.array_split(picture, len(scenes), axis=1)
    found = []
    for view, scene in zip(views, scenes, strict=True):
        found.append(
            annotate(view, scene, camera, label=difference_text(scene, changes), **options)
        )
    return found


def room_of(layouts: Sequence[Layout]) -> tuple[int, int]:
    """Return the rows above and below the flow that views side by side need."""
    above = max(layout.above for layout in layouts)
    below = max(layout.below for layout in layouts)
    return above, below


def layout(
    scene: Scene,
    size: tuple[int, int],
    camera: Camera,
    *,
    background: Any = "white",
    label: str = "",
    legend: bool = True,
    scale_bar: bool = True,
    beside: bool = False,
    flow_height: int | None = None,
) -> Layout:
    """Return what is written on a picture.

    ``size`` is the width and height of the picture in pixels. The flow has ``flow_height`` rows of
    it, by default all. ``label`` is added to the name of the field in the title. With ``beside``
    nothing covers the flow, also in a large picture. Plates are light on a light background. There
    is no legend for an image or a plain surface.
    """
    writer = _Writer(size, background, flow_height, small=beside)
    title = _printable(", ".join(filter(None, (scene.field.name, label))))
    placement = _Placement(size, writer.gap, small=writer.small)
    if legend:
        placement.add("legend", writer.legends(scene), right=True, low=True)
    placement.add("time", writer.times(scene), right=True)
    if scale_bar:
        placement.add(SCALE_BAR, writer.scale_bars(scene, camera), low=True)
    placement.add("title", writer.texts(title))
    if legend:
        placement.add(STRUCTURE, writer.structure(scene), low=True)
    return placement.layout


class _Placement:
    """The plates placed so far on a picture of a width and height in pixels."""

    def __init__(self, size: tuple[int, int], gap: int, *, small: bool) -> None:
        self._size = size
        self._gap = gap
        self._small = small
        self._plates: list[Plate] = []
        self._left_out: list[str] = []
        self._strips = (0, 0)  # above and below the flow

    @property
    def layout(self) -> Layout:
        """All plates, and the strips of a small picture."""
        if self._small:
            return Layout(self._plates, self._left_out, *self._strips)
        return Layout(self._plates, self._left_out)

    def add(
        self, name: str, images: Iterator[Image.Image], *, right: bool = False, low: bool = False
    ) -> None:
        """Place the first image that fits into a corner, the upper left one by default."""
        has_images = False
        for image in images:
            has_images = True
            left, top = self._corner(image, right=right, low=low)
            if name == STRUCTURE:
                left, top = self._beside_scale_bar(image, left, top)
            plate = Plate(name, left, top, image)
            strips = self._strips_with(image, low=low)
            if self._fits(plate, strips):
                self._plates.append(plate)
                self._strips = strips
                return
        if has_images:
            self._left_out.append(name)

    def _corner(self, image: Image.Image, *, right: bool, low: bool) -> tuple[int, int]:
        """Return the place of an image in a corner, left and top."""
        width, height = self._size
        left = self._gap
        top = self._gap
        if right:
            left = width - self._gap - image.width
        if low:
            top = height - self._gap - image.height
        return left, top

    def _beside_scale_bar(self, image: Image.Image, left: int, top: int) -> tuple[int, int]:
        """Return the place of an image above the scale bar, or beside it in a small picture."""
        for plate in self._plates:
            if plate.name != SCALE_BAR:
                continue
            if self._small:
                return plate.box[2] + self._gap, top
            return left, plate.top - self._gap - image.height
        return left, top

    def _strips_with(self, image: Image.Image, *, low: bool) -> tuple[int, int]:
        """Return the heights of the strips above and below the flow with another image."""
        above, below = self._strips
        needed = image.height + 2 * self._gap
        if low:
            return above, max(below, needed)
        return max(above, needed), below

    def _fits(self, plate: Plate, strips: tuple[int, int]) -> bool:
        """Return whether a plate has room, covers little, and is apart from the others."""
        width, height = self._size
        gap = self._gap
        image = plate.image
        if not gap <= plate.left <= width - gap - image.width:
            return False
        if not gap <= plate.top <= height - gap - image.height:
            return False
        if self._small:
            is_small_enough = sum(strips) / height <= MOST_STRIPS
        else:
            is_small_enough = image.width * image.height / width / height <= MOST_COVER
        return is_small_enough and all(_apart(plate, other, gap) for other in self._plates)


def write_ticks(
    picture: Image.Image, box: tuple[int, int, int, int], ends: ArrayLike, background: Any
) -> None:
    """Write ticks at the left and below a box, (left, top, right, bottom), of a picture, in place.

    ``ends`` are the coordinates (x, y) of its lower left and its upper right corner.
    """
    writer = _Writer(picture.size, background, small=True)
    draw = ImageDraw.Draw(picture)
    left, top, right, bottom = box
    draw.rectangle((left, top, right - 1, bottom - 1), outline="grey")
    for axis, (low, high) in enumerate(np.transpose(ends)):
        for share, text in _value_marks(ColourScale(), low, high):
            if axis:
                x = left
                y = round(bottom - share * (bottom - top))
                end = (x - TICK_PX, y)
                place = (end[0] - 2, y)
                anchor = "rm"
            else:
                x = round(left + share * (right - left))
                y = bottom
                end = (x, y + TICK_PX)
                place = end
                anchor = "ma"
            draw.line((x, y, *end), "grey")
            draw.text(place, text, writer.ink, writer.font, anchor)


class _Writer:
    """Makes the plates of pictures of one size and background, the largest form of each first."""

    def __init__(
        self,
        size: tuple[int, int],
        background: Any,
        flow_height: int | None = None,
        *,
        small: bool = False,
    ) -> None:
        self._size = size
        self._flow_height = flow_height or size[1]
        height = min(size[1], size[0] / WIDEST_ASPECT)
        (least, most) = SMALL_TEXT_PX
        self._em = round(height * TEXT_SHARE)
        self.small = small or self._em < most
        if self.small:
            self._em = min(max(round(height * SMALL_TEXT_SHARE), least), most)
        self.font = _font(self._em)
        self._line = sum(self.font.getmetrics())
        self._thin = self._px(LINE)
        if self.small:
            closer = CLOSER
        else:
            closer = 1.0
        self.gap = self._px(closer * GAP)
        self._pad = self._px(closer * PADDING)
        self._background = rgb(background)
        light = is_light(self._background)
        if light:
            self._plate = "white"
            self.ink = "black"
        else:
            self._plate = "black"
            self.ink = "white"

    def texts(self, text: str, room: tuple[str, ...] = ()) -> Iterator[Image.Image]:
        """Yield a plate with one line, with room for the widest of ``room``."""
        if text:
            width = max(map(self._width, (text, *room)))
            image, draw = self._blank(width, self._line)
            self._write(draw, 0, 0, text)
            yield image

    def times(self, scene: Scene) -> Iterator[Image.Image]:
        """Yield the time, if it is known."""
        field = scene.field
        if field.steady and field.start is None and not field.times[0]:
            return
        text = _printable(time_text(field, scene.time))
        first = _printable(time_text(field, float(field.times[0])))
        last = _printable(time_text(field, float(field.times[-1])))
        yield from self.texts(text, (first, last))

    def scale_bars(self, scene: Scene, camera: Camera) -> Iterator[Image.Image]:
        """Yield a scale bar of a round length, if the scale is the same in the whole picture."""
        frame = scene.whole.surface.frame
        if frame is None or not camera.parallel:
            return
        if abs(float(np.cross(*frame) @ camera.axes[2])) < 1 - 1e-6:  # seen aslant
            return
        scale = 1.0
        projection = scene.field.projection
        if projection is not None:
            # Lengths of the map for a length of the Earth; none outside the map.
            found = float(projection.scales(*projection.lonlat(np.asarray(camera.focal_point))))
            if 0 < found < math.inf:
                scale = found
        unit_px = scale * self._flow_height / (2 * camera.height)
        length = round_length(SCALE_BAR_WIDTH * self._size[0] / unit_px)
        unit = _printable(scene.field.length_unit)
        across = round(length * unit_px)
        if not across:
            return
        text = length_text(length, unit)
        tick = self._px(PADDING)
        width = max(self._width(text), across)
        image, draw = self._blank(width, self._line + tick)
        self._write(draw, (width - self._width(text)) // 2, 0, text)
        left = self._pad + (width - across) // 2
        low = self._pad + self._line + tick - 1
        right = left + across - 1
        draw.rectangle((left, low - self._thin + 1, right, low), self.ink)
        for x in (left, right - self._thin + 1):
            draw.rectangle((x, low - tick + 1, x + self._thin - 1, low), self.ink)
        yield image

    def legends(self, scene: Scene) -> Iterator[Image.Image]:
        """Yield a legend with all round values, with every second one, and with the outer ones."""
        name = scene.scalar_name
        settings = scene.settings
        appearance = scene.appearance
        if name is None or settings.show_level or not appearance.visible:
            return
        table = scene.legend_colours[:, :3]
        title = _printable(scene.title_of(name))
        marks = _value_marks(scene.colour_scale, *scene.legend_limits)
        for n, every in enumerate((1, 2, max(len(marks) - 1, 1))):
            image = self._legend(title, table, marks[::every], scene.beyond)
            if n or image.width <= LEGEND_WIDTH * self._size[0]:
                yield image

    def structure(self, scene: Scene) -> Iterator[Image.Image]:
        """Yield legends of critical points, lines and places without data, in columns."""
        structure = scene.structure
        settings = scene.settings
        step = scene.step
        count = settings.critical_points
        saddles = settings.separatrices
        points: Sequence[Any] = ()
        if count:
            points = structure.points(step)[:count]
        found = {point.kind for point in points}
        rows: dict[str, Marks] = {}
        for kind, dot in KIND_MARKS.items():
            if kind in found:
                rows[kind] = _dot_marks(dot)
        if saddles:
            paths = structure.paths(step, saddles)
            for name, color in LINE_COLORS.items():
                if paths.get(name):
                    rows[name] = [("━", color)]
        if settings.nullclines:
            for name, color in NULLCLINE_COLORS.items():
                rows[name] = [("━", color)]
        rows |= self._ground(scene)
        if not rows:
            return
        if self.small:
            forms = (2, 3, len(rows))
        else:
            forms = (len(rows), 2, 1)
        for lines in dict.fromkeys(np.minimum(forms, len(rows)).tolist()):
            yield self._marks_legend(rows, lines)

    def _marks_legend(self, rows: Mapping[str, Marks], lines: int) -> Image.Image:
        """Return a legend of marks by their names, in columns of some lines."""
        width = max(map(self._width, rows)) + self._line
        wide = math.ceil(len(rows) / lines) * (width + self._line) - self._line
        image, draw = self._blank(wide, lines * self._line)
        for n, (name, marks) in enumerate(rows.items()):
            x = (width + self._line) * (n // lines)
            y = self._line * (n % lines)
            self._write(draw, x + self._line, y, name)
            left = self._pad + x + 0.4 * self._line
            top = self._pad + y + self._line / 2
            for rim, (mark, color) in zip((RIM_COLOR, MIDDLE_COLOR), marks, strict=False):
                stroke: Any = {"stroke_width": self._thin, "stroke_fill": rim}
                draw.text((left, top), mark, color, self.font, "mm", **stroke)
                top += self._thin / 2  # the middle of a large dot is lower
        return image

    def _ground(self, scene: Scene) -> dict[str, Marks]:
        """Return land and places without data, where they are drawn."""
        appearance = scene.appearance
        if not appearance.visible:
            return {}
        coast = coast_of(appearance)
        colours = ground_colours(scene.field, appearance.land, self._background, coast)
        rows: dict[str, Marks] = {}
        for name, colour in colours.items():
            red, green, blue = np.rint(255 * colour).astype(int).tolist()
            rows[name] = [("■", (red, green, blue))]
        return rows

    def _legend(
        self, title: str, table: Bytes, marks: list[tuple[float, str]], beyond: tuple[bool, bool]
    ) -> Image.Image:
        """Return the legend; the colours end in a tip where values lie beyond them."""
        while len(title) > 1 and self._width(title) > self._size[0] - 2 * (self.gap + self._pad):
            title = f"{title[:-2].strip()}…"
        shares, numbers = zip(*marks, strict=True)
        widest = max(map(self._width, numbers)) + self._px(GAP)
        apart = min(np.diff(shares), default=1.0)
        high = self._px(RAMP_HEIGHT)
        least = self._px(RAMP_WIDTH)
        # Numbers stand in the middle below their colours, and may reach beyond the first and last.
        aside = self._width(numbers[0]) / 2 - shares[0] * least
        aside = max(aside, 0) + max(self._width(numbers[-1]) / 2 - (1 - shares[-1]) * least, 0)
        width = math.ceil(max(max(self._width(title), least) - aside, widest / apart))
        widths = np.array(list(map(self._width, numbers)))
        places = np.multiply(shares, width) - widths / 2
        start = math.ceil(max(-places.min(), 0))
        end = math.ceil(max((places + widths).max(), width, self._width(title) - start))
        image, draw = self._blank(start + end, 2 * self._line + high)
        self._write(draw, 0, 0, title)
        stops = np.linspace(0, len(table) - 1, width).round().astype(int)
        ramp = np.broadcast_to(table[stops], (high, width, 3))
        shape = Image.new("L", (SMOOTH * width, SMOOTH * high))
        tip = high * SMOOTH // 2
        left = tip * beyond[0]
        right = tip * beyond[1]
        (x, y) = shape.size
        middle = SMOOTH * high / 2
        corners = [(0, middle), (left, 0), (x - right, 0), (x, middle), (x - right, y), (left, y)]
        ImageDraw.Draw(shape).polygon(corners, fill=255)
        image.paste(
            Image.fromarray(np.ascontiguousarray(ramp)),
            (self._pad + start, self._pad + self._line),
            shape.resize((width, high), Image.Resampling.BOX),
        )
        for place, text in zip(places.tolist(), numbers, strict=True):
            self._write(draw, round(start + place), self._line + high, text)
        return image

    def _px(self, heights: float) -> int:
        return max(round(heights * self._em), 1)

    def _blank(self, width: int, height: int) -> tuple[Image.Image, ImageDraw.ImageDraw]:
        """Return a plate with room for a width and height, and the object that draws on it."""
        size = (width + 2 * self._pad, height + 2 * self._pad)
        image = Image.new("RGBA", size, self._plate)
        if self.small:
            image.putalpha(0)
        else:
            image.putalpha(round(255 * OPACITY))
        return image, ImageDraw.Draw(image)

    def _width(self, text: str) -> int:
        left, _, right, _ = self.font.getbbox(text)
        return math.ceil(right - left)

    def _write(self, draw: ImageDraw.ImageDraw, x: int, y: int, text: str) -> None:
        left = self.font.getbbox(text)[0]  # a letter may begin beside its position
        draw.text((self._pad + x - left, self._pad + y), text, self.ink, self.font)


@lru_cache(8)
def _font(height: int) -> ImageFont.FreeTypeFont:
    """Return matplotlib's own font, which has the letters of units, in this many pixels."""
    from matplotlib import get_data_path

    path = Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")
    # Every Pillow has the basic layout.
    return ImageFont.truetype(path, height, layout_engine=ImageFont.Layout.BASIC)


def _dot_marks(mark: KindMark) -> Marks:
    """Return the dot of a kind of critical points, with a middle where the flow turns around it."""
    marks: Marks = [("●", mark.color)]
    if mark.turns:
        marks.append(("·", MIDDLE_COLOR))
    return marks


def _printable(text: str) -> str:
    """Return a text in one line, without unprintable characters."""
    letters = []
    for letter in text:
        if not letter.isprintable():
            letter = " "
        letters.append(letter)
    return "".join(letters).strip()


def _apart(plate: Plate, other: Plate, gap: int) -> bool:
    (left, top, right, bottom) = plate.box
    (to_left, above, to_right, below) = other.box
    return max(to_left - right, left - to_right, above - bottom, top - below) >= gap


def round_values(low: float, high: float, *, log_scale: bool, steps: Sequence[float]) -> Floats:
    """Return three or more round values in a range, or its ends."""
    from matplotlib.ticker import LogLocator, MaxNLocator

    if log_scale:
        slack = 0.0
    else:
        slack = BEYOND * (high - low)
    values = np.empty(0)
    for most in (3, 4, 5):
        even_locator = MaxNLocator(most, steps=steps)
        locator: Any = even_locator
        if log_scale:
            locator = LogLocator(numticks=4)
        values = np.asarray(locator.tick_values(low, high))
        values = values[(values >= low - slack) & (values <= high + slack)]
        if len(values) >= 3:
            break
    if len(values) > 1:
        return values[:: 1 + len(values) // 6]
    return np.unique([low, high])


def _value_marks(scale: ColourScale, low: float, high: float) -> list[tuple[float, str]]:
    """Return three or more round values in a range, or its ends, and their shares of it."""
    if scale.marks:
        return [(place, text) for _, place, text in scale.marks]
    values = round_values(low, high, log_scale=scale.log_scale, steps=(1, 2, 2.5, 5, 10))
    scaled: Any = np.asarray
    if scale.log_scale:
        scaled = np.log10
    ends = scaled([low, high])
    shares = (scaled(values) - ends[0]) / max(ends[1] - ends[0], float(np.finfo(float).tiny))
    return list(zip(map(float, shares), distinct_texts(values), strict=True))


def difference_text(scene: Scene, changes: Mapping[str, Any]) -> str:
    """Return the settings by which one of two views differs from the other."""
    settings = dict(scene.settings) | {"lines": scene.lines}
    differences = []
    for name in changes:
        if name in settings:
            differences.append(f"{name} = {settings[name]}")
    return ", ".join(differences)


def length_text(length: float, unit: str) -> str:
    """Return a length with its unit, without the plural of a whole word, such as metres, for 1.

    Thousands of metres are kilometres.
    """
    if unit == "m" and length >= METRES_PER_KM:
        length = length / METRES_PER_KM
        unit = "km"
    plural = len(unit) > 4 and unit.endswith("s") and not unit.endswith(("ss", "ches"))
    if plural and length == 1:
        unit = unit.removesuffix("s")
    return f"{length:.12g} {unit}".strip()


def round_length(greatest: float) -> float:
    """Return the greatest of 1, 2, 5, 10, 20, ... that is not above a length."""
    if not (greatest > 0 and math.isfinite(greatest)):
        return 0.0
    power = 10.0 ** math.floor(math.log10(greatest))
    steps = np.array([1.0, 2.0, 5.0]) * power
    return float(steps[steps <= greatest * (1 + 1e-12)][-1])
