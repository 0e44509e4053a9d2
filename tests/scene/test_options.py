"""Arguments that every way of drawing takes: sorted, checked, and told once."""

from __future__ import annotations

import inspect
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from flows import gyre
from hypothesis import example, given
from hypothesis import strategies as st
from strategies import junk, property_test

import flowtex
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions, option_names
from flowtex.scene.fields import read_field
from flowtex.scene.options import (
    Appearance,
    AppearanceAttribute,
    AppearanceAttributes,
    Options,
    ViewOptions,
)
from flowtex.scene.scene import Scene, lay_image, link_scenes, make_scenes


def test_each_argument_goes_where_it_belongs() -> None:
    options = Options.split(plane="k=2", cmap="magma", zoom=3, samples=7)
    assert options.field == FieldOptions(plane="k=2")
    assert vars(options.appearance) == vars(Appearance.of(cmap="magma"))
    assert options.view == ViewOptions(zoom=3)
    assert options.settings == {"samples": 7}


@pytest.mark.parametrize(
    "function",
    [flowtex.render, flowtex.show, flowtex.movie, flowtex.export, flowtex.FlowWidget.__init__],
)
def test_signature_and_docstring_show_every_option(function: Any) -> None:
    parameters = inspect.signature(function).parameters
    lines = {line.strip() for line in inspect.getdoc(function).splitlines()}  # type: ignore[union-attr]
    for kind in (FieldOptions, Appearance, ViewOptions):
        for name in option_names(kind):
            assert name in parameters
            assert name in lines
    assert "{options}" not in lines


def test_a_view_beside_another_differs_in_what_it_is_told() -> None:
    options = Options.split(samples=7, cmap="magma", image=np.ones((4, 4)))
    (first,) = make_scenes(gyre(), options)
    second = first.beside({"lod": False, "cmap": "viridis"})
    assert second.field is first.field
    assert (first.settings.lod, second.settings.lod) == (True, False)
    assert (second.settings.samples, second.appearance.cmap) == (7, "viridis")
    assert second.settings.noise == "image"
    with pytest.raises(ValueError, match=r"^beside has plane, which selects data"):
        first.beside({"plane": "k=2"})


def test_a_second_view_follows_the_first_in_what_is_not_its_own() -> None:
    field = gyre().with_derived("vorticity")
    first = Scene.of(field, clim=(0.0, 2.0), cmap="magma", image=np.ones((4, 4)))
    own = {"scalars": "vorticity", "noise": "procedural"}  # beside an image the noise
    second = first.beside(own)
    assert second.scalar_limits == second.scalar_range("vorticity") != first.scalar_limits
    assert (second.settings.noise, second.appearance.cmap) == ("procedural", "magma")
    end = link_scenes(lambda: first, lambda: second, own)
    first.settings.update(samples=9, noise="procedural")
    first.appearance = replace(first.appearance, cmap="gray", clim=(0.0, 1.0), log_scale=False)
    assert (second.settings.samples, second.settings.noise) == (9, "procedural")
    assert second.appearance.cmap == "gray"
    assert second.scalar_limits == second.scalar_range("vorticity")
    lay_image([first, second], np.zeros((4, 4)), own)
    assert (first.settings.noise, second.settings.noise) == ("image", "procedural")
    # The logarithm of what has no sign is left to the first.
    first.appearance = replace(first.appearance, log_scale=True, clim=(0.1, 1.0))
    assert not second.appearance.log_scale and second.appearance.scalars == "vorticity"
    end()
    first.settings.samples = 5
    assert second.settings.samples == 9


@property_test(60)
@given(st.sampled_from(["opacity", "clim", "zoom", "focus", "camera"]), junk())
@example("zoom", 10**400)
@example("zoom", "near")
@example("focus", {})
@example("focus", [10**400, 0])
@example("focus", [0.0, 0.0, 1e17])
@example("clim", (float("nan"), 1.0))
def test_any_value_of_an_argument_is_taken_or_named(name: str, value: Any) -> None:
    try:
        options = Options.split(**{name: value})
        assert np.isfinite(options.view.first_camera(gyre().surface).position).all()
    except ValueError as error:
        # What is too far away to be looked at makes no camera.
        assert str(error).startswith((f"{name} ", "camera")) and "expected" in str(error)


def test_a_path_stands_for_its_file(tmp_path: Path) -> None:
    path = tmp_path / "gyre.vts"
    flowtex.examples.double_gyre(2.5).save(path)
    for file in (path, str(path)):
        field = read_field(file, FieldOptions())
        assert field.name == "gyre"
        assert field.shape == (101, 201)
    with pytest.raises(FieldError, match=r"gyre\.vts: times is given, but the file already"):
        read_field(path, FieldOptions(times=[1.0]))
    with pytest.raises(FieldError, match=r"none\.vts: the file does not exist"):
        read_field(str(tmp_path / "none.vts"), FieldOptions())


@pytest.mark.parametrize("view", [{"focus": (50.0, 50.0), "zoom": 8}, {"focus": (3.0, 0.5, 0)}])
def test_a_view_of_nothing_is_warned_of(view: dict[str, Any]) -> None:
    zoom = {"zoom": 20.0, **view}
    with pytest.warns(UserWarning, match="^The surface is outside the picture"):
        flowtex.render(gyre(), size=(60, 40), samples=3, **zoom)


def test_no_land_has_two_names() -> None:
    assert Appearance.of(land="none").land is None and Appearance.of(land=False).land is None


def test_each_argument_of_the_appearance_is_a_live_attribute() -> None:
    """All but the image, for which there is a method."""
    declared = {
        name
        for name, each in vars(AppearanceAttributes).items()
        if isinstance(each, AppearanceAttribute)
    }
    assert declared == set(option_names(Appearance)) - {"image"}
