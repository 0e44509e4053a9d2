"""The steps before a frame of a renderer, in their order.

VTK calls observers of a renderer before it draws its actors. Here one observer of each renderer
performs all steps of a frame, so that their order is in one place: :class:`Step`.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from enum import IntEnum
from typing import Any

import pyvista as pv
from vtkmodules.vtkCommonCore import vtkObject

Before = Callable[[pv.Renderer], None]  #: A step, which is called with the renderer.


class Step(IntEnum):
    """What happens before a frame, in this order."""

    CHANGES = 0  #: Flows follow changes of their mesh, and of flows that share their colour bar.
    BARS = 1  #: Colour bars are placed.
    SURFACES = 2  #: Tiles, shaders and triangles are chosen for the camera.
    CLIPPING = 3  #: The clipping range follows the bounds of the objects.
    PASSES = 4  #: The texture is drawn off the screen.
    OVERLAYS = 5  #: Lines and points follow the surface and the camera.


class FrameSteps:
    """The steps before the frames of one renderer.

    Methods are kept by weak references, so that their objects end when nobody else has them.
    """

    def __init__(self, renderer: pv.Renderer) -> None:
        self._calls: dict[Step, list[Callable[[], Before | None]]] = {step: [] for step in Step}
        renderer.AddObserver("StartEvent", weak_callback(self._perform, with_caller=True))

    @classmethod
    def of(cls, renderer: pv.Renderer) -> FrameSteps:
        """Return the steps of a renderer, the same object at each call."""
        if renderer not in _steps:
            _steps[renderer] = cls(renderer)
        return _steps[renderer]

    def add(self, step: Step, before: Before) -> None:
        """Perform a method or function before each frame; one that was added already stays."""
        calls = self._calls[step]
        if any(call() == before for call in calls):
            return
        if hasattr(before, "__self__"):
            calls.append(weakref.WeakMethod(before))
        else:
            calls.append(lambda: before)

    def remove(self, before: Before) -> None:
        """Perform a step no longer."""
        for calls in self._calls.values():
            calls[:] = [call for call in calls if call() not in {None, before}]

    def _perform(self, renderer: pv.Renderer) -> None:
        """Perform all steps; the first error is raised after the others have run."""
        first_error: Exception | None = None
        for step in Step:
            for call in tuple(self._calls[step]):
                before = call()
                if before is None:
                    continue
                try:
                    before(renderer)
                except Exception as error:  # the frame is drawn as far as possible
                    first_error = first_error or error
        if first_error is not None:
            raise first_error


def weak_callback(method: Callable[..., None], *, with_caller: bool = False) -> Any:
    """Return a callback for VTK that does not keep the method's object alive.

    The method is called without the object that VTK calls for, unless ``with_caller`` is true.
    """
    reference = weakref.WeakMethod(method)

    def call(caller: vtkObject, _event: str, *data: Any) -> None:
        bound = reference()
        if bound is None:
            return
        if with_caller:
            bound(caller, *data)
        else:
            bound(*data)

    return call


#: The steps of renderers.
_steps: weakref.WeakKeyDictionary[pv.Renderer, FrameSteps] = weakref.WeakKeyDictionary()
