"""Arguments that every way of drawing takes: sorted, checked, and told once."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import pytest
from flows import gyre

import flowtex
from flowtex.options import (
    Appearance,
    FieldOptions,
    Options,
    ViewOptions,
    accepts_options,
    option_text,
)
from flowtex.scene import Scene
from flowtex.settings import SettingsError


def test_each_argument_goes_where_it_belongs() -> None:
    options = Options.split(plane="k=2", cmap="magma", zoom=3, samples=7)
    assert options.field == FieldOptions(plane="k=2")
    assert vars(options.appearance) == vars(Appearance(cmap="magma"))
    assert options.view == ViewOptions(zoom=3)
    assert options.settings == {"samples": 7}


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"zooom": 2}, r"^there is no setting or argument 'zooom'; did you mean 'zoom'\?$"),
        ({"sample": 2}, r"^there is no setting or argument 'sample'; did you mean 'samples'\?$"),
        ({"qqqq": 2}, r"^there is no setting or argument 'qqqq'; there are: samples, "),
        ({"opacity": 2}, r"^opacity is 2; expected a number from 0 to 1$"),
        ({"opacity": None}, r"^opacity is None; expected a number from 0 to 1$"),
        ({"clim": (1, 2, 3)}, r"^clim is \(1, 2, 3\); expected two numbers, \(low, high\), "),
        ({"clim": "ab"}, r"^clim is 'ab'; expected two numbers, \(low, high\), the lower one fir"),
        ({"clim": (2, 1)}, r"^clim is \(2, 1\); expected .* the lower one first, or \"robust\"$"),
        ({"cmap": "virdis"}, r"^there is no colour map 'virdis'; did you mean 'viridis'"),
        ({"cmap": 3}, r"^there is no colour map 3; expected a name"),
        ({"color": "greyy"}, r"greyy"),
        ({"opacity": -1, "clim": 3}, r"(?s)^2 things are wrong:.*opacity is -1;.*clim is 3;"),
    ],
)
def test_what_is_unknown_or_wrong_is_refused(values: dict[str, Any], text: str) -> None:
    with pytest.raises(ValueError, match=text):
        Options.split(**values)


def test_what_a_call_has_no_use_for_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"^there is no setting or argument 'zoom'; "):
        Scene.of(gyre(), zoom=2)


@pytest.mark.parametrize(
    "function",
    [
        flowtex.render,
        flowtex.show,
        flowtex.movie,
        flowtex.export,
        flowtex.FlowWidget.__init__,
    ],
)
def test_signature_and_docstring_show_every_option(function: Any) -> None:
    parameters = inspect.signature(function).parameters
    lines = {line.strip() for line in inspect.getdoc(function).splitlines()}  # type: ignore[union-attr]
    for kind in (FieldOptions, Appearance, ViewOptions):
        for name in kind.__dataclass_fields__:
            assert name in parameters
            assert name in lines
    assert "{options}" not in lines
    assert option_text(ViewOptions, "zoom").startswith("How far in")


def test_an_argument_that_a_function_names_itself_stands_once() -> None:
    @accepts_options(ViewOptions)
    def draw(mesh: Any, zoom: float = 2.0, **options: Any) -> None:
        pass

    assert list(inspect.signature(draw).parameters)[:3] == ["mesh", "zoom", "focus"]


def test_a_view_beside_another_differs_in_what_it_is_told() -> None:
    options = Options.split(samples=7, cmap="magma", image=np.ones((4, 4)))
    first = Scene.from_options(gyre(), options)
    second = first.beside({"lod": False, "cmap": "viridis"}, options)
    assert second.field is first.field
    assert (first.settings.lod, second.settings.lod) == (True, False)
    assert (second.settings.samples, second.appearance.cmap) == (7, "viridis")
    assert second.settings.noise == "image"
    with pytest.raises(ValueError, match=r"^beside has plane; both views show one field"):
        first.beside({"plane": "k=2"}, options)


def test_choices_of_a_mesh_are_refused_for_a_field() -> None:
    with pytest.raises(TypeError, match=r"^plane cannot be chosen any more for FlowField"):
        Scene.of(gyre(), plane="k=1")
