"""flowtex draws the flow on a surface as a texture that stays sharp at every zoom.

Three calls are enough to begin: :func:`show` and :func:`render` draw a mesh or a
:class:`FlowField`, and ``plotter.flowtex.add(mesh)`` adds one to a PyVista plotter. Beneath
them lie :meth:`FlowField.from_arrays`, :func:`trace` and :class:`TraceSlices`, which need
NumPy and SciPy alone: what draws is imported when it is first requested.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flowtex._util import __version__ as __version__
from flowtex._util import command as _command  # noqa: F401  # before all that is slow to load
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.readers import register_readers
from flowtex.settings import Settings
from flowtex.trace.slices import TraceSlices
from flowtex.trace.trace import trace

if TYPE_CHECKING:
    from flowtex import examples, pyramid, quality
    from flowtex.field.field_arrays import Reading, ReadingStep
    from flowtex.field.formula.make import formula
    from flowtex.field.quantities import PointValues
    from flowtex.host.export import Page, export
    from flowtex.host.flow_widget import FlowWidget
    from flowtex.host.show import show
    from flowtex.plotting.handle import FlowHandle
    from flowtex.plotting.offscreen.encoders import MovieError
    from flowtex.plotting.offscreen.figure import axes, dynamic_map, extent
    from flowtex.plotting.offscreen.flow_image import FlowImage
    from flowtex.plotting.offscreen.movie import Movie, movie
    from flowtex.plotting.offscreen.plotter import render
    from flowtex.rendering.camera import Camera, CameraError
    from flowtex.rendering.diagnostics import OpenGLMissingError
    from flowtex.scene.probe import Probe
    from flowtex.settings import SettingsError
    from flowtex.sources.notices import DatasetNotice
    from flowtex.textures.images import ImageError
    from flowtex.trace.structure.critical_points import CriticalPoints, critical_points
    from flowtex.trace.structure.orbits import ClosedOrbit, closed_orbits
    from flowtex.trace.structure.separatrices import Separatrices, separatrices

__all__ = [
    "Camera",
    "CameraError",
    "ClosedOrbit",
    "CriticalPoints",
    "DatasetNotice",
    "FieldError",
    "FlowField",
    "FlowHandle",
    "FlowImage",
    "FlowWidget",
    "ImageError",
    "Movie",
    "MovieError",
    "OpenGLMissingError",
    "Page",
    "PointValues",
    "Probe",
    "Reading",
    "ReadingStep",
    "Separatrices",
    "Settings",
    "SettingsError",
    "TraceSlices",
    "axes",
    "closed_orbits",
    "critical_points",
    "dynamic_map",
    "examples",
    "export",
    "extent",
    "formula",
    "movie",
    "pyramid",
    "quality",
    "render",
    "separatrices",
    "show",
    "trace",
]

#: Names that are imported when they are first used: what they need is slow to load, or optional.
_LAZY = {
    "Camera": "rendering.camera",
    "CameraError": "rendering.camera",
    "ClosedOrbit": "trace.structure.orbits",
    "CriticalPoints": "trace.structure.critical_points",
    "DatasetNotice": "sources.notices",
    "FlowHandle": "plotting.handle",
    "FlowImage": "plotting.offscreen.flow_image",
    "FlowWidget": "host.flow_widget",
    "ImageError": "textures.images",
    "Movie": "plotting.offscreen.movie",
    "MovieError": "plotting.offscreen.encoders",
    "OpenGLMissingError": "rendering.diagnostics",
    "Page": "host.export",
    "PointValues": "field.quantities",
    "Probe": "scene.probe",
    "Reading": "field.field_arrays",
    "ReadingStep": "field.field_arrays",
    "Separatrices": "trace.structure.separatrices",
    "SettingsError": "settings",
    "axes": "plotting.offscreen.figure",
    "closed_orbits": "trace.structure.orbits",
    "critical_points": "trace.structure.critical_points",
    "dynamic_map": "plotting.offscreen.figure",
    "export": "host.export",
    "extent": "plotting.offscreen.figure",
    "formula": "field.formula.make",
    "movie": "plotting.offscreen.movie",
    "render": "plotting.offscreen.plotter",
    "separatrices": "trace.structure.separatrices",
    "show": "host.show",
}
#: Those that need OpenGL: it is tried while they are imported.
_DRAWS = ("axes", "dynamic_map", "movie", "render", "show")
#: Those that need PyVista. In notebooks `show` does not, as the browser draws.
_OF_PYVISTA = ("axes", "dynamic_map", "movie", "render", "FlowHandle", "FlowImage", "Movie")


# The constructors of FlowField find the readers above it here.
register_readers("flowtex.sources.readers")


def __getattr__(name: str) -> Any:
    """Import what draws (PyVista, VTK, the widget) only when it is used."""
    import importlib

    if name in ("examples", "pyramid", "quality"):
        return importlib.import_module(f"flowtex.{name}")
    if name in _DRAWS:
        importlib.import_module("flowtex.rendering.diagnostics").begin_trial()
    if name in _OF_PYVISTA:
        importlib.import_module("flowtex.errors").require_pyvista(f"flowtex.{name}")
    if name in _LAZY:
        return getattr(importlib.import_module(f"flowtex.{_LAZY[name]}"), name)
    raise AttributeError(f"module 'flowtex' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
