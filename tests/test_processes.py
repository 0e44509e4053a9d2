"""Pictures, pages and traces in forked and spawned processes, in threads and at the end."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from forked import forked, needs_forks
from waiting import PATIENCE_S

import flowtex
from flowtex.rendering.diagnostics import OpenGLMissingError

pytestmark = [pytest.mark.threads, pytest.mark.usefixtures("small_tiles", "quick_export")]

SIZE = (80, 60)


def _field() -> flowtex.FlowField:
    """Return a field that is drawn by tiles."""
    x, y = np.meshgrid(np.linspace(0, 6, 100), np.linspace(0, 6, 90))
    velocity = np.dstack([np.cos(y) + 0.2 * np.sin(3 * x), np.sin(x)])
    return flowtex.FlowField.from_arrays(np.dstack([x, y]), velocity)


FIELD = _field()


def picture() -> Any:
    return flowtex.render(FIELD, size=SIZE, zoom=3)


def page() -> str:
    with TemporaryDirectory() as folder:
        path = Path(folder, "page.html")
        flowtex.export(FIELD, path)
        return path.read_text(encoding="utf-8")


def displacement() -> Any:
    return flowtex.trace(FIELD, lags=[0.5, 1.0]).displacement


def screenshot(plotter: Any) -> Any:
    plotter.render()
    return np.array(plotter.screenshot(return_img=True), dtype=int)


def opened() -> Any:
    plotter: Any = pv.Plotter(off_screen=True, window_size=[*SIZE])
    plotter.flowtex.add(FIELD, arrows=True)
    plotter.view_xy()
    plotter.show(auto_close=False)
    return plotter


def new_plotter() -> Any:
    plotter = opened()
    result = screenshot(plotter)
    plotter.close()
    return result


@pytest.fixture(scope="module")
def plotter() -> Iterator[Any]:
    """A plotter that stays open."""
    plotter = opened()
    yield plotter
    plotter.close()


@needs_forks
def test_forked_process_draws_as_the_one_before(plotter: Any) -> None:
    kinds: list[Callable[[], Any]] = [picture, page, displacement, new_plotter]
    shown = screenshot(plotter)
    expected = [work() for work in kinds]
    for found, wanted in zip(forked(lambda: [work() for work in kinds]), expected, strict=True):
        np.testing.assert_array_equal(found, wanted)
    # VTK has made the context again, and rounds otherwise.
    np.testing.assert_allclose(screenshot(plotter), shown, atol=1)
    np.testing.assert_array_equal(picture(), expected[0])


@needs_forks
def test_process_forked_from_a_forked_one_draws_the_same(plotter: Any) -> None:
    def again() -> Any:
        screenshot(plotter)
        return forked(picture)

    np.testing.assert_array_equal(forked(again), picture())


@needs_forks
def test_open_plotter_is_drawn_in_forked_process(plotter: Any) -> None:
    def closer() -> Any:
        plotter.camera.zoom(2)
        return screenshot(plotter)

    shown = screenshot(plotter)
    assert np.ptp(shown) > 100
    zoomed = forked(closer)
    np.testing.assert_allclose(screenshot(plotter), shown, atol=1)
    np.testing.assert_allclose(zoomed, closer(), atol=1)
    plotter.camera.zoom(0.5)


@needs_forks
def test_forked_process_names_remedy_where_another_thread_drew() -> None:
    ready, end = threading.Event(), threading.Event()

    def draw() -> None:
        plotter = opened()
        ready.set()
        end.wait(PATIENCE_S)
        plotter.close()

    thread = threading.Thread(target=draw)
    thread.start()
    try:
        assert ready.wait(PATIENCE_S)
        said = forked(picture)
    finally:
        end.set()
        thread.join()
    assert said.startswith(OpenGLMissingError.__name__) and "spawn" in said


def test_spawned_process_draws_the_same() -> None:
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as processes:
        drawn = processes.submit(flowtex.render, FIELD, size=SIZE, zoom=3)
        moved = processes.submit(flowtex.trace, FIELD, lags=[0.5, 1.0])
        assert drawn.result(PATIENCE_S).shape == (60, 80, 3)
        found = moved.result(PATIENCE_S).displacement
    np.testing.assert_array_equal(found, displacement())


def test_threads_draw_at_once() -> None:
    expected = picture()
    with ThreadPoolExecutor(3) as threads:
        drawn = [threads.submit(picture) for _ in range(3)]
        moved = threads.submit(displacement)
        written = threads.submit(page)
        for each in drawn:
            np.testing.assert_array_equal(each.result(PATIENCE_S), expected)
    np.testing.assert_array_equal(moved.result(), displacement())
    assert written.result() == page()


ENDING = """
import atexit, sys, threading
sys.path.insert(0, sys.argv[1])
import flowtex.host.export
from test_processes import opened, page, picture

flowtex.host.export.PREVIEW = (24, 16)

def draw_on():
    while True:
        picture()

def last():
    print(picture().shape, len(page()) > 10_000, flush=True)

atexit.register(last)
plotter = opened()
plotter.camera.zoom(8)
next(iter(plotter.flowtex)).surface.load_in_background(lambda: None)
plotter.render()
threading.Thread(target=picture).start()
threading.Thread(target=draw_on, daemon=True).start()
"""


def test_pictures_are_drawn_while_the_interpreter_ends() -> None:
    command = [sys.executable, "-c", ENDING, str(Path(__file__).parent)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.stdout.splitlines() == ["(60, 80, 3) True"]
    assert (done.stderr, done.returncode) == ("", 0)
