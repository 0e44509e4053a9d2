"""The compiled integrator follows the same paths as that of NumPy, which is its judge."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

from flowtex import FlowField, Settings, TraceSlices, trace
from flowtex._util import compiled
from flowtex._util.array_types import AnyArray, Floats
from flowtex.examples import airfoil_field, cylinder_field, double_gyre_field, vortex_field
from flowtex.textures import TextureSet
from flowtex.trace import SliceStore
from flowtex.trace.lags import choose_lags


@pytest.fixture(scope="module")
def kernels() -> Any:
    pytest.importorskip("numba")
    if not compiled._loaded:
        compiled._load()
    return compiled._loaded[0]


@pytest.fixture(autouse=True)
def nothing_ready(monkeypatch: pytest.MonkeyPatch) -> None:
    """Begin each test in a process that has not compiled anything."""
    monkeypatch.setattr(compiled, "_loaded", [])
    monkeypatch.setattr(compiled, "_paths", [0])
    monkeypatch.setattr(compiled, "_begun", threading.Lock())


def both(kernels: Any, field: FlowField, **options: object) -> tuple[TraceSlices, TraceSlices]:
    """Integrated paths by NumPy and compiled."""
    lags = choose_lags(field, "arclength" if field.steady else "time")[-5:]
    arguments: dict[str, object] = {"lags": lags, "compose": False, **options}
    by_numpy = trace(field, **arguments)  # type: ignore[arg-type]
    compiled._loaded.append(kernels)
    result = trace(field, **arguments)  # type: ignore[arg-type]
    compiled._loaded.clear()
    return by_numpy, result


def plane(rows: int, columns: int) -> Floats:
    return np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).astype(float)


def holed() -> FlowField:
    """A rotation on a plane with a hole."""
    p = plane(40, 50)
    valid = np.hypot(*np.moveaxis(p - [30, 15], -1, 0)) > 4
    return FlowField.from_arrays(p, (p - [24.5, 19.5])[..., ::-1] * [-1, 1], valid=valid)


def torus() -> FlowField:
    """A wind over a surface that closes along both axes and varies in time."""
    i, j = np.meshgrid(*(np.linspace(0, 2 * np.pi, n) for n in (61, 41)))
    around = 3 + np.cos(j)
    p = np.stack([around * np.cos(i), around * np.sin(i), np.sin(j)], axis=-1)
    east = np.stack([-np.sin(i), np.cos(i), 0 * i], axis=-1)
    north = np.stack([-np.sin(j) * np.cos(i), -np.sin(j) * np.sin(i), np.cos(j)], axis=-1)
    v = np.stack([east, east + north, north])
    return FlowField.from_arrays(p, v, times=[0.0, 2.0, 5.0])


FIELDS: dict[str, tuple[Callable[[], FlowField], dict[str, object]]] = {
    "gyre by length": (lambda: double_gyre_field(shape=(41, 81)), {}),
    "gyre by time": (lambda: double_gyre_field(shape=(41, 81)), {"parameter": "time", "unit": 3.0}),
    "gyre that varies": (lambda: double_gyre_field(True, shape=(21, 41)), {"steps": [3, 9]}),
    "cylinder": (cylinder_field, {"steps": [20]}),
    "vortex": (vortex_field, {"steps": [0, 30]}),
    "O-grid": (lambda: airfoil_field((40, 61)), {}),
    "hole": (holed, {}),
    "torus, uneven steps": (torus, {}),
}


@pytest.mark.parametrize("name", FIELDS)
def test_paths_are_those_of_numpy(kernels: Any, name: str) -> None:
    make, options = FIELDS[name]
    one, two = both(kernels, make(), **options)
    for a, b in ((one.displacement, two.displacement), (one.forward, two.forward)):
        if a is not None and b is not None:
            apart = np.abs(a - b).max(axis=-1)
            near = apart <= 1e-6 * (1 + np.abs(a).max(axis=-1))
            # Beside a critical point or a border, rounding decides where a path goes.
            assert near.mean() > 0.999
    same = np.isclose(one.reach, two.reach, rtol=1e-4)
    assert same.mean() > 0.999


def test_a_rotation_is_followed_exactly(kernels: Any) -> None:
    """Bilinear velocity is a rotation itself, so that both are wrong by their steps alone."""
    p = plane(41, 41) - 20
    field = FlowField.from_arrays(p, p[..., ::-1] * [-1, 1])
    inside = np.hypot(p[..., 0], p[..., 1]) < 19
    turned = np.stack([p[..., 1], -p[..., 0]], axis=-1)  # by a quarter, backward
    for slices in both(kernels, field, lags=[np.pi / 2], parameter="time"):
        error = np.abs(slices.displacement[0, 0] - (turned - p))[inside]
        assert error.max() < 0.02


def test_a_path_ends_at_the_border(kernels: Any) -> None:
    p = plane(11, 21)
    field = FlowField.from_arrays(p, np.broadcast_to([1.0, 0.0], p.shape))
    for slices in both(kernels, field, lags=[1.0, 30.0]):
        np.testing.assert_allclose(slices.reach[0], p[..., 0], atol=1e-4)
        np.testing.assert_allclose(slices.displacement[0, 1, ..., 0], -30.0, rtol=1e-6)


def test_paths_that_go_round_and_round_are_ended(kernels: Any) -> None:
    """After as many steps, compiled as by NumPy, though not at the same last step of all."""
    p = plane(4, 4) - 1.5
    field = FlowField.from_arrays(p, p[..., ::-1] * [-1, 1])
    one, two = both(kernels, field, lags=[1.0, 1e6], parameter="time")
    inside = np.hypot(p[..., 0], p[..., 1]) < 1
    assert (one.reach[0][inside] < 1e4).all()
    np.testing.assert_allclose(two.reach[0], one.reach[0], rtol=1e-3)


@pytest.mark.parametrize("step", [1e-6, 1.0])
def test_before_the_first_time_step_steps_are_long(kernels: Any, step: float) -> None:
    """A path that had to keep to the time steps would be ended after a thousand of them."""
    p = plane(9, 9) - 4
    steps = np.stack([p[..., ::-1] * [-1, 1]] * 3)
    field = FlowField.from_arrays(p, steps, times=step * np.arange(3.0))
    inside = np.hypot(p[..., 0], p[..., 1]) < 3.5
    turned = np.stack([p[..., 1], -p[..., 0]], axis=-1)  # by a quarter, backward
    for slices in both(kernels, field, lags=[np.pi / 2], steps=[2]):
        assert np.isinf(slices.reach[0][inside]).all()
        error = np.abs(slices.displacement[0, 0] - (turned - p))[inside]
        assert error.max() < 0.02


def test_a_path_goes_no_further_than_single_precision(kernels: Any) -> None:
    p = plane(4, 4) - 1.5
    field = FlowField.from_arrays(p, p[..., ::-1] * [-1, 1] + 1e40)
    one, two = both(kernels, field, lags=[1.0, 2.0], parameter="time")
    assert np.isfinite(one.displacement).all()
    np.testing.assert_allclose(two.displacement, one.displacement, rtol=1e-3)


def triangles(kind: str) -> FlowField:
    """A field on random triangles: a sphere, or a square with a hole and nodes at rest."""
    rng = np.random.default_rng(2)
    if kind == "sphere":
        p = rng.normal(size=(1500, 3))
        p /= np.linalg.norm(p, axis=1, keepdims=True)
        v = np.cross([0.2, 0.3, 1.0], p) + 0.5 * np.sin(3 * p[:, [1, 2, 0]])
        return FlowField.from_triangles(p, ConvexHull(p).simplices, v)
    p = rng.uniform(-1, 1, (1500, 2))
    v = np.stack([np.sin(3 * p[:, 1]), np.cos(2 * p[:, 0])], axis=-1)
    v[p[:, 0] < -0.8] = 0.0
    valid = np.hypot(p[:, 0], p[:, 1]) > 0.2
    return FlowField.from_triangles(p, Delaunay(p).simplices, v, valid=valid)


@pytest.mark.parametrize("kind", ["sphere", "square"])
@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_paths_on_triangles_are_those_of_numpy(kernels: Any, kind: str, parameter: str) -> None:
    field = triangles(kind)
    one, two = both(kernels, field, parameter=parameter, unit=0.05, lags=[0.3, 2.0, 9.0])
    assert one.forward is not None and two.forward is not None
    assert one.forward_reach is not None and two.forward_reach is not None
    for a, b in ((one.displacement, two.displacement), (one.forward, two.forward)):
        apart = np.abs(a - b).max(axis=-1)
        assert (apart <= 1e-5 * (1 + np.abs(a).max(axis=-1))).mean() > 0.99
    for a, b in ((one.reach, two.reach), (one.forward_reach, two.forward_reach)):
        assert np.isclose(a, b, rtol=1e-4, atol=1e-5).mean() > 0.99
        assert kind == "sphere" or 0.1 < np.isfinite(a).mean() < 0.9


@pytest.mark.parametrize("spread", [1.0, 1e100])
def test_no_rate_leads_out_of_the_nodes(kernels: Any, spread: float) -> None:
    """On a torus with rates of all sizes every position is in some cell."""
    rng = np.random.default_rng(1)
    p = plane(8, 8) * 1e-30
    v = rng.normal(size=(3, 8, 8, 2)) * spread ** rng.uniform(-1, 1, (3, 8, 8, 1))
    field = FlowField.from_arrays(p, v, times=[0.0, 1e-60, 1.0], periodic="ij")
    for slices in both(kernels, field, lags=[1.0, 1e30], steps=[1, 2]):
        assert np.isfinite(slices.displacement).all()


@pytest.mark.parametrize("name", ["gyre by length", "cylinder", "hole", "O-grid"])
def test_composed_paths_and_their_places_are_those_of_numpy(kernels: Any, name: str) -> None:
    field = FIELDS[name][0]()
    one: list[AnyArray] = []
    two: list[AnyArray] = []
    for found in (one, two):
        slices = trace(field, progress=False)
        textures = TextureSet.build(SliceStore(field, slices=slices), Settings())
        found += [slices.displacement, slices.reach, textures.layers()]
        compiled._loaded.append(kernels)
    for a, b in zip(one, two, strict=True):
        assert np.isclose(a, b, rtol=1e-4, atol=1e-4).mean() > 0.999


def test_only_chosen_nodes_are_followed(kernels: Any) -> None:
    field = double_gyre_field(shape=(21, 41))
    nodes = np.zeros(field.shape, bool)
    nodes[3:9, 4:20:3] = True
    one, two = both(kernels, field, nodes=nodes)
    np.testing.assert_allclose(one.displacement, two.displacement, rtol=1e-5, atol=1e-5)
    assert not two.reach[:, ~nodes].any()


def test_what_is_not_compiled_is_left_to_numpy(kernels: Any) -> None:
    compiled._loaded.append(kernels)
    field = double_gyre_field(shape=(11, 21))
    free = FlowField.from_arrays(field.points, field.velocity[0], sign_free=True)
    assert np.isfinite(trace(free).displacement).all()


def test_small_work_does_not_compile() -> None:
    trace(double_gyre_field(shape=(21, 41)), progress=False)
    assert compiled._begun.acquire(blocking=False)


def test_large_work_compiles_once(kernels: Any) -> None:
    thread = compiled.prepare(compiled.LARGE_WORK)
    assert thread is not None
    assert compiled.prepare(compiled.LARGE_WORK) is None
    thread.join()
    assert compiled._loaded == [kernels]


def test_what_was_compiled_before_is_loaded_for_less_work(kernels: Any) -> None:
    if not compiled._is_compiled():
        pytest.skip("numba keeps what it compiles elsewhere: the package's folder is read-only")
    code = (
        "from flowtex._util import compiled as c; c.LONGEST_WAIT_S = 600.0; "
        "c.prepare(c.SOME_WORK - 1); before = c.kernels(); c.prepare(1); "
        "print(before is None, c.kernels() is not None)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "True"]


def test_without_numba_numpy_does_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numba", None)
    monkeypatch.delitem(sys.modules, "flowtex._util.compiled.loops", raising=False)
    monkeypatch.delattr("flowtex._util.compiled.loops", raising=False)
    thread = compiled.prepare(compiled.LARGE_WORK)
    assert thread is not None
    thread.join()
    assert compiled.kernels() is None


def test_a_process_may_end_while_it_compiles() -> None:
    pytest.importorskip("numba")
    code = "from flowtex._util import compiled; compiled.prepare(10**9).join(0.3)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
