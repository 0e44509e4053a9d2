"""What property tests draw: small fields of any kind, settings, and what a stranger may send.

In the suite every test draws the same few examples each time. ``make fuzz`` draws
``FLOWTEX_FUZZ`` times as many, and others each time.
"""

from __future__ import annotations

import os
import warnings
from typing import Any

import hypothesis
import numpy as np
from hypothesis import HealthCheck, Phase
from hypothesis import strategies as st
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.settings import TABLE

Array = NDArray[Any]
Strategy = st.SearchStrategy[Any]

FACTOR = int(os.environ.get("FLOWTEX_FUZZ", "0"))

#: Sizes of numbers, from where squares underflow to where they overflow.
SIZES = [1.0, 1.0, 1.0, 1e-12, 1e-6, 1e6, 1e12]
EXTREMES = [0.0, 5e-324, 1e-300, 1e-160, 1e-40, 1e-20, 1e20, 1e40, 1e150, 1e160, 1e300]
MISSING = [np.nan, np.nan, np.nan, np.inf, 0.0]
BAD = [np.nan, np.inf, -np.inf, 1e300, -1e30, 9.96921e36, 0.0]


def property_test(examples: int, *, fuzz: int = 0, steps: int = 50) -> hypothesis.settings:
    """Return the decorator of a test that takes a third as many examples in the suite.

    ``make fuzz`` multiplies them, or ``fuzz`` where the suite has time for few. ``steps`` is the
    greatest number of steps of a state machine. See ``case_counts.py`` for counting the cases.
    """
    return hypothesis.settings(
        max_examples=max(examples, fuzz) * FACTOR or (examples + 2) // 3,
        derandomize=not FACTOR,
        database=None,
        deadline=None,
        print_blob=bool(FACTOR),
        phases=[Phase.explicit, Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
        stateful_step_count=steps,
    )


def _surface(kind: str, shape: tuple[int, int], rng: np.random.Generator) -> Array:
    """Nodes of a surface of a kind, (J, I, 3)."""
    v, u = np.meshgrid(*(np.linspace(0, 1, n) for n in shape), indexing="ij")
    turn, tilt = 2 * np.pi * u, np.pi * v
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * u], axis=-1)
    match kind:
        case "sphere":
            points = ring * np.sin(tilt)[..., None]
            points[..., 2] = np.cos(tilt)
        case "disc":
            points = ring * v[..., None]
        case "tube":
            points = ring + np.stack([0 * v, 0 * v, v], axis=-1)
        case "map":
            points = np.stack([360 * u, 160 * v - 80, 0 * u], axis=-1)
        case "wave":
            points = np.stack([u, v, 0.3 * np.sin(turn)], axis=-1)
        case "stretched":
            points = np.stack([10.0 ** (-12 * u), v**4, 0 * u], axis=-1)
        case "folded":
            points = np.stack([np.abs(u - 0.5), v, 0 * u], axis=-1)
        case "wedge":
            points = np.stack([u * v, v, 0 * u], axis=-1)
        case "line":
            points = np.stack([u + v, u + v, 0 * u], axis=-1)
        case "point":
            points = np.zeros((*shape, 3))
        case "random":
            points = rng.normal(size=(*shape, 3))
        case _:
            points = np.stack([u, v, 0 * u], axis=-1)
    return points


SURFACES = ["plane", "wave", "sphere", "disc", "tube", "map", "stretched", "folded", "wedge"]
SURFACES += ["random", "line", "point"]
VELOCITIES = ["random", "uniform", "vortex", "rest", "sparse", "normal", "spread", "one"]


def _velocity(kind: str, points: Array, steps: int | None, rng: np.random.Generator) -> Array:
    """Velocity of a kind at nodes (J, I, 3), (J, I, 3) or (T, J, I, 3)."""
    shape = points.shape if steps is None else (steps, *points.shape)
    result: Array = np.zeros(shape)
    match kind:
        case "random":
            result = rng.normal(size=shape)
        case "uniform":
            result[:] = [1.0, 0.5, 0.0]
        case "vortex":
            middle = points - points.mean(axis=(0, 1))
            result[:] = np.cross([0, 0, 1.0], middle)
        case "sparse":
            result = rng.normal(size=shape) * (rng.random(shape[:-1]) < 0.3)[..., None]
        case "normal":
            result[..., 2] = 1.0
        case "spread":
            exponent = rng.integers(-20, 20, shape[:-1])[..., None]
            result = rng.normal(size=shape) * 10.0**exponent
        case "one":
            result.reshape(-1)[rng.integers(0, max(result.size, 1)) :][:1] = 1.0
    return result


SOUND_TYPES = [float] * 6 + [np.float32, np.int64]
TYPES = [float] * 8 + [np.float32, np.float16, np.int64, np.uint8, bool, complex, object, str]


def _as_type(array: Array, kind: Any) -> Array:
    if np.dtype(kind).kind in "iub":
        array = np.nan_to_num(array).clip(-33, 33) * 3
    with np.errstate(all="ignore"):
        result: Array = array.astype(kind)
    return result


@st.composite
def _damaged(draw: Any, array: Array, *, wild: bool, most: int = 3) -> Array:
    """Replace some numbers, hide some, and change the type."""
    result: Array = np.array(array, dtype=float)
    places = st.integers(0, max(result.size - 1, 0))
    damage = draw(
        st.lists(st.tuples(places, st.sampled_from(BAD if wild else MISSING)), max_size=most)
    )
    for place, value in damage if result.size else ():
        result.reshape(-1)[place] = value
    result = _as_type(result, draw(st.sampled_from(TYPES if wild else SOUND_TYPES)))
    if draw(st.integers(0, 7)) == 7 and result.dtype.kind in "fiu":
        hidden = np.random.default_rng(draw(st.integers(0, 9))).random(result.shape) < 0.1
        return np.ma.masked_array(result, mask=hidden)
    return result


@st.composite
def field_arguments(draw: Any, *, wild: bool = False) -> dict[str, Any]:
    """Arguments of ``FlowField.from_arrays``; most make a field, unless they are ``wild``."""
    pick = st.sampled_from
    rng = np.random.default_rng(draw(st.integers(0, 2**16)))
    side = st.integers(1 if wild else 2, 8)
    shape = draw(st.tuples(side, side))
    sign_free = draw(pick([False, False, False, True]))
    steps = draw(pick([None, 1] if sign_free and not wild else [None, None, 1, 2, 3, 4]))
    if wild and draw(st.integers(0, 5)) == 5:
        steps = 0
    points = _surface(draw(pick(SURFACES if wild else SURFACES[:-2])), shape, rng)
    velocity = _velocity(draw(pick(VELOCITIES)), points, steps, rng)
    if draw(st.integers(0, 4)) == 4:
        # Some nodes at the place of others.
        place = points.reshape(-1, 3)
        place[rng.integers(0, len(place), 3)] = place[rng.integers(0, len(place), 3)]
    with np.errstate(all="ignore"):
        points = (points + draw(pick([0.0] * 6 + [1.0, -1e6, 1e12]))) * draw(pick(SIZES))
        velocity = velocity * draw(pick(SIZES * 4 + EXTREMES))
        if wild and draw(st.integers(0, 9)) == 9:
            points = points * draw(pick(EXTREMES))
    arguments: dict[str, Any] = {
        "points": draw(_damaged(points[..., : draw(pick([3, 3, 2]))], wild=wild)),
        "velocity": draw(_damaged(velocity[..., : draw(pick([3, 3, 2]))], wild=wild)),
        "periodic": draw(pick([None, None, None, "", "i", "j", "ij", "k"][: 8 if wild else 7])),
        "sign_free": sign_free,
    }
    if draw(st.booleans()):
        first, step = draw(pick([0.0, 1.0, -5.0, 1e9])), draw(pick([*SIZES, 1e-300, 1e300]))
        count = 1 if steps is None else steps
        even = draw(pick([True, True, False]))
        with np.errstate(all="ignore"):
            times = first + step * (np.arange(count) if even else np.cumsum(rng.random(count)))
        arguments["times"] = draw(_damaged(times, most=1, wild=wild)) if wild else times
    if draw(st.integers(0, 3)) == 3:
        arguments["valid"] = rng.random(shape) < draw(pick([0.3, 0.9, 0.9]))
    if draw(st.integers(0, 3)) == 3:
        values = rng.normal(size=shape) * draw(pick(SIZES + EXTREMES))
        arguments["scalars"] = {"s": draw(_damaged(values, wild=wild))}
    return arguments


def field_of(arguments: dict[str, Any]) -> FlowField | None:
    """Make a field, or return None where that is refused with a sentence."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "The velocity is zero")
        try:
            return FlowField.from_arrays(**arguments)
        except FieldError as error:
            assert " expected " in str(error) or "; " in str(error), error
            assert len(str(error)) < 2000
            return None


def setting_values(*, resolution: int = 64, samples: int = 30) -> Strategy:
    """Values of some settings that are right, of small textures and few samples."""
    most = {"resolution": resolution, "samples": samples}
    kinds: dict[str, Strategy] = {}
    for name, row in TABLE.items():
        high = min(row.high or 1, most.get(name, row.high or 1))
        if row.kind is bool:
            kinds[name] = st.booleans()
        elif row.choices:
            kinds[name] = st.sampled_from([c for c in row.choices if c != "image"])
        elif row.kind is int:
            kinds[name] = st.integers(int(row.low or 0), int(high))
        else:
            kinds[name] = st.floats(row.low, high)
    return st.fixed_dictionaries({"resolution": kinds.pop("resolution")}, optional=kinds)


def links() -> st.SearchStrategy[str]:
    """Links of any text, and of names that mean something with any values."""
    names = st.sampled_from(["file", "plane", "time", "colour", "clim", "camera", "split", *TABLE])
    words = ["on", "1e999", "%00", "\ud800", "k=2", "-1,1", "parallel,0,0,9,0,0,0,0,1,0,1,30"]
    values = st.text(max_size=20) | st.floats().map(repr) | st.sampled_from(words)
    pairs = st.lists(st.tuples(names, values).map("=".join), max_size=5)
    return st.text() | pairs.map("&".join)


def junk() -> Strategy:
    """Anything that a page may send: JSON, numbers that JSON has not, and bytes."""
    numbers = st.one_of(
        st.integers(), st.floats(), st.sampled_from([10**400, -(10**400), 1e308, -0.0, 2**63])
    )
    words = st.sampled_from([*TABLE, "speed", "on", "nan", "1e999", "k=2", "parallel", "\ud800"])
    leaves = st.one_of(
        st.none(), st.booleans(), numbers, st.text(max_size=20), words, st.binary(max_size=9)
    )
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            st.lists(inner, max_size=4),
            st.dictionaries(st.text(max_size=8) | words, inner, max_size=4),
        ),
        max_leaves=8,
    )
