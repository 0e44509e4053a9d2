"""What every test gets, whether it asks or not, and the fixtures that it may ask for.

A test fails when VTK logged a line while it ran, and when NumPy divided by zero, overflowed or
made a NaN. Python's warnings are errors through ``filterwarnings`` in pyproject.toml.
"""

from __future__ import annotations

import asyncio
import ctypes
import gc
import inspect
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import barred
import numpy as np
import pytest

from flowtex.rendering import diagnostics

if TYPE_CHECKING:
    import pyvista as pv
    from lab import LabServer
    from playwright.sync_api import Browser, Page
    from webgl_page import ClientPage

pytest_plugins = ["case_counts", "small_pages", "small_tiles"]

# Before anything opens a window, and for every process that a test starts.
diagnostics.prefer_headless()
# Workers and the many processes that tests start would each compile the package and the tests
# again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
# Its threads wait for each other by turning round: beside other processes, for several times as
# long as they compute. Workers begin with it, before they load NumPy.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Mesa optimises shaders for longer than it draws the pictures of tests with them.
os.environ.setdefault("GALLIVM_PERF", "nopt")
# With it jsonschema, which Jupyter loads, builds parsers of addresses for four seconds.
sys.modules["rfc3987_syntax"] = None  # type: ignore[assignment]
if barred.WANTED:
    barred.bar()


#: A parameter, or a mark, by which a test or a fixture asks for a browser.
ASKS_FOR_BROWSER = re.compile(
    r"\b(?:browser|client|client_page|page): (?:Browser|ClientPage|Page)\b|\bmark\.browser\b"
)


@cache
def _asks_for_browser(path: Path) -> bool:
    """Tell whether the text of a file asks for a browser."""
    return ASKS_FOR_BROWSER.search(path.read_text(encoding="utf-8")) is not None


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files that load what is barred, and for ``-m browser`` those without a browser."""
    if collection_path.suffix != ".py":
        return None
    if barred.WANTED and barred.needs_them(collection_path):
        return True
    only_browser = config.getoption("markexpr") == "browser"
    if only_browser and not _asks_for_browser(collection_path):
        return True
    return None


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup() -> Iterator[None]:
    """Skip a test whose fixtures need what is barred."""
    yield from _skipped_where_barred()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Iterator[None]:
    """Skip a test that needs what is barred."""
    yield from _skipped_where_barred()


def _skipped_where_barred() -> Iterator[None]:
    try:
        yield
    except Exception as error:
        if barred.WANTED and (asker := barred.asker_of(error)):
            pytest.skip(f"barred: {asker} asked for it ({error})")
        raise


#: Files that take as long as those with slow tests do, though each of their tests is quick.
LONG = {"test_docs.py", "test_agreement.py", "test_forms.py", "test_sources.py"}


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests with a browser, and let them come last; the longest files come first.

    Playwright's event loop runs from the first one on, and meanwhile no test could run an event
    loop of its own. Processes share the files in this order: a long one at the end would keep one
    of them busy and the others idle.
    """
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    slow |= {item.path for item in items if item.path.name in LONG}
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker("browser")
        if item.get_closest_marker("browser") and not _asks_for_browser(item.path):
            msg = f"{item.nodeid}: -m browser misses it; give its fixture a type, page: Page"
            raise pytest.UsageError(msg)
        if barred.WANTED and item.get_closest_marker("threads"):
            item.add_marker(pytest.mark.skip("barred: threads"))
    items.sort(key=lambda item: ("browser" in item.keywords, item.path not in slow))


def pytest_collection_finish() -> None:
    """Leave what collecting has made out of each later collection of garbage."""
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run a coroutine that is a test, in an event loop of its own."""
    if not inspect.iscoroutinefunction(pyfuncitem.obj):
        return None
    names = inspect.signature(pyfuncitem.obj).parameters
    asyncio.run(pyfuncitem.obj(**{name: pyfuncitem.funcargs[name] for name in names}))
    return True


CHROMIUMS = ("chromium", "chromium-browser", "google-chrome")


class VtkLog:
    """What VTK logs, from warnings upwards, as a file that it writes without a buffer.

    VTK's own log sees every way in which it complains: macros, its logger, and errors that an
    observer or another output window has swallowed. Watching the output window alone misses the
    last two.
    """

    def __init__(self, path: Path) -> None:
        from vtkmodules.vtkCommonCore import vtkLogger

        self._path = path
        # Opening the file is itself told on stderr, as information.
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)
        vtkLogger.LogToFile(str(path), vtkLogger.TRUNCATE, vtkLogger.VERBOSITY_WARNING)
        self._read = 0
        self.take()

    def take(self) -> str:
        """Return what was logged since the last call."""
        with self._path.open(encoding="utf-8", errors="replace") as file:
            file.seek(self._read)
            text = file.read()
            self._read = file.tell()
        return text


@pytest.fixture(scope="session")
def vtk_log(tmp_path_factory: pytest.TempPathFactory) -> VtkLog | None:
    """VTK's log, if there is VTK; ``take()`` returns, and so forgives, what came since."""
    return None if barred.WANTED else VtkLog(tmp_path_factory.mktemp("vtk") / "log.txt")


@pytest.fixture(autouse=True)
def _vtk_is_silent(request: pytest.FixtureRequest, vtk_log: VtkLog | None) -> Iterator[None]:
    """Fail the test on any line that VTK logs; ``vtk_log_allowed(reason)`` excuses it."""
    if vtk_log is not None:
        vtk_log.take()
    yield
    logged = vtk_log.take() if vtk_log is not None else ""
    if logged and request.node.get_closest_marker("vtk_log_allowed") is None:
        pytest.fail(f"VTK logged:\n{logged}", pytrace=False)


@pytest.fixture(autouse=True)
def _numpy_raises() -> Iterator[None]:
    """Make NumPy raise where it would go on with inf or NaN.

    The state holds for the test's thread, so libraries called from it are judged as well; a
    test whose library computes 0/0 by design wraps that call in ``np.errstate(...)``. Underflow
    to zero is right where a kernel's tail is wanted, and stays silent.
    """
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        yield


@pytest.fixture
def rng() -> np.random.Generator:
    """Return a source of random numbers that is the same in every run."""
    return np.random.default_rng(20061205)


def _keep_driver() -> None:
    """Keep a context of OpenGL: with the last one the driver ends, and the next begins it anew.

    A process that forks frees it, as its threads would be missing in the other one.
    """
    from vtkmodules.vtkRenderingCore import vtkRenderWindow
    from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

    window = vtkRenderWindow()
    if not isinstance(window, vtkOpenGLRenderWindow) or "EGL" not in type(window).__name__:
        return
    window.SetOffScreenRendering(True)
    window.SetSize(8, 8)
    window.Initialize()
    os.register_at_fork(before=window.Finalize)


@pytest.fixture(scope="session")
def opengl() -> diagnostics.OpenGLReport:
    """Return what VTK draws with; skip where it cannot, as it would end the test process."""
    found = diagnostics.opengl_report()
    told = f"VTK cannot draw here: {found.failure}; {found.remedy}"
    if "timed out" in found.failure:
        pytest.fail(told)  # the machine may merely be busy
    if not found.usable:
        pytest.skip(told)
    _keep_driver()
    return found


@pytest.fixture
def plotter(opengl: diagnostics.OpenGLReport) -> Iterator[pv.Plotter]:
    """Off-screen plotter, closed afterwards; an error that OpenGL noted fails the test."""
    import pyvista as pv

    shown: Any = pv.Plotter(off_screen=True, window_size=[320, 240])
    shown.disable_anti_aliasing()
    yield shown
    errors = _opengl_errors(shown)
    shown.close()
    assert errors == [], f"OpenGL noted errors: {errors}"


def _opengl_errors(plotter: Any) -> list[str]:
    """Error numbers that OpenGL holds for a plotter's window; VTK checks in debug builds only."""
    window = plotter.render_window
    if window is None or "EGL" not in type(window).__name__:
        return []
    egl = ctypes.CDLL("libEGL.so.1")
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    window.MakeCurrent()
    ask = ctypes.CFUNCTYPE(ctypes.c_uint)(egl.eglGetProcAddress(b"glGetError"))
    return [hex(error) for error in iter(ask, 0)]


@pytest.fixture(scope="session")
def chromium() -> Path:
    """Return an installed Chromium, ``FLOWTEX_CHROMIUM`` first; skip where none starts."""
    named = os.environ.get("FLOWTEX_CHROMIUM")
    for name in (named,) if named else CHROMIUMS:
        found = shutil.which(name)
        # Ubuntu has a script by this name that only says which snap to install.
        if (
            found
            and subprocess.run([found, "--version"], capture_output=True, check=False).returncode
            == 0
        ):
            return Path(found)
    pytest.skip("no Chromium: apt-get install chromium, or point FLOWTEX_CHROMIUM at one")


#: WebGL of Mesa's, several times as fast as the one that Chromium brings; it draws the views alone,
#: as the page around them costs less where it is put together without OpenGL.
MESA = ("--use-angle=gl-egl", "--ignore-gpu-blocklist", "--disable-gpu-compositing")
#: Pages of a context lie in one process, which has compiled what each of them runs: see pages.py.
#: Coverage is counted by processes, so there each page has its own.
TOGETHER = (
    ()
    if "FLOWTEX_CLIENT_COVERAGE" in os.environ
    else ("--renderer-process-limit=1", "--disable-site-isolation-trials")
)
DRAWS = "!!document.createElement('canvas').getContext('webgl2')"


@pytest.fixture(scope="session")
def browser(chromium: Path) -> Iterator[Browser]:
    """Yield the one headless browser of the session."""
    from playwright.sync_api import sync_playwright

    asked = [sys.executable, "-m", "playwright", "--version"]
    if subprocess.run(asked, capture_output=True, check=False).returncode != 0:
        pytest.skip("Playwright does not start: apt-get install libatomic1")
    with sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=chromium, args=[*MESA, *TOGETHER])
        page = started.new_page()
        draws = page.evaluate(DRAWS)
        page.close()
        if not draws:
            started.close()
            started = driver.chromium.launch(executable_path=chromium, args=[*TOGETHER])
        yield started
        started.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """Yield its own page context, so that no test sees another's state."""
    from pages import opened_page

    with opened_page(browser, 640, 400) as opened:
        yield opened


@pytest.fixture(scope="session")
def jupyter(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LabServer]:
    """Yield the one JupyterLab of the session; skip where it is not installed."""
    if find_spec("jupyterlab") is None:  # to import it takes seconds
        pytest.skip("jupyterlab is not installed")
    from lab import lab

    with lab(tmp_path_factory.mktemp("lab")) as started:
        yield started


@pytest.fixture
def quick_export(monkeypatch: pytest.MonkeyPatch) -> None:
    """Export pages with a small preview, which the processor draws, and larger files."""
    monkeypatch.setattr("flowtex.host.export.PREVIEW", (24, 16))
    monkeypatch.setattr("flowtex.rendering.webgl.protocol.COMPRESSION_LEVEL", 1)


@pytest.fixture(scope="session")
def client_page(browser: Browser) -> Iterator[ClientPage]:
    """Yield a page that has loaded the browser client."""
    from pages import opened_page
    from webgl_page import ClientPage

    with opened_page(browser, 900, 700) as opened:
        yield ClientPage(opened)


@pytest.fixture
def client(client_page: ClientPage) -> Iterator[ClientPage]:
    """Yield the client, without a viewer and with nothing to complain of afterwards."""
    yield client_page
    client_page.clear()
    heard, client_page.errors = client_page.errors, []
    client_page.asked, client_page.tiles = [], []
    assert heard == []
