"""Invalid arguments: what is said of each, and that any other is a FieldError as well."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import chdir
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from earth_fields import winds
from flows import torus
from matplotlib.colors import LogNorm, NoNorm, PowerNorm
from matplotlib.figure import Figure

import flowtex
import flowtex.xarray
from flowtex import FieldError, FlowField, TraceSlices
from flowtex.field.earth.projection import Projection
from flowtex.field.formula.make import line_field
from flowtex.field.options import option_names
from flowtex.field.uncertainty import with_uncertainty
from flowtex.rendering.camera import Camera
from flowtex.scene.options import Appearance, Options
from flowtex.scene.probe import locate, probe, values_at
from flowtex.scene.scene import Scene
from flowtex.settings import TABLE
from flowtex.textures.images import as_picture
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore

#: What no argument is meant to be. Where one has a meaning nevertheless, the call succeeds.
JUNK: tuple[Any, ...] = (
    *(object(), "junk\0", -1, float("nan"), 10**400),
    *([], {"junk": None}, [[1], 2]),
)

POINTS = np.stack(np.meshgrid(np.linspace(0, 2, 4), np.linspace(0, 1, 3)), axis=-1)
VELOCITY = np.ones((2, *POINTS.shape))


def field() -> FlowField:
    return series(times=[0.0, 1.0])


def slices() -> TraceSlices:
    return flowtex.trace(field(), lags=[1.0])


def sign_free() -> FlowField:
    return from_arrays(sign_free=True)


def plane() -> FlowField:
    """Return a steady flow with a scalar ``p`` that is negative and positive."""
    return from_arrays(scalars={"p": POINTS[..., 0] - 1})


def from_arrays(**given: Any) -> FlowField:
    return FlowField.from_arrays(**{"points": POINTS, "velocity": VELOCITY[0], **given})


def series(**given: Any) -> FlowField:
    return from_arrays(velocity=VELOCITY, **given)


def triangles(**given: Any) -> FlowField:
    square, velocity = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.ones((4, 2))
    arrays: dict[str, Any] = {"points": square, "triangles": [[0, 1, 2], [0, 2, 3]]}
    return FlowField.from_triangles(**{**arrays, "velocity": velocity, **given})


def formula(*rates: Any, **given: Any) -> FlowField:
    return flowtex.formula(*(rates or ("y", "-x")), **given)


def settings(**given: Any) -> None:
    """Change settings one at a time; none of them changes."""
    changed = flowtex.Settings()
    try:
        for name, value in given.items():
            setattr(changed, name, value)
    finally:
        assert dict(changed) == dict(flowtex.Settings())


def camera(given: Any) -> Camera:
    return Camera.from_dict(given, Camera((2.4, -1.9, 1.5), (0.1, 0.2, -0.1), (0, 0.6, 0.8)))


def render(**given: Any) -> object:
    return flowtex.render(**{"mesh": plane(), "size": (40, 30), **given})


def textures(field: FlowField, slices: TraceSlices) -> TextureSet:
    return TextureSet.build(SliceStore(field, slices=slices))


def movie(path: str = "flow.mp4", **given: Any) -> None:
    pytest.importorskip("av")
    flowtex.movie(plane(), path, **{"size": (96, 64), **given})


def axes(ax: Any = None, **given: Any) -> object:
    ax = Figure().add_subplot(**ax) if isinstance(ax, dict) else ax
    return flowtex.axes(ax, **{"mesh": plane(), **given})


ANGLES = np.arange(4.0)
ARC_TWICE = np.stack([np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=-1)] * 3)
LINE = np.arange(12.0).reshape(3, 4, 1) * [1, 2, -0.5]
FINITE = "expected three finite numbers"

#: A call, its arguments, and parts of what it says of them, apart by " ... " and in this order.
TABLE_OF_CALLS: dict[Callable[..., object], list[tuple[Any, str]]] = {
    from_arrays: [
        ({"points": POINTS.reshape(-1, 2)}, "points has shape (12, 2); ... with reshape(J, I, 3)"),
        ({"points": POINTS[:1]}, "points has 1 x 4 nodes (J x I); ... choose another plane"),
        ({"points": (np.ones((4, 5)), np.ones((5, 4)))}, "shapes (4, 5), (5, 4); expected one"),
        ({"points": np.ones((3, 4, 3))}, "all usable nodes lie at one point; expected a surface"),
        ({"points": 0 * POINTS - [9.99999e-07, 1e-6]}, "all usable nodes lie"),
        ({"points": LINE}, "all usable nodes lie on one line; expected a surface"),
        ({"points": LINE + 1e6}, "all usable nodes lie on one line"),
        ({"points": ARC_TWICE}, "no cell has an area, because the nodes of each lie on one line"),
        ({"points": 1e40 * POINTS}, "points has values up to 2e+40; expected 1e-30 to 1e+30"),
        ({"points": [[1, 2], [3], [4]]}, "points is not an array ... expected real numbers"),
        ({"velocity": np.ones((4, 3, 3))}, "velocity has shape (4, 3, 3); ... axes seem to be swa"),
        ({"velocity": np.ones((3, 4, 4))}, "velocity has shape (3, 4, 4)"),
        ({"velocity": VELOCITY[0] * 1j}, "velocity has type complex128; ... or take its real part"),
        ({"velocity": VELOCITY[0].astype(str)}, "velocity has type <U32; expected real numbers"),
        ({"velocity": np.full((3, 4, 3), np.nan)}, "none of the 12 nodes is usable"),
        ({"velocity": 1e300 * VELOCITY}, "velocity has values up to 1e+300; expected 1e-100 to 1e"),
        ({"velocity": 1e-200 * VELOCITY}, "velocity has values up to 1e-200; expected 1e-100"),
        ({"valid": np.ones((4, 3), bool)}, "valid has shape (4, 3); expected (3, 4), as points"),
        ({"valid": np.full((3, 4), "yes")}, "valid has type <U3; expected real numbers"),
        ({"valid": np.indices((3, 4)).sum(axis=0) % 2}, "6 of 12 nodes are usable, but no four"),
        ({"scalars": {"p": np.ones((4, 3))}}, "scalars['p'] has shape (4, 3); expected (3, 4) or"),
        ({"scalars": POINTS}, "scalars is array( ... ; expected a mapping by name"),
        ({"units": "m/s"}, "units is 'm/s'; expected a mapping of texts by name"),
        ({"long_names": ["heat"]}, "long_names is ['heat']; expected a mapping of texts by name"),
        ({"velocity_unit": 3}, "velocity_unit is 3; expected a text"),
        ({"sign_free": "yes"}, "sign_free is 'yes'; expected True or False"),
        ({"scalars": {"p": POINTS[..., 0] * 1j}}, "scalars['p'] has type complex128; expected"),
        ({"periodic": "x"}, 'periodic is \'x\'; expected "", "i", "j" or "ij"'),
        ({"length_unit": "m", "velocity_unit": "pixel/frame"}, "is 'pixel/frame', ... to 'm/"),
        ({"length_unit": "m", "time_unit": "s", "velocity_unit": "body lengths/s"}, "'m/"),
    ],
    series: [
        ({"times": [0]}, "times has shape (1,); expected (2,), one for each step"),
        ({"times": [0, np.nan]}, "times[1] is nan; expected a finite number"),
        ({"times": [2, 1]}, "times[1] = 1 is not greater than times[0] = 2; expected"),
        ({"times": [0, 0]}, "times[1] = 0 is not greater than times[0] = 0; expected"),
        ({"times": [0, 1e200]}, "times reach 1e+200; expected 1e+100 at most"),
        ({"times": [[0.0], [1.0, 2.0]]}, "times is not an array ... expected real numbers"),
        (
            {"times": np.ma.masked_array([0, 1.0], [False, True])},
            "times[1] is nan; expected a finite",
        ),
        ({"times": np.ones(2, "m8[M]")}, "timedelta64[M], whose units have no fixed length"),
        ({"times": np.array(["2002", "NaT"], "M8[D]")}, "times[1] is nan; expected a"),
        ({"times": np.arange(2).astype("M8[D]"), "time_unit": "d"}, "but the times are dates"),
        ({"sign_free": True}, "sign_free is True, but velocity has 2 time steps ... velocity[-1]"),
        ({"scalars": {"p": np.ones((3, 3, 4))}}, "(3, 3, 4); expected (3, 4) or (2, 3, 4)"),
        (
            {
                "times": [0],
                "valid": np.ones(5, bool),
                "scalars": {"p": np.ones(1)},
                "periodic": "k",
            },
            "4 things are wrong: ... times has ... valid has ... scalars ... periodic is",
        ),
    ],
    triangles: [
        ({"points": np.ones((2, 2, 2))}, "points has shape"),
        ({"points": np.array([["a"]])}, "points has type"),
        ({"triangles": [[0, 1]]}, "triangles has shape"),
        ({"triangles": [[0, 1, 2.5]]}, "whole numbers"),
        ({"triangles": [[1, 2, 4]]}, "node 4; expected 0 to 3"),
        ({"triangles": [[-1, 0, 1]]}, "node -1"),
        ({"triangles": np.ones((0, 3), int)}, "triangles is empty"),
        ({"velocity": np.ones((3, 2))}, "velocity has shape"),
        ({"velocity": np.full((4, 2), np.nan)}, "0 of 4 nodes are usable"),
        ({"velocity": np.full((4, 2), 1e200)}, "velocity has values"),
        ({"times": [0.0, 1.0]}, "times has shape"),
        ({"valid": [True]}, "valid has shape"),
        ({"scalars": {"p": np.ones(3)}}, "scalars['p'] has shape"),
    ],
    partial(with_uncertainty, plane()): [
        (["q"], "uncertainty is 'q', which is not a scalar; expected one of: p"),
        ([np.ones((2, 4))], "uncertainty is (2, 4); expected ... shape (3, 4)"),
        ([True], "uncertainty is True; expected the name"),
        ([-np.ones((3, 4))], "uncertainty is -1 at a node; expected 0 where"),
    ],
    plane().downsample: [
        ([0], "factor is 0; expected 1 or more"),
        ([3], "factor is 3, which keeps 1 of 3 lines; ... at least 2"),
    ],
    torus().downsample: [([20], "expected a smaller factor that keeps at least 4")],
    triangles().downsample: [([2], "no lines of nodes")],
    plane().at_step: [([1], "time step 1 does not exist: expected 0 to 0")],
    partial(locate, plane()): [
        (["here"], "point is"),
        ([(1.0,)], "point is"),
        ([(np.nan, 0.0)], "point is"),
    ],
    partial(values_at, plane()): [
        ([(9.5, 1)], "(9.5, 1), not on the drawn surface; expected j from 0 to 2"),
        ([(1, 12.5)], "i from 0 to 3"),
        ([(1, np.nan)], "two finite numbers"),
    ],
    partial(values_at, triangles()): [
        ([(-1.0, 0.2)], "not on the drawn surface"),
        ([(0.0, 1.5)], "not on the drawn surface"),
    ],
    plane().derive: [
        (["vortcity"], "'vortcity' cannot be derived; expected one of vorticity"),
        (["ftle"], "horizon is None for 'ftle'; expected a time other than"),
        ({"name": "ftle", "horizon": 0}, "horizon is 0 for 'ftle'"),
        ({"name": "shear", "horizon": 1.0}, "horizon=1.0 is given for 'shear'; only ftle"),
    ],
    sign_free().derive: [(["vorticity"], "this field is sign-free")],
    formula: [
        ({"x": (7, -7)}, "x is (7, -7); expected two numbers, the lower one first"),
        ({"u": (0, 1)}, "u has a range, but the coordinates here are x and y"),
        ({"b": "high"}, "b is 'high'; expected a number, or value, low and high"),
        ({"z": 1}, "z is a coordinate or the time"),
        ({"times": [1, 0]}, "expected times that increase"),
        ({"resolution": 1}, "resolution is 1; expected 2 to 10,000 nodes"),
        ({"surface": "cube"}, "surface is 'cube'; expected ... one of sphere, torus, cylinder"),
        ({"surface": ("u", "v")}, "expected x, y and z of u and v"),
        (["1", "2", "3"], "3 expressions are given; expected two, the rates"),
        (["sqrt(-1 - x*x)", "y"], "has no value in any cell of the grid"),
        ([None, "y"], "an expression is None; expected a text"),
        ([lambda q: q, "y"], "takes q; expected one of: x, y"),
        ([lambda x: x[:2], "y"], "does not return numbers at nodes of shape"),
        (["pendulu"], "known formula; did you mean 'pendulum'"),
    ],
    partial(flowtex.formula, "pendulum"): [({"c": 1}, "Pendulum has no parameter 'c'; ... : b")],
    line_field: [
        (["y; x; b=fast"], "b is 'fast'; expected one to three numbers separated by commas"),
        (["y; x; t=1"], "such as t=0,10,41"),
        (["y; x; resolution=9000"], "resolution cannot be the name of a parameter"),
        (["y; x; z"], "3 expressions are given"),
        ([";"], "0 expressions are given"),
    ],
    Projection: [(["flat"], "'flat' ... platecarree"), (["EPSG:4326"], "degrees")],
    partial(flowtex.trace, plane()): [
        *(
            ({"lags": lags}, f"lags is {lags!r}; expected positive numbers in increasing")
            for lags in ([], [0.0, 1.0], [-1.0], [2.0, 1.0], [1.0, np.inf], [np.nan], [[1.0, 2.0]])
        ),
        ({"lags": [1e-40, 1.0]}, "lags range from 1e-40 to 1; expected 1e-30 to 1e"),
        ({"parameter": "length"}, 'parameter is \'length\'; expected "arclength" or "time"'),
        ({"unit": -1.0}, "unit has values from -1 to -1; expected positive numbers"),
        ({"tolerance": 0}, "tolerance is 0; expected a positive number of cells"),
        ({"longest": -1.0}, "longest is -1.0; expected a positive length"),
        ({"nodes": np.ones((2, 3), bool), "compose": False}, "nodes has shape (2, 3); expected (3"),
        ({"steps": [1]}, "time step 1 does not exist: expected 0 to 0"),
    ],
    partial(flowtex.trace, sign_free()): [
        ({"two_sided": False}, "two_sided is False; expected True"),
        ({"compose": True}, "compose is True; expected False or None"),
    ],
    slices().positions: [
        ([4.5], "lag is 4.5; expected 0 to 1, the lag of the last"),
        ([-1], "lag is -1; expected 0 to 1"),
    ],
    partial(flowtex.trace(plane(), two_sided=False).positions, 0.1): [
        ({"forward": True}, "the slices have no forward side: trace with")
    ],
    lambda count: textures(plane(), flowtex.trace(plane(), lags=np.linspace(0.1, 1, count))): [
        ([1], "1 lags were traced; drawing needs 2 to 32"),
        ([33], "33 lags were traced; drawing needs 2 to 32"),
    ],
    partial(textures, FlowField.from_arrays(POINTS[:2], VELOCITY[0, :2])): [
        ([flowtex.trace(plane(), lags=[0.5, 1])], "the slices have (3, 4) nodes and the field (2,")
    ],
    as_picture: [
        ([np.zeros((3, 4, 2))], "the image has shape (3, 4, 2); expected (H, W)"),
        ([np.zeros((0, 4))], "the image is empty, of shape (0, 4)"),
        ([np.array([[0.0, np.nan]])], "the image has 1 values that are NaN"),
        ([np.array([[0.0, 255.0]])], "floats range from 0 to 255; expected 0 to 1"),
        ([np.array([[0, 1]], np.int64)], "the image holds int64; expected uint8, or floats"),
    ],
    settings: [
        ({"samples": 0}, "samples is 0; expected a whole number from 1 to 200 (default"),
        ({"lod": "yes"}, "lod is 'yes'; expected True or False (default True)"),
        ({"contrast": np.nan}, "contrast is nan; expected a number from 0 to 4 (default "),
        ({"kernel": "gauss"}, "kernel is 'gauss'; expected 'hann' or 'box' or 'ramp'"),
        ({"sampels": 3}, "the setting 'sampels' does not exist; did you mean 'sam"),
        ({"xyzzy": 3}, "the setting 'xyzzy' does not exist; expected one of: samples"),
    ],
    lambda name, text: TABLE[name].parse(text): [
        (["lod", "maybe"], "lod is 'maybe'; expected"),
        (["samples", "2.5"], "samples is 2.5; expected"),
        (["grain", "nan"], "grain is nan; expected"),
    ],
    camera: [
        ([None], "camera is None; expected a mapping with some of position, "),
        ([{"zoom": 2}], "camera is {'zoom': 2}; expected a mapping with some of"),
        ([{"position": [0, 0]}], f"camera.position is [0, 0]; {FINITE}"),
        ([{"position": "abc"}], f"camera.position is 'abc'; {FINITE}"),
        ([{"view_angle": 180}], "camera.view_angle is 180; expected 0 to 180 degrees"),
        ([{"parallel_scale": 0}], "camera.parallel_scale is 0; expected a positive"),
        ([{"position": [0.1, 0.2, -0.1]}], "on one line; expected up to point away"),
        ([{"position": [1e300, 1e300, 0]}], "on one line; expected up to point away"),
    ],
    Camera.from_dict: [([{"position": (0, 0, 1)}], "expected focal_point, up as well")],
    Options.split: [
        ({"zooom": 2}, "argument 'zooom' does not exist; did you mean 'zoom'?"),
        ({"qqqq": object()}, "'qqqq' does not exist; help(flowtex.render) has all"),
        ({"proj": "north"}, "'proj' does not exist; did you mean 'projection'?"),
        # What other packages call them.
        ({"vmin": 0.0}, "did you mean 'clim'?"),
        ({"alpha": 0.5}, "did you mean 'opacity'?"),
        ({"depth": 10}, "did you mean 'level'?"),
        ({"colorbar": True}, "did you mean 'show_scalar_bar'?"),
        ({"window_size": 5}, "exist; help(flowtex.render)"),
        ({"longitude": -30}, "use sel={'longitude': -30}"),
        ({"opacity": 2}, "opacity is 2; expected a number from 0 to 1"),
        ({"clim": (1, 2, 3)}, "clim is (1, 2, 3); expected two numbers, (low, high)"),
        ({"clim": "ab"}, "clim is 'ab'; expected two numbers, (low, high), the lower one"),
        ({"clim": (2, 1)}, 'clim is (2, 1); expected ... the lower one first, or "robust"'),
        ({"cmap": "virdis"}, "colour map 'virdis' does not exist; did you mean 'viridis'"),
        ({"cmap": 3}, "the colour map 3 does not exist; expected a name"),
        ({"color": "greyy"}, "greyy"),
        ({"axes": "bar"}, "axes is 'bar'; expected 'ticks', 'scale', 'none', or None"),
        ({"coastlines": "10m"}, "coastlines is '10m', which does not exist; expected True, False"),
        ({"opacity": -1, "clim": -3}, "2 things are ... opacity is -1; ... clim is -3;"),
        *(
            ({name: "10m"}, f"{name} is '10m'; expected True or False")
            for name in ("graticule", "lighting", "visible")
        ),
    ],
    partial(Scene.of, plane()): [
        ({"times": [1.0]}, "times cannot be set for a field"),
        ({"plane": "k=1"}, "plane cannot be set for a field that already exists"),
        ({"globe": True}, "globe cannot be set for a field"),
        ({"zoom": 2}, "the setting or argument 'zoom' does not exist; "),
        ({"scalars": "mach"}, "no scalar 'mach'; expected one of 'speed'"),
        ({"scalars": "U_x"}, "; a component is named as in 'U_x', or chosen"),
        ({"scalars": "p", "log_scale": True}, "log_scale is True, but "),
        ({"image": np.zeros((2, 2, 7))}, "the image has shape (2, 2, 7)"),
        ({"noise": "image"}, "noise is 'image', but no image is given; pass"),
        ({"noise": "procedural", "image": np.ones((2, 2))}, "but an image is given; omit"),
    ],
    partial(Scene.of, sign_free()): [
        ({"separatrices": True}, "separatrices is 25; expected 0, because the field is sign"),
        ({"critical_points": 7}, "critical_points is 7; expected 0"),
    ],
    partial(Scene.of, triangles()): [
        ({"image": np.ones((4, 4, 3))}, "noise is 'image' ... triangles; expected noise="),
        ({"noise": "texture"}, "noise is 'texture' ... triangles; expected noise="),
    ],
    partial(Scene.of, torus()): [
        ({"nullclines": True}, "nullclines is True; expected False: the surface")
    ],
    Scene.of(plane()).beside: [([{"plane": "k=2"}], "beside has plane, which selects data")],
    lambda at, pixel: probe(Scene(plane()), at, pixel=pixel, size=(9, 9)): [
        ([(41.0, 3.0), 0.1], "(41, 3), not on the drawn surface"),
        ([(1.0, 2.0), 0.0], "pixel is 0.0; expected a positive length"),
        ([(1.0, 2.0), np.nan], "pixel is nan"),
        ([(1.0, 2.0), Camera((0, 0, -1), (0, 0, -2), (0, 1, 0))], "is behind the camera"),
        ([(1.0, 2.0), Camera((0, -9, 0), (0, 0, 0), (0, 0, 1), parallel=True)], "seen edge-on"),
    ],
    flowtex.critical_points: [
        ({"field": sign_free()}, "this field is sign-free"),
        ({"field": plane(), "steps": [1]}, "time step 1 does not exist"),
    ],
    partial(flowtex.separatrices, plane()): [({"length": -1}, "expected a positive length")],
    flowtex.critical_points(plane()).of_kind: [
        (["node"], "kind 'node' does not exist; expected one of saddle")
    ],
    flowtex.examples.double_gyre_velocity: [([POINTS[..., :1]], "points has shape (3, 4, 1)")],
    lambda mesh, margin=0.1, **given: flowtex.extent(mesh, margin=margin, **given): [
        *(([plane(), wrong], "margin is ... ; expected a number") for wrong in (-0.1, 0.5, "wide")),
        ([torus()], "the surface is curved ... with flowtex.render"),
        ({"mesh": plane(), "beside": {"lod": False}}, "beside makes two views ... omit it"),
        ({"mesh": plane(), "camera": [(0, 0, 9), (0, 0, 0), (0, 1, 0)]}, "camera is ... Omit it"),
    ],
    lambda **given: flowtex.examples.weather().flowtex.plot(**given): [
        ({"u": "u"}, "u='u' is given; expected u and v"),
        ({"transform": 3}, "transform is 3; expected ccrs.PlateCarree() or none"),
        ({"col": "level", "ax": 1}, "ax is given, but row and col make their own axes"),
    ],
    flowtex.export: [
        ([plane(), "a.pdf"], "a.pdf'; expected a name that ends in .html, .htm, .mjs"),
        ({"mesh": plane(), "path": "a.html", "steps": 0}, "steps is 0; expected 1 to 1"),
        ([plane(), "none/a.html"], "none' does not exist; create"),
    ],
}
#: The same for calls that need OpenGL.
TABLE_OF_DRAWING: dict[Callable[..., object], list[tuple[Any, str]]] = {
    render: [
        ({"margin": np.nan}, "margin is nan; expected a number from 0 to less th"),
        ({"supersampling": 0}, "expected 1 to"),
        ({"size": (9000, 9), "supersampling": 2}, "expected 1 to"),
        ({"scalars": np.ones(3)}, "scalars is (3,); expected the name of an array, or"),
        ({"scalars": "ftle"}, "'ftle' needs a horizon; ... with_derived"),
        ({"norm": 3}, "norm is 3; expected a matplotlib Normalize, such as Power"),
        ({"norm": NoNorm()}, "expected a matplotlib Normalize"),
        ({"norm": "lg"}, "norm is 'lg'; ... or a name such as 'log'"),
        ({"norm": PowerNorm(2), "clim": (0, 1)}, "and clim is given too; omit it, and give"),
        ({"norm": PowerNorm(2), "log_scale": True}, "and log_scale is given too"),
        ({"norm": LogNorm(), "scalars": "p"}, "norm is LogNorm from ... range from -1 to 1"),
        ({"n_colors": 0}, "n_colors is 0; expected a whole number from 1 to 1,024"),
        ({"flip_scalars": "yes"}, "flip_scalars is 'yes'; expected True or False"),
        ({"below_color": "blu"}, "the colour 'blu' does not exist"),
    ],
    movie: [
        ({"motion": "off"}, "motion is 'off'; expected 'speed' or 'uniform'"),
        ({"image": np.ones((2, 2))}, "noise is 'image', which cannot move"),
        ({"noise": "texture"}, "noise is 'texture', which cannot move"),
        ({"seconds": 0.0}, "seconds is 0.0; expected a number from 0.1 to 600"),
        ({"fps": 500.0}, "fps is 500.0; expected more than 0 and at most 120"),
        ({"fps": 100.0, "seconds": 600.0}, "60,000 frames; expected at most"),
        ({"size": (95, 64)}, "size is 95 x 64; an MP4 needs even sides, such as 94 x"),
        ({"quality": 0}, "quality is 0; expected a number from 1 to 100"),
        ({"path": "flow.avi"}, "'.avi' is not a movie format; expected .mp4, .gif"),
        ({"path": "flow.gif", "fps": 60.0}, "a GIF can show at most 50 frames per"),
        ({"path": "flow.gif", "size": (0, 10)}, "size is 0 x 10; expected 1 to 16384"),
    ],
    flowtex.movie: [(["y.mp4", [plane(), plane()]], "path is [ ... ...; expected a path")],
    axes: [
        ({}, "ax is None; expected rectilinear or polar matplotlib axes"),
        ({"ax": {"projection": "hammer"}}, "ax ... ; expected rectilinear or polar matplotlib"),
        ({"ax": {}, "mesh": torus()}, "the surface is curved"),
        ({"ax": {"xscale": "log"}, "mesh": from_arrays(points=POINTS - 5)}, "x is from -5 to -3 "),
        ({"ax": {"yscale": "log"}, "mesh": winds("platecarree")}, "ax is with scales ... of the E"),
        ({"ax": {"projection": "polar"}, "mesh": winds("platecarree")}, "ax is polar, ... of the"),
    ],
}


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """An empty folder, in which functions write."""
    with chdir(tmp_path):
        yield tmp_path


def message(call: Callable[..., object], arguments: Any) -> str:
    """Return what a call says of its arguments, by name or by position."""
    with pytest.raises(FieldError) as told:
        call(**arguments) if isinstance(arguments, dict) else call(*arguments)
    return str(told.value)


def rows(table: dict[Callable[..., object], list[tuple[Any, str]]]) -> list[Any]:
    return [
        pytest.param(call, arguments, words, id=words[:50])
        for call, cases in table.items()
        for arguments, words in cases
    ]


@pytest.mark.parametrize(("call", "arguments", "words"), rows(TABLE_OF_CALLS))
def test_invalid_argument_is_named(
    call: Callable[..., object], arguments: Any, words: str, folder: Path
) -> None:
    assert_in_order(message(call, arguments), words)
    assert not list(folder.iterdir())


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize(("call", "arguments", "words"), rows(TABLE_OF_DRAWING))
def test_invalid_argument_is_named_before_drawing(
    call: Callable[..., object], arguments: Any, words: str, folder: Path
) -> None:
    assert_in_order(message(call, arguments), words)
    assert not list(folder.iterdir())


def assert_in_order(text: str, words: str) -> None:
    assert re.search(".*".join(map(re.escape, words.split(" ... "))), text, re.DOTALL), text


#: Functions, and arguments of which one at a time becomes junk; a function makes its own.
CALLS: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "from_arrays": (
        from_arrays,
        dict.fromkeys(["points", "velocity", "times", "valid", "scalars", "periodic"]),
    ),
    "from_triangles": (triangles, dict.fromkeys(["points", "triangles", "velocity"])),
    "from_pyvista": (FlowField.from_pyvista, {"mesh": None}),
    "from_file": (FlowField.from_file, {"path": None}),
    "from_xarray": (FlowField.from_xarray, {"data": None}),
    "field.downsample": (lambda **given: field().downsample(**given), {"factor": 1}),
    "trace": (
        partial(flowtex.trace, lags=[1.0]),
        dict(field=field, steps=[0], parameter="time", unit=1.0, tolerance=1e-3, nodes=None),
    ),
    "lags": (partial(flowtex.trace, field()), {"lags": None}),
    "positions": (lambda **given: slices().positions(**given), {"lag": 0.5, "step": 0}),
    "Camera": (Camera, {"position": (0, 0, 1), "focal_point": (0, 0, 0), "up": (0, 1, 0)}),
    "Settings": (flowtex.Settings, {name: row.default for name, row in TABLE.items()}),
    "Scene": (
        partial(Scene.of, field()),
        dict.fromkeys(set(option_names(Appearance)) - {"log_scale", "opacity", "visible"}),
    ),
    "opacity": (partial(Scene.of, field()), {"opacity": 1.0}),
    "locate": (locate, {"field": field, "point": (0.5, 0.5)}),
    "values_at": (values_at, {"field": field, "index": (0.5, 0.5), "time": 0.5}),
    "extent": (flowtex.extent, dict(mesh=field, size=(20, 10), margin=0.1, zoom=1.0, focus=None)),
    "export": (flowtex.export, dict(mesh=field, path="a.html", steps=None, store=None)),
    "build": (flowtex.pyramid.build, dict(source=field, store="a.zarr", lines="auto", memory=None)),
    "open_store": (flowtex.pyramid.open_store, {"store": None}),
    "double_gyre": (flowtex.examples.double_gyre, {"time": 0.0}),
}
#: The same for those that draw.
DRAWING: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "render": (
        flowtex.render,
        dict(mesh=field, size=(20, 10), time=None, clock=0.0, supersampling=1, margin=0.1)
        | dict(background="white", zoom=1.0, focus=None, camera=None, beside=None),
    ),
    "movie": (
        partial(flowtex.movie, progress=False, seconds=0.1),
        dict(mesh=field, path="a.gif", size=(20, 10), fps=10.0, quality=80, supersampling=1),
    ),
    "axes": (flowtex.axes, {"ax": Figure().add_subplot, "mesh": field}),
}


def refused(function: Callable[..., object], arguments: dict[str, Any]) -> int:
    """Call a function with junk for one argument at a time, and count what is refused."""
    count = 0
    for name in arguments:
        for junk in JUNK:
            # None stands for the default.
            given = {k: v() if callable(v) else v for k, v in arguments.items() if v is not None}
            try:
                function(**{**given, name: junk})
            except FieldError as error:
                assert str(error), (name, junk)
                count += 1
            except Exception as error:
                error.add_note(f"{name}={junk!s:.40}")
                raise
    return count


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", CALLS)
def test_any_other_value_raises_field_error(name: str, folder: Path) -> None:
    function, arguments = CALLS[name]
    with np.errstate(all="ignore"):
        assert refused(function, arguments) >= len(arguments)
    assert {path.name for path in folder.iterdir()} <= {"a.html", "a.npz", "a.zarr"}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", DRAWING)
def test_any_other_value_raises_before_drawing(name: str, folder: Path, opengl: object) -> None:
    function, arguments = DRAWING[name]
    assert refused(function, arguments) >= len(arguments)
    assert {path.name for path in folder.iterdir()} <= {"a.gif"}


@pytest.mark.parametrize("argument", ["port", "limit", "idle"])
def test_page_is_not_served_with_invalid_arguments(argument: str) -> None:
    pytest.importorskip("trame_rca")
    from flowtex.app import serve

    for junk in JUNK:
        with pytest.raises(FieldError, match=argument):
            serve(field(), **{argument: junk})


def test_field_error_is_public() -> None:
    assert flowtex.FieldError is FieldError and "FieldError" in flowtex.__all__
    assert f"{FieldError.__module__}.{FieldError.__name__}" == "flowtex.FieldError"
