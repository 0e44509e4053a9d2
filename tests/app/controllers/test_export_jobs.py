from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image, ImageSequence

pytest.importorskip("trame_rca")

from small_pages import difference, panned, small
from waiting import wait_until

from flowtex.app.controllers.sharing import Job
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError
from flowtex.plotting.offscreen.encoders import MovieError

pytestmark = pytest.mark.usefixtures("opengl")


@pytest.fixture(scope="module")
def scene() -> Iterator[Viewport]:
    made = Viewport(small(curved=True), zoom=2.0, samples=9, scalars="height", cmap="magma")
    made.resize(240, 160)
    panned(made, 0.1, -0.2)
    made.set_background("light")
    yield made
    made.close()


@pytest.fixture
def plain() -> Iterator[Viewport]:
    made = Viewport(small(), samples=5, speed=120.0)
    made.resize(120, 80)
    made.home()
    yield made
    made.close()


@pytest.fixture
def series() -> Iterator[Viewport]:
    made = Viewport(small(steps=4), samples=5)
    made.resize(120, 80)
    made.home()
    yield made
    made.close()


def run(job: Job) -> Path:
    return asyncio.run(job.run(lambda share: None))


def pixels(path: Path) -> Any:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


def test_a_picture_is_what_is_on_view(scene: Viewport, tmp_path: Path) -> None:
    job = Job(scene, tmp_path / "view.png", (240, 160))
    shares: list[float] = []
    path = asyncio.run(job.run(shares.append))
    assert job.done and shares == sorted(shares) and shares[-1] == 0.9
    shown = scene.draw(240, 160)
    # Curved surfaces show a row of pixels of another level where 2 x 2 blocks fall otherwise.
    assert difference(pixels(path), shown) < 0.5
    assert difference(np.roll(pixels(path), 3, axis=0), shown) > 3


def test_a_larger_picture_is_finer_or_denser(scene: Viewport, tmp_path: Path) -> None:
    view = (scene.size, scene.camera, dict(scene.handle.settings))
    shown = scene.draw(240, 160)
    dense = run(Job(scene, tmp_path / "dense.png", (480, 320), density=2.0))
    fine = run(Job(scene, tmp_path / "fine.png", (480, 320)))
    smooth = run(Job(scene, tmp_path / "smooth.png", (240, 160), supersampling=2))
    averaged = [np.asarray(Image.open(path).reduce(2)) for path in (dense, fine)]
    assert difference(averaged[0], shown) < 5 < difference(averaged[1], shown)
    assert difference(pixels(smooth), averaged[0]) < 1
    # Nothing of what is on view has changed.
    assert view == (scene.size, scene.camera, dict(scene.handle.settings))
    assert difference(scene.draw(240, 160), shown) == 0


@pytest.mark.parametrize("kind", ["gif", "mp4"])
def test_a_movie_is_a_loop_of_what_is_on_view(plain: Viewport, tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"flow.{kind}"
    job = Job(plain, path, (121, 81), seconds=1.0, fps=10, quality=95)
    run(job)
    pictures = shown(path)
    wide, high = (120, 80) if kind == "mp4" else (121, 81)
    assert pictures.shape == (10, high, wide, 3)
    assert job.frames is not None and job.frames.closed
    steps = [difference(pictures[n - 1], pictures[n]) for n in range(10)]
    # The step from the last to the first picture, which is steps[0], is like the others.
    assert min(steps) > 1 and max(steps) < 2 * min(steps)
    # The settings on view stay, and the motion is the movie's own.
    assert plain.handle.settings.motion == "off" and plain.clock == 0.0
    plain.handle.settings.update(motion="speed", period=1.0)
    plain.resize(wide, high)
    plain.clock = 0.3
    assert difference(pictures[3], plain.draw(wide, high)) < 6


def shown(path: Path) -> Any:
    """Pictures of a movie, (N, H, W, 3)."""
    if path.suffix == ".gif":
        found = []
        with Image.open(path) as file:
            for frame in ImageSequence.Iterator(file):
                found.append(np.array(frame.convert("RGB")))
        return np.array(found, dtype=int)
    av = pytest.importorskip("av")
    with av.open(str(path)) as file:
        return np.array([f.to_ndarray(format="rgb24") for f in file.decode(video=0)], dtype=int)


def test_a_movie_of_a_series_shows_all_times(series: Viewport, tmp_path: Path) -> None:
    series.set_time(1.0)
    job = Job(series, tmp_path / "all.gif", (120, 80), seconds=1.0, fps=4)
    run(job)
    pictures = shown(job.path)
    assert len(pictures) == 4
    assert job.frames is not None and job.frames.times == pytest.approx((0, 1, 2, 3))
    assert series.handle.time == 1.0
    series.set_still(still=False)
    for n in (0, 3):
        series.set_time(float(n))
        off = [difference(picture, series.draw(120, 80)) for picture in pictures]
        assert int(np.argmin(off)) == n and off[n] < 5


def children() -> set[str]:
    """Numbers of the processes that this one has started and that still run."""
    lists = Path("/proc/self/task").glob("*/children")
    return {number for found in lists for number in found.read_text().split()}


@pytest.mark.parametrize("kind", ["mp4", "gif", "png"])
def test_a_cancelled_job_leaves_nothing(plain: Viewport, tmp_path: Path, kind: str) -> None:
    job = Job(plain, tmp_path / f"a.{kind}", (200, 150), seconds=1.0)
    threads, processes = threading.active_count(), children()

    async def stop() -> None:
        def report(share: float) -> None:
            if share > 0.05:
                task.cancel()

        task = asyncio.create_task(job.run(report))
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(stop())
    assert job.done and not list(tmp_path.iterdir())
    wait_until(lambda: threading.active_count() <= threads)
    assert children() <= processes


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("a.png", {"size": (0, 10)}, "is 0 x 10; expected 1 to 30,000 pixels along"),
        ("a.png", {"size": (20_000, 20_000)}, "at most 100,000,000 in all"),
        ("a.png", {"density": 0.0}, "density is 0.0; expected 0.125 to 8"),
        ("a.gif", {"size": (5000, 5000)}, "the size is 5000 x 5000; expected"),
        ("a.gif", {"seconds": 1e9}, "seconds is 1000000000.0; expected a number from 0.1"),
        ("a.avi", {}, "'.avi' is not a movie format"),
    ],
)
def test_what_cannot_be_made_is_told(
    plain: Viewport, tmp_path: Path, name: str, options: dict[str, Any], said: str
) -> None:
    with pytest.raises((FieldError, MovieError)) as error:
        Job(plain, tmp_path / name, **{"size": (20, 20), **options})
    assert said in str(error.value)


@pytest.mark.parametrize(("steps", "split"), [(1, {"kernel": "box"}), (3, None)])
def test_annotations_are_written_on_what_is_saved(
    tmp_path: Path, steps: int, split: dict[str, Any] | None
) -> None:
    view = Viewport(small(steps=steps), samples=5)
    view.resize(120, 80)
    view.home()
    view.compare(split)
    shots = []
    for written in (False, True):
        job = Job(view, tmp_path / "a.png", (1200, 400), annotations=written)
        shots.append(pixels(run(job)))
    movie = Job(view, tmp_path / "a.gif", (120, 80), seconds=0.2, fps=10, annotations=True)
    with Image.open(run(movie)) as file:
        assert file.size == (120, 80)
    view.close()
    differs = (np.abs(shots[0] - shots[1]) > 20).any(axis=-1)
    halves = [differs] if split is None else np.array_split(differs, 2, axis=1)
    for half in halves:
        wide = half.shape[1]
        assert half[300:, wide // 2 :].any()  # the legend
        assert half[300:, : wide // 2].any()  # the scale bar
        assert half[:100, wide // 2 :].any() == (steps > 1)  # the time
        assert half[:100, : wide // 2].any() == (split is not None)  # what differs
        assert not half[150:250].any()
