"""Every refusal of data or arguments is a FieldError, whatever is given."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import chdir
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex import FieldError, FlowField, TraceSlices
from flowtex.scene.options import Appearance
from flowtex.scene.probe import locate, values_at
from flowtex.scene.scene import Scene
from flowtex.settings import TABLE

#: What no argument is meant to be. Where one has a meaning nevertheless, the call succeeds.
JUNK: tuple[Any, ...] = (
    *(object(), "junk\0", -1, float("nan"), 10**400),
    *([], {"junk": None}, [[1], 2]),
)

POINTS = np.stack(np.meshgrid(np.linspace(0, 2, 4), np.linspace(0, 1, 3)), axis=-1)
VELOCITY = np.ones((2, *POINTS.shape))


def field() -> FlowField:
    return FlowField.from_arrays(POINTS, VELOCITY, times=[0.0, 1.0])


def slices() -> TraceSlices:
    return flowtex.trace(field(), lags=[1.0])


#: Functions, and arguments of which one at a time becomes junk; a function makes its own.
CALLS: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "from_arrays": (
        FlowField.from_arrays,
        {
            "points": POINTS,
            "velocity": VELOCITY,
            "times": [0.0, 1.0],
            "valid": np.ones(POINTS.shape[:2], bool),
            "scalars": {"height": POINTS[..., 1]},
            "periodic": None,
        },
    ),
    "from_triangles": (
        FlowField.from_triangles,
        {
            "points": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            "triangles": [[0, 1, 2]],
            "velocity": [[1.0, 0.0]] * 3,
        },
    ),
    "from_pyvista": (FlowField.from_pyvista, {"mesh": None}),
    "from_file": (FlowField.from_file, {"path": None}),
    "from_xarray": (FlowField.from_xarray, {"data": None}),
    "field.downsample": (lambda **given: field().downsample(**given), {"factor": 1}),
    "trace": (
        flowtex.trace,
        {
            "field": field,
            "lags": [1.0],
            "steps": [0],
            "parameter": "time",
            "unit": 1.0,
            "tolerance": 1e-3,
            "nodes": None,
        },
    ),
    "positions": (lambda **given: slices().positions(**given), {"lag": 0.5, "step": 0}),
    "slices.downsample": (lambda **given: slices().downsample(**given), {"factor": 1}),
    "save": (lambda **given: slices().save(**given), {"path": "a.npz"}),
    "open": (TraceSlices.open, {"path": None}),
    "Camera": (flowtex.Camera, {"position": (0, 0, 1), "focal_point": (0, 0, 0), "up": (0, 1, 0)}),
    "Settings": (flowtex.Settings, {name: row.default for name, row in TABLE.items()}),
    "Scene": (
        lambda **given: Scene.of(field(), **given),
        dict.fromkeys(set(Appearance.__dataclass_fields__) - {"log_scale", "opacity", "visible"}),
    ),
    "opacity": (lambda **given: Scene.of(field(), **given), {"opacity": 1.0}),
    "locate": (locate, {"field": field, "point": (0.5, 0.5)}),
    "values_at": (values_at, {"field": field, "index": (0.5, 0.5), "time": 0.5}),
    "extent": (
        flowtex.extent,
        {"mesh": field, "size": (20, 10), "margin": 0.1, "zoom": 1.0, "focus": None},
    ),
    "export": (flowtex.export, {"mesh": field, "path": "a.html", "steps": None, "store": None}),
    "build": (
        flowtex.pyramid.build,
        {"source": field, "store": "a.zarr", "lines": "auto", "memory": None},
    ),
    "open_store": (flowtex.pyramid.open_store, {"store": None}),
    "double_gyre": (flowtex.examples.double_gyre, {"time": 0.0}),
}
#: The same for those that draw.
DRAWING: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "render": (
        lambda **given: flowtex.render(**given),
        {
            "mesh": field,
            "size": (20, 10),
            "time": None,
            "clock": 0.0,
            "supersampling": 1,
            "margin": 0.1,
            "background": "white",
            "zoom": 1.0,
            "focus": None,
            "camera": None,
            "beside": None,
        },
    ),
    "movie": (
        lambda **given: flowtex.movie(progress=False, **given),
        {
            "mesh": field,
            "path": "a.gif",
            "size": (20, 10),
            "seconds": 0.1,
            "fps": 10.0,
            "quality": 80,
            "supersampling": 1,
        },
    ),
    "axes": (lambda **given: flowtex.axes(**given), {"ax": None, "mesh": field}),
}


def refused(function: Callable[..., object], arguments: dict[str, Any]) -> int:
    """Call a function with junk for one argument at a time, and count what is refused."""
    count = 0
    for name in arguments:
        for junk in JUNK:
            given = {k: v() if callable(v) else v for k, v in arguments.items()}
            try:
                function(**{**given, name: junk})
            except FieldError as error:
                assert str(error), (name, junk)
                count += 1
            except Exception as error:
                error.add_note(f"{name}={junk!s:.40}")
                raise
    return count


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """An empty folder, in which functions write."""
    with chdir(tmp_path):
        yield tmp_path


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", CALLS)
def test_junk_is_refused_by_a_field_error(name: str, folder: Path) -> None:
    function, arguments = CALLS[name]
    with np.errstate(all="ignore"):
        assert refused(function, arguments) >= len(arguments)
    assert {path.name for path in folder.iterdir()} <= {"a.html", "a.npz", "a.zarr"}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", DRAWING)
def test_junk_is_refused_before_it_is_drawn(name: str, folder: Path, opengl: object) -> None:
    function, arguments = DRAWING[name]
    assert refused(function, arguments) >= len(arguments)
    assert {path.name for path in folder.iterdir()} <= {"a.gif"}


@pytest.mark.parametrize("argument", ["port", "limit", "idle"])
def test_a_page_is_not_served_with_junk(argument: str) -> None:
    pytest.importorskip("trame_rca")
    from flowtex.app import serve

    for junk in JUNK:
        with pytest.raises(FieldError, match=argument):
            serve(field(), **{argument: junk})


def test_it_is_public() -> None:
    assert flowtex.FieldError is FieldError and "FieldError" in flowtex.__all__
    assert f"{FieldError.__module__}.{FieldError.__name__}" == "flowtex.FieldError"
