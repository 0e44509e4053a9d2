"""The numbers that the client in the browser is held to, in files that its own tests read.

``FLOWTEX_WRITE_FIXTURES=1`` writes the files; without it they must say what Python computes.
"""

from __future__ import annotations

import json
import os
from datetime import datetime
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from camera_moves import pan, rotate, zoom_by
from flows import gyre, lines, swinging, torus
from matrix import ASIDE, IMAGE, TILTED, WHOLE, straight
from triangle_meshes import random_plane

import flowtex
from flowtex import FlowField
from flowtex._util.colours import colour_table
from flowtex.field.dates import date_text
from flowtex.field.earth.map_lines import MapLines
from flowtex.field.earth.projection import Projection
from flowtex.field.formula.formula import gradient_trees
from flowtex.field.formula.grammar import FUNCTIONS, OPERATIONS, evaluate, parse
from flowtex.rendering.arrow_seeds import ArrowSeeds, seed_limits
from flowtex.rendering.camera import CAMERA_LIMITS, Camera
from flowtex.rendering.cpu.noise import noise_lattice, octave
from flowtex.rendering.cpu.shade import mean_colours
from flowtex.rendering.map_overlay import map_lines
from flowtex.rendering.structure import DRAWN_EXTENTS, shared_structure
from flowtex.rendering.tile_choice import TileView, choose_tiles, cover, wanted_tiles
from flowtex.rendering.uniforms import ViewState, uniforms
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.marks import Marks
from flowtex.rendering.webgl.velocity import velocity_part
from flowtex.scene.probe import probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings
from flowtex.textures.images import as_picture
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.pyramid import Pyramid, TileKey
from flowtex.textures.tiles.triangle_pyramid import TrianglePyramid
from flowtex.trace.store import SliceStore
from flowtex.trace.structure.critical_points import critical_points
from flowtex.trace.structure.separatrices import separatrices

FOLDER = Path(__file__).resolve().parents[2] / "client" / "tests"

#: Parts of the header that the client's uniforms come from.
NEEDED = ("variant", "geometry", "slices", "image", "constants", "settings")
PYTHONS = ("lags", "levels", "still")  #: What only Python knows of a view.


@cache
def strip() -> FlowField:
    """A flow on a bent strip of few nodes."""
    a, b = np.meshgrid(np.linspace(0, 2, 9), np.linspace(-0.8, 0.8, 7))
    points = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)
    velocity = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
    return FlowField.from_arrays(points, velocity)


#: Name, field, eye, pixels drawn for one of the page, and settings.
VIEWS: dict[str, tuple[Any, Any, float, dict[str, Any]]] = {
    "whole": (gyre, WHOLE, 1.0, {}),
    "zoom 1e5": (gyre, straight(1e5), 1.0, {}),
    "curved": (torus, ASIDE, 1.0, {}),
    "between two steps": (swinging, straight(1, (0, 0)), 1.0, {}),
    "after many turns": (swinging, straight(1, (0, 0)), 1.0, {"time": 1e7 + 0.55}),
    "streamlines": (swinging, straight(1, (0, 0)), 1.0, {"lines": "streamlines"}),
    "image": (gyre, WHOLE, 1.0, {"noise": "image", "tiles": 3}),
    "noise texture": (gyre, WHOLE, 1.0, {"noise": "texture", "resolution": 64, "grain": 2.0}),
    "streaming": (gyre, WHOLE, 1.0, {"motion": "uniform", "period": 3.0}),
    "without a sign": (lines, WHOLE, 1.0, {"kernel": "ramp", "two_sided": False}),
    "streaklets": (gyre, WHOLE, 1.0, {"texture": "streaklets", "two_sided": False}),
    "finer": (gyre, WHOLE, 2.0, {"motion": "speed", "kernel": "box", "arrows": True}),
    "finer image": (gyre, WHOLE, 2.0, {"noise": "image", "tiles": 3}),
    "coarser": (gyre, WHOLE, 0.4, {"grain": 1.2}),
}


def uniforms_of(name: str) -> dict[str, Any]:
    make, camera, density, given = VIEWS[name]
    options = {key: value for key, value in given.items() if key != "time"}
    settings = Settings(**{"samples": 11, **options})
    image = as_picture(IMAGE) if settings.noise == "image" else None
    store = SliceStore(make(), lines=options.get("lines", "pathlines"))
    textures = TextureSet.build(store, image)
    if settings.noise == "texture":
        textures = textures.with_noise(settings.resolution, settings.seed)
    view = ViewState(
        focus=np.asarray(camera.focal_point, dtype=float),
        anchor=np.array([0.1, 0.2, 0.0]),
        eye=np.asarray(camera.eye, dtype=float),
        between=0.375,
        time=given.get("time", 0.55),
        clock=7.3,
        density=density,
    )
    header = ClientData(textures).header(settings)
    if header["image"] is not None:
        header["image"] |= {"alongI": [], "alongJ": []}
    values = uniforms(textures, settings, view)
    return {
        "header": {key: header[key] for key in NEEDED},
        # A browser traces the lags that it draws with, with all mip levels, and has no number of
        # either.
        "view": plain({k: value for k, value in vars(view).items() if k not in PYTHONS}),
        "moving": values.pop("moving"),
        "near": values.pop("near"),
        "sparse": values.pop("sparse"),
        "uniforms": plain(values),
    }


#: Moves one after the other: name and arguments.
MOVES: list[tuple[str, list[float]]] = [
    ("zoom", [1.25, 0.3, -0.2]),
    ("pan", [0.1, -0.25]),
    ("rotate", [0.3, 0.2]),
    ("zoom", [40.0, -0.5, 0.4]),
    ("rotate", [-0.7, -0.1]),
    ("pan", [-0.4, 0.3]),
    ("zoom", [1e-3, 0.1, 0.1]),
    ("zoom", [1e12, 0.0, 0.0]),
]


def moved(camera: Camera, whole: Camera, aspect: float, move: tuple[str, list[float]]) -> Camera:
    name, (x, y, *rest) = move
    if name == "zoom":
        return zoom_by(camera, x, y, *rest, aspect=aspect, whole=whole)
    return pan(camera, x, y, aspect) if name == "pan" else rotate(camera, x, y, aspect)


def camera_of(name: str) -> dict[str, Any]:
    field, aspect = (gyre(9, 5), 1.5) if name == "flat" else (strip(), 2.3)
    data = ClientData(Scene(field).textures)
    whole = camera = Camera.fit(field.surface, aspect)
    states = [camera := moved(camera, whole, aspect, move) for move in MOVES]
    points = field.points.reshape(-1, 3)[::7]
    header = data.constants()
    return {
        "geometry": header["geometry"],
        "limits": header["limits"],
        "nodes": plain(data.surface()["position"].ravel()[: 3 * field.valid.size]),
        "aspect": aspect,
        "fit": whole.to_dict(),
        "moves": [{"name": name, "values": values} for name, values in MOVES],
        "states": [state.to_dict() for state in states],
        "points": plain(points),
        "places": plain(whole.project(points, aspect)),
        "ray": plain(np.stack(whole.ray(0.4, -0.3, aspect))),
    }


def plain(value: Any) -> Any:
    """Return numbers as Python's own."""
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def check(name: str, expected: Any) -> None:
    path = FOLDER / name
    if os.environ.get("FLOWTEX_WRITE_FIXTURES"):
        path.write_text(json.dumps(expected, separators=(",", ":")) + "\n", encoding="utf-8")
    assert_near(json.loads(path.read_text(encoding="utf-8")), json.loads(json.dumps(expected)))


def assert_near(found: Any, expected: Any, where: str = "") -> None:
    if isinstance(expected, dict):
        assert set(found) == set(expected), where
        for key, value in expected.items():
            assert_near(found[key], value, f"{where}.{key}")
    elif isinstance(expected, list):
        assert len(found) == len(expected), where
        for n, value in enumerate(expected):
            assert_near(found[n], value, f"{where}[{n}]")
    elif isinstance(expected, float):
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-12), where
    else:
        assert found == expected, where


def test_uniforms_for_the_client() -> None:
    check("uniforms.json", {name: uniforms_of(name) for name in VIEWS})


def seeds_of(
    field: FlowField, eye: Any, half: float, middle: tuple[float, float]
) -> dict[str, Any]:
    """Seeds of a view down onto a place, along parallel rays or from an eye."""
    geometry = TextureSet.build(SliceStore(field)).geometry
    seeds = ArrowSeeds(geometry)
    sides = [
        np.array([sign * (axis == k) for k in range(3)]) for axis in (0, 1) for sign in (1, -1)
    ]
    if eye is None:
        planes = [[*s, half - s[:2] @ middle] for s in sides]
    else:
        planes = [[*(n := s - [0, 0, half]), -n @ eye] for s in sides]
    view = TileView(None if eye is None else np.array(eye), half, 90.0, np.array(planes))
    seen = seeds.seen(view, 20.0)
    order = np.lexsort((seen.radius, seen.cell))
    frame = {"center": geometry.center, "extent": geometry.extent, "frame": geometry.frame.ravel()}
    return {
        "surface": {
            "geometry": frame,
            "nodes": geometry.at_vertices(geometry.position).astype(float).ravel(),
            "corners": seeds.corners.ravel(),
        },
        "view": {"eye": view.eye, "halfHeight": half, "pixels": 90.0, "planes": view.planes},
        "seeds": [
            [int(seen.cell[n]), *seen.place[n].tolist(), float(seen.radius[n])] for n in order
        ],
    }


def test_seeds_of_arrows_for_the_client() -> None:
    points, triangles = random_plane(np.random.default_rng(5), 60)
    scattered = FlowField.from_triangles(points, triangles, np.ones_like(points) * [1, 0.5, 0])
    cases = [
        seeds_of(gyre(13, 7), None, 0.5, (1.0, 0.5)),
        seeds_of(gyre(13, 7), None, 1e-4, (0.63, 0.37)),
        seeds_of(strip(), (1.2, 0.1, 2.0), 0.3, (0, 0)),
        seeds_of(scattered, None, 0.02, (0.4, 0.6)),
    ]
    check("seeds.json", {"limits": seed_limits(), "spacing": 20.0, "cases": plain(cases)})


#: Settings on which the mean colours of a picture depend.
SHADINGS: list[dict[str, Any]] = [{}, {"strength": 1.0}, {"contrast": 3.0}, {"strength": 0.0}]


def test_mean_colours_for_the_client() -> None:
    table = colour_table("viridis")[::51]
    shading = ClientData(Scene(gyre()).textures).constants()["constants"]["shading"]
    cases = [
        {
            "settings": dict(settings := Settings(**options)),
            "colours": table[:, :3].tolist(),
            "means": mean_colours(table, settings)[:, :3].tolist(),
        }
        for options in SHADINGS
    ]
    check("colours.json", {"shading": shading, "cases": cases})


def earth_of(name: str) -> dict[str, Any]:
    """A flow on a map of the Earth: coasts, and places with their longitude and latitude."""
    projection = Projection(name, center=(178.0, -40.0))
    lon, lat = np.meshgrid(np.linspace(168, 188, 9), np.linspace(-47, -33, 8))
    points = projection.positions(lon, lat)
    velocity = projection.vectors(lon, lat, 0 * lon + 2, 0 * lon - 1)
    data = ClientData(
        Scene(FlowField.from_arrays(points, velocity, projection=projection)).textures
    )
    geometry, parts = data.textures.geometry, data.surface()
    lines = map_lines(data.field, has_globe=False)["coastlines"]
    part = parts["coastlines"][:40]
    starts = lines.starts[:-1][lines.starts[:-1] < len(part)]
    local = (lines.points[: len(part)] - geometry.center) @ geometry.frame.T
    few = MapLines(local, np.append(starts, len(part)))
    places = [points[1, 2] * 0.6 + points[2, 3] * 0.4, points[6, 1]]
    grid = parts.get("lonlat")
    return {
        "earth": data.constants()["earth"],
        "steps": part.ravel().tolist(),
        "points": plain(few.points),
        "thinned": plain(few.thinned(5000.0).points),
        "starts": starts.tolist(),
        "lonlat": None if grid is None else {"shape": grid.shape, "data": plain(grid.ravel())},
        "positions": plain(np.array(places)),
        "expected": plain(np.stack(projection.lonlat(np.array(places)), axis=-1)),
        "vector": plain(velocity[1, 2]),
        "at": plain(points[1, 2]),
    }


#: Date at time 0, seconds between two steps, and a time.
MOMENTS = [
    (datetime(2002, 1, 1), 86400.0, 172800.0),
    (datetime(2002, 1, 1), 86400.0, 100000.0),
    (datetime(2002, 1, 1, 6), 86400.0, 86400.0),
    (datetime(1999, 12, 31, 23, 59, 30), 10.0, 45.0),
    (datetime(1582, 10, 4), 3600.0, 7200.0),
]


def test_the_earth_for_the_client(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.rendering.webgl.earth.LONLAT_PLACES", 9)
    dates = [
        {
            "start": start.isoformat(),
            "step": step,
            "time": time,
            "text": date_text(start, time, step),
        }
        for start, step, time in MOMENTS
    ]
    maps = {name: earth_of(name) for name in ("globe", "platecarree")}
    check("earth.json", {"maps": maps, "dates": dates})


def test_cameras_for_the_client() -> None:
    check("camera.json", {name: camera_of(name) for name in ("flat", "curved")})


def test_the_client_gets_the_limits_of_the_camera() -> None:
    limits = ClientData(Scene(gyre()).textures).constants()["limits"]
    assert {name: limits[name] for name in vars(CAMERA_LIMITS)} == vars(CAMERA_LIMITS)


def name_of(key: TileKey | None) -> str:
    """Name of a tile in the client."""
    return "" if key is None else "/".join(map(str, key))


#: Where the eye is, half the height of what is seen, and the sides of it as (axis, sign, limit).
Look = tuple[Any, float, list[tuple[int, int, float]]]
LOOKS: list[Look] = [
    (None, 0.6, []),
    (None, 0.05, [(0, 1, 0.4), (0, -1, 0.55), (1, 1, 0.3), (1, -1, 0.4)]),
    (np.array([0.7, -0.2, 0.15]), 0.27, [(1, 1, 0.05)]),
]


def asked(
    pyramid: Pyramid, look: Look, rng: np.random.Generator, cell_pixels: float
) -> dict[str, Any]:
    """Return what a view asks for, and what is shown while some of it is not ready."""
    eye, half, sides = look
    planes = np.array([[s * (k == a) for k in range(3)] + [-s * at] for a, s, at in sides])
    view = TileView(eye, half, 500.0, planes.reshape(-1, 4), cell_pixels)
    chosen = choose_tiles(pyramid, view)
    ready = {key for key in chosen if key is None or rng.random() < 0.7}
    shown = cover(chosen, ready.__contains__)
    return {
        "view": {"eye": plain(eye), "halfHeight": half, "pixels": 500.0}
        | {"planes": plain(view.planes), "cellPixels": cell_pixels},
        "chosen": {
            name_of(key): [c.needed, [name_of(child) for child in c.finer]]
            for key, c in chosen.items()
        },
        "wanted": [name_of(key) for key in wanted_tiles(chosen)],
        "ready": sorted(map(name_of, ready)),
        "shown": {name_of(key): list(map(name_of, some)) for key, some in shown.items()},
    }


def tiled(seed: int) -> dict[str, Any]:
    """Tiles of a surface that some views ask for, and that are shown in part."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:1:260j, 0:1.6:401j]
    points = np.stack([x, y, 0.1 * np.sin(4 * x)], axis=-1)
    field = FlowField.from_arrays(points, np.ones((260, 401, 3)), periodic="i")
    pyramid = GridPyramid(field)
    data = ClientData(Scene(field).textures, pyramid=pyramid)
    views = [asked(pyramid, look, rng, 2.0) for look in LOOKS]
    return {
        "pyramid": data.constants()["pyramid"],
        "places": plain(data.surface()["places"].astype(float).ravel()),
        "views": views,
    }


def tiled_triangles(seed: int) -> dict[str, Any]:
    """Tiles of triangles that some views ask for."""
    rng = np.random.default_rng(seed)
    points, triangles = random_plane(rng, 700, grading=4)
    velocity = np.ones_like(points) * [1, 0.5, 0]
    field = FlowField.from_triangles(points, triangles, velocity)
    pyramid = TrianglePyramid(field)
    geometry = pyramid.root_geometry
    data = ClientData(TextureSet(geometry, SliceStore(pyramid.root)), pyramid=pyramid)
    places = data.surface()["places"].astype(float)
    return {
        "pyramid": data.constants()["pyramid"],
        "places": plain(np.nan_to_num(places, neginf=-1e30).ravel()),
        "views": [asked(pyramid, look, rng, 16.0) for look in LOOKS],
    }


def test_tiles_of_triangles_for_the_client(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 150)
    expected = tiled_triangles(1)
    assert expected["pyramid"]["depth"] > 1
    assert any(len(view["shown"]) > 1 for view in expected["views"])
    check("triangles.json", expected)


def test_tiles_for_the_client(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 5000)
    expected = tiled(1)
    assert all(len(view["shown"]) > 1 for view in expected["views"])
    check("tiles.json", expected)


PICTURE_SIZE = (300, 200)  #: Pixels of a picture in which samples are looked for.
#: Place (j, i), camera and settings.
SAMPLED: dict[str, tuple[tuple[float, float], Camera, dict[str, Any]]] = {
    "whole": ((2.3, 5.6), WHOLE, {"samples": 9}),
    "near": ((2.4, 2.7), straight(30), {"samples": 15, "seed": 7, "contrast": 2.0}),
    "one side": ((1.2, 6.1), WHOLE, {"kernel": "ramp", "two_sided": False, "samples": 6}),
    "streaklets": ((1.2, 6.1), WHOLE, {"texture": "streaklets", "samples": 31}),
    "ramp": ((1.2, 6.1), WHOLE, {"kernel": "ramp", "grain": 2.0, "spacing": 0.5}),
    "box to the border": ((0.4, 6.1), WHOLE, {"kernel": "box", "samples": 31}),
    "no level of detail": ((2.3, 5.6), straight(4), {"lod": False, "samples": 7}),
    "tilted": ((2.3, 5.6), TILTED, {"samples": 7}),
    "fading": ((2.3, 3.6), WHOLE, {"samples": 9, "fade": 1.0}),
}


def bend() -> FlowField:
    """A flow of few nodes whose paths turn so little in a cell that all follow the slices."""
    y, x = np.mgrid[0:1:5j, 0:2:9j]
    velocity = np.stack([1 + 0.3 * y, 0.4 * (x - 0.8), 0 * x], axis=-1)
    return FlowField.from_arrays(np.stack([x, y, 0 * x], axis=-1), velocity)


def samples_of(name: str) -> dict[str, Any]:
    """Return a place of a flow, and what the judge finds there."""
    at, camera, chosen = SAMPLED[name]
    scene = Scene(bend(), Settings(**chosen))
    header = ClientData(scene.textures).header(scene.settings)
    found = probe(scene, at, pixel=camera, size=PICTURE_SIZE)
    needed = (*NEEDED, "limits")
    return {
        "header": {key: header[key] for key in needed},
        "camera": camera.to_dict(),
        "size": PICTURE_SIZE,
        "place": at[::-1],
        "position": plain(found.field_values.position),
        "points": plain(found.points),
        "lags": plain(found.lags),
        "weights": plain(found.weights),
        "greys": plain(found.greys),
        "noise": plain(found.noise),
        "level": found.level,
        "gain": found.gain,
        "value": plain(found.value),
    }


def parts_of(data: ClientData) -> dict[str, Any]:
    """Return the arrays that a path is followed with."""
    arrays = {**data.surface(), **data.step(0)}
    return {
        name: {"shape": arrays[name].shape, "data": plain(_numbers(arrays[name]))}
        for name in ("position", "slices/0", "extra/0")
        if name in arrays
    }


def _numbers(array: Any) -> Any:
    return (array.view(np.uint16) if array.dtype == np.float16 else array).ravel()


def noise_of(seed: int) -> list[dict[str, Any]]:
    """Return values of the noise at some points, in a plane and in space."""
    rng = np.random.default_rng(seed)
    scene = Scene(gyre(9, 5), Settings(seed=seed))
    focus = np.array([0.7, 0.2, 0.0])
    view = ViewState(focus)
    values = uniforms(scene.textures, scene.settings, view)
    names = [name for name in values if name.startswith("u_noise")]
    told = {name: plain(values[name]) for name in [*names, "u_seed"]}
    cases = []
    for number in (3, 20, 41):
        point, moved = rng.normal(size=(2, 1, 3))
        here = point - np.asarray(values["u_noiseOrigin"])
        for planar in (True, False):
            both = [
                octave(
                    noise_lattice(here, np.array([number + n]), values), moved, None, planar=planar
                )
                for n in (0, 1)
            ]
            cases.append(
                {"uniforms": told, "point": plain(point[0]), "moved": plain(moved[0])}
                | {"octave": number, "planar": planar, "values": plain(np.concatenate(both))}
            )
    return cases


def test_samples_for_the_client() -> None:
    sums = {name: samples_of(name) for name in SAMPLED}
    parts = parts_of(ClientData(Scene(bend()).textures))
    check("samples.json", {"parts": parts, "sums": sums, "noise": noise_of(5)})


def test_trees_of_the_fixed_points() -> None:
    """Cases of fixed points, with the trees that the client computes them from."""
    path = Path(__file__).parents[1] / "trace" / "formula_cases.json"
    cases = json.loads(path.read_text(encoding="utf-8"))
    for case in cases:
        ends = {"x": case["x"], "y": case["y"], "resolution": 9}
        made = flowtex.formula(*case.pop("rates"), **ends, **case["parameters"]).formula
        assert made is not None
        case |= {"trees": [each.tree for each in made.expressions]}
        case |= {"gradient": gradient_trees(made)}
    check("fixedpoints.json", cases)


def test_what_a_formula_gives() -> None:
    """Values of trees, and the numbers of a tile that is computed from a formula."""
    values = {"x": -1.7, "y": 0.6, "b": 0.2}
    calls = {name: OPERATIONS[name] for name in FUNCTIONS}
    texts = [f"{name}({'x, y, b'[: 3 * (count or 2) - 2]})" for name, (_, count) in calls.items()]
    texts += [
        "-x^2/y - b + 2*x",
        "(x < y) + (x > y)*3 + (x <= b) - (b >= y)",
        "pi*e",
        "min(x, y, b)",
    ]
    trees = [parse(text, values) for text in texts]
    with np.errstate(all="ignore"):
        results = [float(evaluate(tree, values)) for tree in trees]
    ends: Any = {"x": (-8, 8), "y": (-4, 4), "b": (0.2, 0, 1)}
    field = flowtex.formula("y", "-sin(x) - b*y", **ends)
    textures = TextureSet.build(SliceStore(field))
    data = ClientData(textures, traces=True, marks=Marks(shared_structure(field)))
    header = data.header(Settings())
    parts = ("geometry", "slices", "formula", "pyramid", "mesh", "speed", "scalars")
    others = ("settings", "structure")
    fine = flowtex.formula("y", "-sin(x) - b*y", resolution=513, **ends)
    pyramid = GridPyramid(fine, nodes=(257, 513), depth=1)
    tile = pyramid.textures(TileKey(0, 0, 1))
    assert tile is not None
    velocity = np.asarray(velocity_part(data.textures, 0), float)
    whole, own = header["pyramid"], ClientData(tile, traces=True).tile_header
    check(
        "formula.json",
        {
            "trees": [trees, values, [None if np.isnan(r) else r for r in results]],
            "header": {**{name: header[name] for name in (*parts, *others)}, "pyramid": whole},
            "velocity": velocity[::20, ::32].tolist(),
            "tile": own,
            "critical": [[p.kind, *p.position[:2].tolist()] for p in critical_points(fine)],
            "separatrices": [
                [p.forward, *p.points[0, :2].tolist(), *p.points[-1, :2].tolist()]
                for p in separatrices(fine, length=DRAWN_EXTENTS * fine.surface.extent)
            ],
            "places": pyramid.places(0)[1, [0, 5]].tolist(),
        },
    )
