"""OpenGL contexts and forks of this process.

Drivers draw with threads, which a forked process does not have: it would wait for them without end,
also where it only frees a window. So the thread that forks frees its contexts before. VTK makes
them again for the next frame, here and in the forked process. Contexts of other threads, and of
windows on a screen, remain; a forked process that inherits one cannot draw.
"""

from __future__ import annotations

import atexit
import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

from flowtex._util.forks import call_at_fork, renew_after_fork
from flowtex._util.pyvista_internals import abandon, open_plotters
from flowtex.rendering.diagnostics import OpenGLMissingError

#: Threads that drew the last frames of windows.
_threads: weakref.WeakKeyDictionary[vtkOpenGLRenderWindow, int] = weakref.WeakKeyDictionary()
#: Windows whose context was in use when a forked process began.
_inherited: list[vtkOpenGLRenderWindow] = []


def check_fork() -> None:
    """Check that VTK can draw in this process.

    Raises
    ------
    OpenGLMissingError
        When the process was forked while a window was open or another thread drew.
    """
    if _inherited:
        raise OpenGLMissingError(
            "VTK cannot draw here: this process was forked while a window was on the screen or "
            "another thread drew. To fix it, close plotters before the fork, or start processes "
            "with multiprocessing.get_context('spawn')"
        )


def note_thread(window: vtkOpenGLRenderWindow | None) -> None:
    """Remember that this thread draws in a window, if there is one."""
    if window is not None:
        _threads[window] = threading.get_ident()


def _windows() -> Iterator[vtkOpenGLRenderWindow]:
    """Yield the windows that have a context."""
    # Also plotters without a flow keep threads of the driver.
    windows: list[Any] = [plotter.render_window for plotter in open_plotters()]
    candidates: dict[int, Any] = {id(window): window for window in [*_threads, *windows]}
    for window in candidates.values():
        if isinstance(window, vtkOpenGLRenderWindow) and window.GetInitialized():
            yield window


def _free_contexts() -> None:
    """Free the contexts of this thread that are not on a screen."""
    main = threading.main_thread().ident
    here = threading.get_ident()
    for window in _windows():
        if window.GetOffScreenRendering() and _threads.get(window, main) == here:
            window.Finalize()


def _keep_inherited() -> None:
    """Keep inherited contexts in a forked process for ever, because it cannot free them."""
    for window in _windows():
        window.Register(None)  # type: ignore[arg-type]
        _inherited.append(window)
    for plotter in open_plotters():
        if plotter.render_window in _inherited:
            abandon(plotter)


#: Longest wait in seconds for frames of other threads when the interpreter ends.
ENDING_S = 10.0


class _Frames:
    """The threads that draw frames, and the thread that ends the interpreter."""

    def __init__(self) -> None:
        self._drawing: set[int] = set()
        self._last: int | None = None
        self.renew()
        renew_after_fork(self)

    def renew(self) -> None:
        """Forget the frames of threads that a forked process does not have."""
        self._changed = threading.Condition()
        self._drawing &= {threading.get_ident()}

    def begin(self) -> bool:
        """Wait, at the end of the interpreter for ever; return whether no frame surrounds it."""
        own = threading.get_ident()
        with self._changed:
            self._changed.wait_for(lambda: self._last in (None, own))
            is_outermost = own not in self._drawing
            self._drawing.add(own)
        return is_outermost

    def end(self) -> None:
        """Tell that this thread draws no longer."""
        with self._changed:
            self._drawing.discard(threading.get_ident())
            self._changed.notify_all()

    def close(self) -> None:
        """Wait for the frames of other threads, and let no further one begin."""
        own = threading.get_ident()
        with self._changed:
            self._last = own
            self._changed.wait_for(lambda: self._drawing <= {own}, ENDING_S)


_frames = _Frames()
atexit.register(_frames.close)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Draw a frame before the interpreter ends, or never: VTK aborts a process that ends amid one.

    Daemon threads may still draw then. Their frames are waited for, and further ones do not begin.
    """
    is_outermost = _frames.begin()
    try:
        yield
    finally:
        if is_outermost:
            _frames.end()


call_at_fork(before=_free_contexts, after=_keep_inherited)
