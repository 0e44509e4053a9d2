"""Values of any type for every argument: they are accepted, or refused by name."""

from __future__ import annotations

import datetime
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from earth_data import winds

import flowtex
from flowtex._util.arguments import brief
from flowtex._util.colours import colour_table
from flowtex.errors import FieldError
from flowtex.field.options import OF_DATASETS, OF_EARTH, FieldOptions, option_names
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import Scene, make_scenes
from flowtex.settings import TABLE

#: Names within these values, which errors of what has no such name repeat.
NAMES_WITHIN = ("abc", "'a'")
#: One value of each kind that users pass by mistake.
ODD: tuple[Any, ...] = (
    True,
    2,
    1.5,
    10**30,
    "abc",
    b"abc",
    (),
    (1, 2),
    {"a": 1},
    1j,
    np.array(1.0),
    np.array([1, 2]),
    np.float32(2),
    np.datetime64("2002-01-02"),
    datetime.datetime(2002, 1, 2),
    object(),
    int,
    range(3),
)


def plane() -> pv.StructuredGrid:
    """Return a small mesh with a velocity."""
    mesh = pv.ImageData(dimensions=(5, 4, 1)).cast_to_structured_grid()
    mesh["velocity"] = np.tile([1.0, 0.5, 0.0], (mesh.n_points, 1))
    return mesh


def cases() -> Iterator[tuple[Any, str]]:
    """Each argument with data that it is for."""
    mesh = plane()
    for kind in (FieldOptions, Appearance, ViewOptions):
        for name in option_names(kind):
            if name not in OF_EARTH:
                yield mesh, name
    for name in TABLE:
        yield mesh, name
    dataset = winds(np.linspace(0.0, 20.0, 4), np.linspace(40.0, 50.0, 3))
    for name in OF_DATASETS:
        yield dataset, name


@pytest.mark.parametrize("value", ODD, ids=lambda value: type(value).__name__)
def test_a_value_of_another_type_is_accepted_or_refused_by_name(value: object) -> None:
    for data, name in cases():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # notices, such as of steady fields
            try:
                make_scenes(data, Options.split(**{name: value}))
            except (FieldError, ModuleNotFoundError) as error:
                named = (name, brief(value), *NAMES_WITHIN)
                assert any(text in str(error) for text in named)
            except Exception as error:
                pytest.fail(f"{name}={value!r}: {type(error).__name__}: {error}")


def test_names_of_components_and_coordinates_may_be_lists() -> None:
    dataset = winds(np.linspace(0.0, 20.0, 4), np.linspace(40.0, 50.0, 3))
    listed = Scene.of(dataset, vectors=["u", "v"], dims=("lon", "lat"))
    written = Scene.of(dataset, vectors="u,v", dims="lon,lat")
    np.testing.assert_array_equal(listed.field.velocity, written.field.velocity)


def test_none_is_the_default_of_the_appearance() -> None:
    scene = Scene.of(plane(), visible=None, log_scale=None, opacity=None, nan_color=None)
    assert vars(scene.appearance) == vars(Scene.of(plane()).appearance)


#: Functions, an argument of each that is true or false or a function, and what it is called.
FLAGS: tuple[tuple[str, str], ...] = (
    ("trace", "two_sided"),
    ("trace", "compose"),
    ("trace", "progress"),
    ("render", "annotations"),
    ("movie", "annotations"),
    ("movie", "progress"),
    ("movie", "cancelled"),
)


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize(("function", "argument"), FLAGS)
def test_a_flag_of_another_type_is_refused_by_name(
    function: str, argument: str, tmp_path: Path
) -> None:
    field = flowtex.examples.double_gyre_field(shape=(5, 9))
    options: dict[str, Any] = {}
    if function == "movie":
        options = {"path": tmp_path / "gyre.gif", "seconds": 0.2, "size": (32, 24)}
    for value in (np.zeros(3), "abc", 2, [1, 2]):
        with pytest.raises(FieldError, match=rf"^{argument} is .*; expected"):
            getattr(flowtex, function)(field, **options, **{argument: value})


def test_time_steps_that_repeat_are_refused() -> None:
    field = flowtex.examples.double_gyre_field(shape=(5, 9))
    with pytest.raises(FieldError, match=r"steps is .*expected numbers of time steps, each once"):
        flowtex.trace(field, steps=[0, 0])


@pytest.mark.parametrize("cmap", [len, np.zeros(3), [1, 2], {"a": 1}, object()])
def test_a_colour_map_that_is_none_is_refused(cmap: Any) -> None:
    with pytest.raises(FieldError, match=r"colour map|cmap"):
        make_scenes(plane(), Options.split(cmap=cmap))


def test_a_colour_map_of_colours_has_these() -> None:
    table = colour_table(["red", "#00ff00", (0.0, 0.0, 1.0)])[:, :3]
    assert table[0].tolist() == [255, 0, 0]
    assert table[-1].tolist() == [0, 0, 255]
    assert [0, 255, 0] in table.tolist()
