"""Movies in files, written picture by picture: MP4 by PyAV, GIF and animated WebP by Pillow.

The pictures of an MP4 are encoded one by one: H.264 as every browser plays it, with matrix,
primaries, curve and range of the colours in the file, so that players show the original colours.
Pillow takes all pictures at once, so they wait in a temporary file on the disk.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import checked_path, checked_size, checked_target, is_number
from flowtex._util.array_types import Bytes
from flowtex._util.progress import Stopped
from flowtex._util.whole_file import WholeFile
from flowtex.errors import FieldError, install_extra

if TYPE_CHECKING:
    from PIL import Image

Size = tuple[int, int]

#: Suffixes of the files that can be written.
FORMATS = (".mp4", ".gif", ".webp")
#: Quality where none is requested.
DEFAULT_QUALITY = 80
#: Longest side of a picture, in pixels.
LONGEST_SIDE_PIXELS = 16_384
#: Pixels of a picture at the highest level of H.264.
MP4_MAX_PIXELS = 139_264 * 256
#: Matrix and primaries of BT.709, a number of ITU-T H.273 as those below.
BT709 = 1
#: Curve of sRGB.
SRGB_CURVE = 13
#: Range from 16 to 235.
LIMITED = 1
#: Pixels of all the pictures of a movie by Pillow, at most.
PILLOW_MAX_PIXELS = 1_000_000_000
#: Browsers slow down a GIF that shows a picture for less than two hundredths of a second.
GIF_MAX_FPS = 50.0
#: Number of frames from which the palette is computed.
PALETTE_PICTURES = 8
#: About how many pixels of each of them along a side.
PALETTE_SIDE = 256


class MovieError(FieldError):
    """A movie cannot be written; the text gives the reason and the remedy.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.movie(flowtex.examples.airfoil_field(), "flow.avi")
    Traceback (most recent call last):
    flowtex.plotting.offscreen.encoders.MovieError: ...
    """


def default_fps(path: str | Path) -> float:
    """Return the default frames per second; a GIF counts in hundredths of a second."""
    return 20.0 if checked_path("path", path).suffix.lower() == ".gif" else 30.0


def check_movie(path: str | Path, size: Size, fps: float, quality: int = DEFAULT_QUALITY) -> None:
    """Check that a movie can be written, before anything is drawn.

    The parameters are those of :class:`MovieWriter`. Raises a MovieError with the remedy, and for
    an MP4 without PyAV a ModuleNotFoundError with the command that installs it.
    """
    path = checked_target(path)
    suffix = path.suffix.lower()
    width, height = checked_size(size, low=0)
    shown = f"size is {width} x {height}"
    if suffix not in FORMATS:
        why = f"{path.suffix!r} is not a movie format" if suffix else "the file name has no suffix"
        msg = f"{path}: {why}; expected {', '.join(FORMATS)}"
    elif not (is_number(quality) and 1 <= quality <= 100):
        msg = f"quality is {quality!r}; expected a number from 1 to 100, such as {DEFAULT_QUALITY}"
    elif not (is_number(fps) and fps > 0):
        msg = f"fps is {fps!r}; expected a positive number of frames per second, such as 30"
    elif suffix == ".gif" and fps > GIF_MAX_FPS:
        msg = (
            f"fps is {fps:g}; a GIF can show at most {GIF_MAX_FPS:g} frames per second; write an "
            "MP4 for more"
        )
    elif suffix == ".mp4" and (width % 2 or height % 2):  # 4:2:0 asks for even sides
        msg = f"{shown}; an MP4 needs even sides, such as {width // 2 * 2} x {height // 2 * 2}"
    elif suffix == ".mp4" and width * height > MP4_MAX_PIXELS:
        msg = f"{shown}; an MP4 can have at most {MP4_MAX_PIXELS:,} pixels: choose a smaller size"
    elif not all(1 <= side <= LONGEST_SIDE_PIXELS for side in size):
        msg = f"{shown}; expected 1 to {LONGEST_SIDE_PIXELS} pixels along each side"
    else:
        if suffix == ".mp4":
            _pyav()
        return
    raise MovieError(msg)


def _pyav() -> Any:
    """Return PyAV; raise an error if it is missing or has no H.264."""
    try:
        import av
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            "an MP4 needs PyAV, which is not installed; a GIF does not. To install it:\n  "
            f"{install_extra('movie')}"
        ) from error
    if "libx264" not in av.codecs_available:
        raise MovieError(
            "the installed PyAV was built without libx264; install the wheel of PyAV, or write a "
            "GIF"
        )
    return av


class MovieWriter:
    """Writes pictures to a file, which exists completely or not at all.

    The file is ``.mp4``, with even sides in pixels, ``.gif``, with at most 50 frames in a second,
    or ``.webp``. The higher the quality, 1 to 100, the truer and the larger; a GIF has this many
    hundredths of 256 colours. Raises what :func:`check_movie` does, and an OSError when the folder
    does not exist, or no right to write there.
    """

    def __init__(self, path: str | Path, size: Size, fps: float, quality: int) -> None:
        check_movie(path, size, fps, quality)
        self._size = size
        self._file = WholeFile(Path(path))
        kind = _MP4 if self._file.part.suffix.lower() == ".mp4" else _Pillow
        try:
            self._encoder = kind(self._file, size, fps, quality)
        except BaseException:
            self._file.drop()
            raise

    def add(self, picture: Bytes) -> None:
        """Add the next picture, (H, W, 3) uint8.

        Raises a MovieError when its size is not that of the movie.
        """
        height, width = picture.shape[:2]
        if (width, height) != self._size:
            expected = f"{self._size[0]} x {self._size[1]}"
            raise MovieError(
                f"a picture is {width} x {height}; expected {expected}, the size of the movie"
            )
        self._encoder.add(np.ascontiguousarray(picture))

    def finish(self, cancelled: Callable[[], bool]) -> None:
        """Complete the file, and put it in its place.

        Raises :class:`Stopped` when ``cancelled()`` became true before.
        """
        self._encoder.finish(cancelled)
        self._encoder.close()
        if cancelled():
            raise Stopped
        self._file.keep()

    def abandon(self) -> None:
        """Remove an incomplete file; does nothing after :meth:`finish`."""
        try:
            with suppress(OSError):  # a full disk: it has failed before, and the file goes
                self._encoder.close()
        finally:
            self._file.drop()


class _MP4:
    """Writes H.264 with PyAV."""

    def __init__(self, new: WholeFile, size: Size, fps: float, quality: int) -> None:
        av = _pyav()
        from av.video.reformatter import Interpolation

        self._frame_of = av.VideoFrame.from_ndarray
        self._colours = {
            "format": "yuv420p",
            "src_color_range": "JPEG",
            "dst_color_range": "MPEG",
            "dst_colorspace": "ITU709",
            "interpolation": Interpolation.AREA | Interpolation.ACCURATE_RND,
        }
        self._movie = av.open(str(new.part), "w", format="mp4", options={"movflags": "+faststart"})
        self.close = self._movie.close
        # Half as many steps of the quantizer again for each tenth: 80 is a rate factor of 18.
        factor = {"crf": f"{50 - 0.4 * quality:g}", "preset": "medium"}
        rate = Fraction(fps).limit_denominator(1001)
        self._stream = self._movie.add_stream("libx264", rate=rate, options=factor)
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"
        codec = self._stream.codec_context
        codec.colorspace, codec.color_primaries = BT709, BT709
        codec.color_trc, codec.color_range = SRGB_CURVE, LIMITED

    def add(self, picture: Bytes) -> None:
        frame = self._frame_of(picture, format="rgb24").reformat(**self._colours)
        self._movie.mux(self._stream.encode(frame))

    def finish(self, _cancelled: Callable[[], bool]) -> None:
        self._movie.mux(self._stream.encode(None))


class _Pillow:
    """Keeps pictures on the disk until Pillow writes them, those of a GIF by one palette."""

    def __init__(self, new: WholeFile, size: Size, fps: float, quality: int) -> None:
        self._file, self._size, self._fps, self._quality = new.file, size, fps, quality
        self._format = new.part.suffix[1:].upper()
        self._count = 0
        self._spool = tempfile.TemporaryFile()  # noqa: SIM115 closed by close()
        self.close = self._spool.close

    def add(self, picture: Bytes) -> None:
        self._count += 1
        if self._count * picture.shape[0] * picture.shape[1] > PILLOW_MAX_PIXELS:
            most = f"{PILLOW_MAX_PIXELS:,} pixels in all"
            raise MovieError(
                f"a {self._format} can have at most {most}; write an MP4, or a smaller movie"
            )
        self._spool.write(picture.data)

    def finish(self, cancelled: Callable[[], bool]) -> None:
        palette = self._palette() if self._format == "GIF" else None
        # A GIF counts in hundredths of a second, a WebP in thousandths.
        unit = 1 if palette is None else 10
        ends = [round(1000 * n / self._fps / unit) * unit for n in range(self._count + 1)]
        durations = [after - before for before, after in pairwise(ends)]
        options = {"quality": self._quality, "method": 2, "optimize": False, "disposal": 1}
        pictures = self._pictures(palette, cancelled)
        next(pictures).save(
            self._file,
            self._format,
            save_all=True,
            append_images=pictures,
            duration=durations if len(durations) > 1 else durations[0],
            loop=0,
            **options,
        )

    def _pictures(
        self, palette: Image.Image | None, cancelled: Callable[[], bool]
    ) -> Iterator[Image.Image]:
        from PIL import Image

        plain = Image.Dither.NONE
        for number in range(self._count):
            if cancelled():
                raise Stopped
            picture = self._picture(number)
            yield picture if palette is None else picture.quantize(palette=palette, dither=plain)

    def _picture(self, number: int) -> Image.Image:
        from PIL import Image

        width, height = self._size
        self._spool.seek(number * width * height * 3)
        return Image.frombytes("RGB", self._size, self._spool.read(width * height * 3))

    def _palette(self) -> Image.Image:
        """Return an image with one palette for pictures from the whole movie."""
        from PIL import Image

        chosen = np.linspace(0, self._count - 1, min(self._count, PALETTE_PICTURES)).round()
        step = max(min(self._size) // PALETTE_SIDE, 1)
        samples = [np.asarray(self._picture(int(n)))[::step, ::step] for n in chosen]
        colours = max(round(256 * self._quality / 100), 2)
        return Image.fromarray(np.vstack(samples)).quantize(
            colours, Image.Quantize.MEDIANCUT, kmeans=2, dither=Image.Dither.NONE
        )


def write_movie(
    path: str | Path,
    frames: Iterable[Bytes],
    fps: float,
    quality: int = DEFAULT_QUALITY,
    *,
    cancelled: Callable[[], bool] = lambda: False,
) -> None:
    """Write pictures (H, W, 3) uint8, all of one size, as a movie.

    Each picture is taken when the one before is written; ``cancelled`` is asked before each, and
    once it is true nothing is left behind. The other parameters are those of :class:`MovieWriter`.
    Raises what that does, a MovieError when there are no pictures or one differs in size, and
    :class:`Stopped` when it was cancelled.
    """
    writer: MovieWriter | None = None
    try:
        for picture in frames:
            if cancelled():
                raise Stopped
            writer = writer or MovieWriter(path, picture.shape[1::-1], fps, quality)
            writer.add(picture)
        if writer is None:
            raise MovieError(f"{path}: the movie has no pictures; expected one or more")
        writer.finish(cancelled)
    finally:
        if writer is not None:
            writer.abandon()
