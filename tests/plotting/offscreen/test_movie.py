from __future__ import annotations

import sys
import threading
import warnings
from collections.abc import Iterator
from itertools import islice, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measures import carried, write_movie
from numpy.typing import NDArray
from PIL import Image, ImageSequence

import flowtex
from flowtex import FlowField
from flowtex._util.progress import Stopped, stoppable
from flowtex.cli import main
from flowtex.plotting.offscreen.encoders import MovieError, check_movie
from flowtex.plotting.offscreen.movie import Movie, frame_times, frames
from flowtex.settings import Settings

Pixels = NDArray[np.uint8]
SIZE = (96, 64)
#: Little work for each picture, and a motion that shows.
QUICK: dict[str, Any] = {"samples": 5, "speed": 120.0}


def shear(*, steps: int = 1, turn: float = 0.0) -> FlowField:
    """A patch of 24 x 16 nodes in which all moves along x, in time turning by an angle."""
    x, y = np.meshgrid(np.linspace(0, 3, 24), np.linspace(0, 2, 16))
    points = np.stack([x, y], axis=-1)
    angle = np.linspace(0, turn, steps)[:, None, None] + 0 * y
    velocity = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * (1 + 0.1 * y)[..., None]
    if steps == 1:
        return FlowField.from_arrays(points, velocity[0], scalars={"height": x})
    return FlowField.from_arrays(points, velocity, times=np.arange(steps, dtype=float))


def smooth_pictures(count: int) -> Iterator[Pixels]:
    """Colours over the whole range, moving, without the detail that 4:2:0 leaves out."""
    y, x = np.mgrid[0:64, 0:96]
    for n in range(count):
        late = 2 * np.pi * n / count
        red = 127.5 + 127.5 * np.sin(x / 20 + late)
        green = 127.5 + 127.5 * np.cos(y / 15 - late)
        blue = 255 - 0.5 * (red + green)
        yield np.stack([red, green, blue], axis=-1).astype(np.uint8)


def mp4(path: Path) -> tuple[Any, NDArray[np.int64]]:
    """Return what the stream says and its pictures, (N, H, W, 3)."""
    av = pytest.importorskip("av")
    from av.video.reformatter import Interpolation

    with av.open(str(path)) as file:
        stream = file.streams.video[0]
        codec = stream.codec_context
        said = {
            "codec": codec.name,
            "pixels": codec.pix_fmt,
            "rate": float(stream.average_rate),
            "colours": (int(codec.colorspace), int(codec.color_primaries), int(codec.color_range)),
        }
        exact = Interpolation.BILINEAR | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT
        pictures = [
            frame.reformat(
                format="rgb24",
                src_colorspace="ITU709",
                src_color_range="MPEG",
                dst_color_range="JPEG",
                interpolation=exact,
            ).to_ndarray()
            for frame in file.decode(video=0)
        ]
    return said, np.array(pictures, dtype=int)


def pillow(path: Path) -> tuple[list[int], NDArray[np.int64]]:
    """Return the milliseconds of each picture, and the pictures."""
    durations, pictures = [], []
    with Image.open(path) as file:
        for frame in ImageSequence.Iterator(file):
            pictures.append(np.array(frame.convert("RGB"), dtype=int))
            durations.append(frame.info["duration"])
    return durations, np.array(pictures)


def children() -> set[str]:
    """Numbers of the processes that this one has started and that still run."""
    lists = Path("/proc/self/task").glob("*/children")
    return {number for found in lists for number in found.read_text().split()}


def difference(one: Any, other: Any) -> float:
    return float(np.abs(np.asarray(one, int) - np.asarray(other, int)).mean())


@pytest.fixture(scope="module")
def loop() -> list[Pixels]:
    """A loop of 12 pictures, and the first one of the next round."""
    made = list(frames(shear(), size=SIZE, seconds=1.0, fps=12, motion="uniform", **QUICK))
    again = flowtex.render(shear(), size=SIZE, motion="uniform", period=1.0, clock=1.0, **QUICK)
    return [*made, again]


def test_a_loop_closes_bit_for_bit(loop: list[Pixels], opengl: object) -> None:
    assert len(loop) == 13
    assert (loop[12] == loop[0]).all()
    steps = [difference(a, b) for a, b in pairwise(loop)]
    # No two neighbours are the same, and the last step is like the others.
    assert min(steps) > 2 and max(steps) < 2 * min(steps)
    assert difference(loop[6], loop[0]) > 1.2 * min(steps)


def test_the_picture_moves_with_the_flow(opengl: object) -> None:
    # 60 pixels a second are 6 from one picture to the next.
    drawn = frames(shear(), size=(160, 120), fps=10, motion="uniform", speed=60.0, scalars=False)
    before, after = islice(drawn, 2)
    still = np.zeros((120, 160))
    with_it = carried(before, after, still + 6, still, 20)
    assert with_it > 0.9
    for other in (0, 12, -6):
        assert carried(before, after, still + other, still, 20) < with_it - 0.03


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Path, Movie]]:
    folder = tmp_path_factory.mktemp("movies")
    made = {}
    for kind in ("mp4", "gif", "webp"):
        path = folder / f"flow.{kind}"
        movie = flowtex.movie(
            shear(), path, size=SIZE, seconds=1.0, fps=10, quality=90, motion="uniform", **QUICK
        )
        made[kind] = (path, movie)
    assert sorted(p.name for p in folder.iterdir()) == ["flow.gif", "flow.mp4", "flow.webp"]
    return made


def test_an_mp4_plays_in_browsers(written: dict[str, tuple[Path, Movie]], opengl: object) -> None:
    path, movie = written["mp4"]
    said, pictures = mp4(path)
    assert said == {"codec": "h264", "pixels": "yuv420p", "rate": 10, "colours": (1, 1, 1)}
    assert pictures.shape == (10, 64, 96, 3)
    assert (movie.frames, movie.seconds, movie.closed) == (10, 1.0, True)
    assert movie.nbytes == path.stat().st_size
    # The index stands before the pictures, so that a browser need not fetch all of it first.
    content = path.read_bytes()
    assert 0 < content.index(b"moov") < content.index(b"mdat")


@pytest.mark.parametrize("kind", ["gif", "webp"])
def test_a_gif_and_a_webp_hold_the_loop(
    written: dict[str, tuple[Path, Movie]], kind: str, opengl: object
) -> None:
    durations, pictures = pillow(written[kind][0])
    assert pictures.shape == (10, 64, 96, 3) and durations == [100] * 10
    drawn = list(frames(shear(), size=SIZE, seconds=1.0, fps=10, motion="uniform", **QUICK))
    assert difference(pictures, drawn) < (5 if kind == "gif" else 12)
    with Image.open(written[kind][0]) as file:
        assert file.info["loop"] == 0


def test_an_mp4_keeps_the_colours(tmp_path: Path) -> None:
    pytest.importorskip("av")
    path = tmp_path / "colours.mp4"
    drawn = np.array(list(smooth_pictures(8)), dtype=int)
    write_movie(path, smooth_pictures(8), 8.0, 95)
    _, shown = mp4(path)
    off = shown - drawn
    # The range taken for the other one would shift black and white by 16, the matrix green by 20.
    assert np.abs(off.mean(axis=(0, 1, 2))).max() < 0.7
    assert np.abs(off).mean() < 2.5 and np.percentile(np.abs(off), 99) < 10


def test_a_gif_has_one_palette_and_stands_still_where_nothing_moves(tmp_path: Path) -> None:
    pictures = list(smooth_pictures(6))
    for picture in pictures:
        picture[:, :48] = pictures[0][:, :48]
    path = tmp_path / "half.gif"
    write_movie(path, pictures, 30.0)
    durations, shown = pillow(path)
    assert (shown[:, :, :48] == shown[0, :, :48]).all()
    assert difference(shown, pictures) < 6
    # Hundredths of a second, which add up to a fifth of one.
    assert set(durations) <= {30, 40} and sum(durations) == 200
    with Image.open(path) as file:
        palettes = {bytes(f.palette.palette) for f in _palettes(file)}
    assert len(palettes) == 1


def _palettes(file: Any) -> Iterator[Any]:
    for number in range(file.n_frames):
        file.seek(number)
        if file.mode == "P":
            yield file


def test_a_field_that_varies_is_shown_from_first_to_last(opengl: object) -> None:
    field = shear(steps=4, turn=1.5)
    moments = frame_times(field, Settings(), fps=2, seconds=3)
    assert moments.times == pytest.approx(np.linspace(0, 3, 6)) and not moments.closed
    look: dict[str, Any] = {"size": SIZE, "samples": 5}
    drawn = list(frames(field, fps=2, seconds=3, **look))
    assert len(drawn) == 6
    for n, time in ((0, 0.0), (5, 3.0)):
        assert (drawn[n] == flowtex.render(field, motion="speed", time=time, **look)).all()


def test_a_period_leaves_its_last_time_out() -> None:
    field = shear(steps=5, turn=2 * np.pi)
    moments = frame_times(field, Settings(), fps=2, seconds=4)
    assert moments.closed and moments.times == pytest.approx(np.arange(8) * 0.5)
    assert frame_times(field, Settings(), fps=10).seconds == 5.0


def changed(drawn: list[Pixels]) -> NDArray[np.float64]:
    """Share of pixels that differ from each picture to the next, and from the last to the first."""
    following = np.roll(drawn, -1, axis=0).astype(int)
    return np.asarray((np.abs(following - drawn).max(axis=-1) > 8).mean(axis=(1, 2)))


@pytest.mark.parametrize(("seconds", "fps"), [(0.4, 20.0), (0.8, 5.0), (4.0, 8.0)])
def test_short_movies_move_without_a_seam(seconds: float, fps: float, opengl: object) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn = list(frames(shear(), size=SIZE, seconds=seconds, fps=fps, samples=25))
    shares = changed(drawn)
    assert len(drawn) == round(seconds * fps)
    assert shares.min() > 0.1 and shares[-1] == pytest.approx(shares[:-1].mean(), rel=0.25)


def test_a_field_without_a_sign_does_not_stream() -> None:
    x, y = np.meshgrid(np.linspace(0, 1, 8), np.linspace(0, 1, 8))
    field = FlowField.from_arrays(
        np.stack([x, y], -1), np.stack([1 + 0 * x, 0.2 * y], -1), sign_free=True
    )
    with pytest.raises(MovieError, match="is sign-free, so it cannot stream"):
        frame_times(field, Settings(motion="speed"), fps=10)


#: The second number is while Pillow writes what it has kept.
@pytest.mark.parametrize(("kind", "asked"), [("mp4", 4), ("gif", 4), ("gif", 12), ("webp", 12)])
def test_cancelling_leaves_no_file_and_no_process(kind: str, asked: int, tmp_path: Path) -> None:
    pytest.importorskip("av")
    path = tmp_path / f"flow.{kind}"
    path.write_bytes(b"what was there before")
    answers = iter([*[False] * asked, *[True] * 9])
    threads, processes = {*threading.enumerate()}, children()
    with pytest.raises(Stopped), stoppable(lambda: next(answers)):
        write_movie(path, smooth_pictures(10), 10.0)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b"what was there before"
    assert children() <= processes and threads.issuperset(threading.enumerate())


def test_an_error_leaves_nothing(tmp_path: Path) -> None:
    def broken() -> Iterator[Pixels]:
        yield from smooth_pictures(3)
        yield np.zeros((10, 10, 3), np.uint8)

    with pytest.raises(MovieError, match="a picture is 10 x 10; expected 96 x 64"):
        write_movie(tmp_path / "a.mp4", broken(), 10.0)
    assert not list(tmp_path.iterdir())


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(ModuleNotFoundError, match=r"(?s)needs PyAV.*\[movie\]"):
        check_movie(tmp_path / "a.mp4", SIZE, 30.0)
    check_movie(tmp_path / "a.gif", SIZE, 30.0)


def test_supersampling_shows_the_same_more_smoothly(opengl: object) -> None:
    plain, fine, aliased = (
        flowtex.render(shear(), size=(160, 120), samples=15, **options).astype(float).mean(axis=-1)
        for options in ({}, {"supersampling": 4}, {"supersampling": 4, "grain": 0.375})
    )
    assert fine.shape == plain.shape
    inside = (slice(20, 100), slice(20, 140))
    # Grains of the same size at the same places.
    assert np.corrcoef(plain[inside].ravel(), fine[inside].ravel())[0, 1] > 0.95
    assert np.corrcoef(plain[inside].ravel(), aliased[inside].ravel())[0, 1] < 0.5


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flow") / "gyre.vts"
    flowtex.examples.double_gyre(2.5).save(path)
    return path


def test_the_command_writes_a_movie(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], opengl: object
) -> None:
    out = tmp_path / "flow.mp4"
    words = ["movie", file, "-o", out, "--seconds", 0.5, "--fps", 8, "--size", "96x64"]
    assert main([str(word) for word in [*words, "--samples", 5, "--beside", "lod=false"]]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "a seamless loop" in said and "96 × 64, 4 frames in 0.5 s" in said
    assert mp4(out)[1].shape == (4, 64, 96, 3)
