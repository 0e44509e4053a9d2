"""Movies in files, written picture by picture: MP4 by PyAV, GIF and animated WebP by Pillow.

The pictures of an MP4 are encoded one by one: H.264 as every browser plays it, with matrix,
primaries, curve and range of the colours in the file, so that players show the original colours.
Pillow takes all pictures at once, so they wait in a temporary file on the disk.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Generator, Iterator
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import checked_path, checked_size, checked_target, is_number
from flowtex._util.array_types import Bytes
from flowtex._util.progress import check
from flowtex._util.whole_file import WholeFile
from flowtex.errors import FieldError, install_extra

if TYPE_CHECKING:
    from PIL import Image

Size = tuple[int, int]

FORMATS = (".mp4", ".gif", ".webp")  #: Suffixes of the files that can be written.
DEFAULT_QUALITY = 80  #: Quality where none is requested.
BT709 = 1  #: Matrix and primaries of BT.709, a number of ITU-T H.273 as those below.
SRGB_CURVE = 13  #: Curve of sRGB.
LIMITED = 1  #: Range from 16 to 235.
PILLOW_MAX_PIXELS = 1_000_000_000  #: Pixels of all the pictures of a movie by Pillow, at most.
#: Browsers slow down a GIF that shows a picture for less than two hundredths of a second.
GIF_MAX_FPS = 50.0
PALETTE_PICTURES = 8  #: Number of frames from which the palette is computed.
PALETTE_SIDE = 256  #: About how many pixels of each of them along a side.


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
    if checked_path("path", path).suffix.lower() == ".gif":
        return 20.0
    return 30.0


def check_movie(path: str | Path, size: Size, fps: float, quality: int = DEFAULT_QUALITY) -> None:
    """Check that a movie can be written, before anything is drawn.

    Drawing checks the length of the sides and the frames per second.

    Raises
    ------
    MovieError
        When the suffix is not one of a movie, the size or the quality does not fit the format, or
        the file cannot be written.
    ModuleNotFoundError
        When PyAV is missing for an MP4; the error names the command that installs it.
    """
    path = checked_target(path)
    suffix = path.suffix.lower()
    width, height = checked_size(size, low=0)
    if suffix not in FORMATS:
        if suffix:
            why = f"{path.suffix!r} is not a movie format"
        else:
            why = "the file name has no suffix"
        msg = f"{path}: {why}; expected {', '.join(FORMATS)}"
    elif not (is_number(quality) and 1 <= quality <= 100):
        msg = f"quality is {quality!r}; expected a number from 1 to 100, such as {DEFAULT_QUALITY}"
    elif suffix == ".gif" and is_number(fps) and fps > GIF_MAX_FPS:
        msg = (
            f"fps is {fps:g}; a GIF can show at most {GIF_MAX_FPS:g} frames per second; write an "
            "MP4 for more"
        )
    elif suffix == ".mp4" and (width % 2 or height % 2):  # 4:2:0 asks for even sides
        even = f"{width // 2 * 2} x {height // 2 * 2}"
        msg = f"size is {width} x {height}; an MP4 needs even sides, such as {even}"
    else:
        if suffix == ".mp4":
            _pyav()
        return
    raise MovieError(msg)


def _pyav() -> Any:
    try:
        import av
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            "an MP4 needs PyAV, which is not installed; a GIF does not. To install it:\n  "
            f"{install_extra('movie')}"
        ) from error
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
        if self._file.part.suffix.lower() == ".mp4":
            encode = _encode_mp4
        else:
            encode = _encode_by_pillow
        self._encoder = encode(self._file, size, fps, quality)
        try:
            next(self._encoder)
        except BaseException:
            self._file.drop()
            raise

    def add(self, picture: Bytes) -> None:
        """Add the next picture, (H, W, 3) uint8.

        Raises
        ------
        MovieError
            When the picture has another size than the movie.
        """
        height, width = picture.shape[:2]
        if (width, height) != self._size:
            expected = f"{self._size[0]} x {self._size[1]}"
            raise MovieError(
                f"a picture is {width} x {height}; expected {expected}, the size of the movie"
            )
        self._encoder.send(np.ascontiguousarray(picture))

    def finish(self) -> None:
        """Complete the file, and put it in its place, unless the work is cancelled before."""
        with suppress(StopIteration):
            self._encoder.send(None)
        check()
        self._file.keep()

    def close(self) -> None:
        """Remove an incomplete file; does nothing after :meth:`finish`."""
        try:
            with suppress(OSError):  # a full disk: it has failed before, and the file goes
                self._encoder.close()
        finally:
            self._file.drop()


Encoder = Generator[None, Bytes | None, None]  #: Takes pictures, and at the end ``None``.


def _encode_mp4(new: WholeFile, size: Size, fps: float, quality: int) -> Encoder:
    """Write H.264 with PyAV."""
    av = _pyav()
    from av.video.reformatter import Interpolation

    colours = {
        "format": "yuv420p",
        "src_color_range": "JPEG",
        "dst_color_range": "MPEG",
        "dst_colorspace": "ITU709",
        "interpolation": Interpolation.AREA | Interpolation.ACCURATE_RND,
    }
    # Half as many steps of the quantizer again for each tenth: 80 is a rate factor of 18.
    factor = {"crf": f"{50 - 0.4 * quality:g}", "preset": "medium"}
    rate = Fraction(fps).limit_denominator(1001)
    with av.open(str(new.part), "w", format="mp4", options={"movflags": "+faststart"}) as movie:
        stream = movie.add_stream("libx264", rate=rate, options=factor)
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        codec = stream.codec_context
        codec.colorspace = BT709
        codec.color_primaries = BT709
        codec.color_trc = SRGB_CURVE
        codec.color_range = LIMITED
        while (picture := (yield)) is not None:
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24").reformat(**colours)
            movie.mux(stream.encode(frame))
        movie.mux(stream.encode(None))


def _encode_by_pillow(new: WholeFile, size: Size, fps: float, quality: int) -> Encoder:
    """Keep pictures on the disk until Pillow writes them; those of a GIF share one palette."""
    kind = new.part.suffix[1:].upper()
    shape = (size[1], size[0], 3)
    most = 3 * PILLOW_MAX_PIXELS // max(math.prod(shape), 1)
    with tempfile.TemporaryFile() as spool:
        count = 0
        while (picture := (yield)) is not None:
            count += 1
            if count > most:
                raise MovieError(
                    f"a {kind} can have at most {PILLOW_MAX_PIXELS:,} pixels in all; write an MP4, "
                    "or a smaller movie"
                )
            spool.write(picture.data)
        spool.flush()
        kept = np.memmap(spool, np.uint8, "r", shape=(count, *shape))
        # A GIF counts in hundredths of a second, a WebP in thousandths.
        if kind == "GIF":
            images = _with_palette(kept, _common_palette(kept, quality))
            duration = _durations(count, fps, unit_ms=10)
        else:
            images = _images(kept)
            duration = _durations(count, fps, unit_ms=1)
        options = {"quality": quality, "method": 2, "optimize": False, "disposal": 1}
        next(images).save(
            new.file,
            kind,
            save_all=True,
            append_images=images,
            duration=duration,
            loop=0,
            **options,
        )


def _images(pictures: Bytes) -> Iterator[Image.Image]:
    """Yield pictures (N, H, W, 3) as images of Pillow."""
    from PIL import Image

    for picture in pictures:
        check()
        yield Image.fromarray(picture)


def _with_palette(pictures: Bytes, palette: Image.Image) -> Iterator[Image.Image]:
    """Yield pictures (N, H, W, 3) in the colours of a palette."""
    from PIL import Image

    for image in _images(pictures):
        yield image.quantize(palette=palette, dither=Image.Dither.NONE)


def _common_palette(pictures: Bytes, quality: int) -> Image.Image:
    """Return an image with a palette for pictures (N, H, W, 3), found in a few of all of them."""
    from PIL import Image

    count, height, width, _ = pictures.shape
    chosen = np.linspace(0, count - 1, min(count, PALETTE_PICTURES)).round().astype(int)
    step = max(min(width, height) // PALETTE_SIDE, 1)
    samples = np.vstack([pictures[n, ::step, ::step] for n in chosen])
    colours = max(round(256 * quality / 100), 2)
    return Image.fromarray(samples).quantize(
        colours, Image.Quantize.MEDIANCUT, kmeans=2, dither=Image.Dither.NONE
    )


def _durations(count: int, fps: float, *, unit_ms: int) -> int | list[int]:
    """Return the duration of each picture in milliseconds, or of the only one."""
    ends = np.rint(1000 * np.arange(count + 1) / fps / unit_ms).astype(int) * unit_ms
    durations: list[int] = np.diff(ends).tolist()
    if count == 1:
        return durations[0]
    return durations
