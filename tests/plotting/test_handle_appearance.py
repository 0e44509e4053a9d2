"""The appearance of a flow on a plotter, changed while it is shown."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from flows import gyre

import flowtex
from flowtex import FieldError
from flowtex.plotting import component  # noqa: F401  which PyVista finds by its entry point
from flowtex.scene.options import NO_VALUE_COLOR

pytestmark = pytest.mark.usefixtures("opengl")


@cache
def heights() -> flowtex.FlowField:
    field = gyre()
    height = field.points[..., 1] - 0.4
    return flowtex.FlowField.from_arrays(field.points, field.velocity, scalars={"height": height})


def shot(plotter: Any) -> Any:
    plotter.render()
    return plotter.screenshot(return_img=True).astype(float)


@pytest.fixture
def plotter() -> Any:
    made: Any = pv.Plotter(off_screen=True, window_size=[240, 160])
    made.disable_anti_aliasing()
    yield made
    made.close()


CHANGES: list[dict[str, Any]] = [
    {"clim": (0.1, 0.2), "lighting": True},
    {"clim": "robust", "opacity": 0.4},
    {"scalars": "height", "cmap": "coolwarm"},
    {"scalars": False, "color": "tomato"},
    {"scalars": "vorticity"},
    {"scalars": "velocity_x", "clim": (-0.1, 0.2)},
    {"visible": False},
    {"clim": (0.01, 0.3), "log_scale": True, "show_scalar_bar": False},
]


@pytest.mark.parametrize("changes", CHANGES, ids=str)
def test_a_change_gives_what_was_asked_for_at_first(plotter: Any, changes: dict[str, Any]) -> None:
    handle = plotter.flowtex.add(heights())
    before = shot(plotter)
    for name, value in changes.items():
        setattr(handle, name, value)
        assert getattr(handle, name) == value
    changed = shot(plotter)
    handle.remove()
    plotter.flowtex.add(heights(), **changes)
    np.testing.assert_allclose(changed, shot(plotter), atol=1)
    assert np.abs(changed - before).max() > 8


def test_a_change_and_back_is_no_change(plotter: Any) -> None:
    handle = plotter.flowtex.add(heights())
    before = shot(plotter)
    for name, value in (("scalars", "height"), ("cmap", "magma"), ("visible", False)):
        was = getattr(handle, name)
        setattr(handle, name, value)
        setattr(handle, name, was)
    np.testing.assert_allclose(shot(plotter), before, atol=1)
    handle.actor.prop.opacity = 0.5  # what was done to the actor stays
    handle.cmap = "magma"
    assert handle.actor.prop.opacity == 0.5


REFUSED = [
    ("scalars", "hight", r"the field has no scalar 'hight'; expected one of 'speed', 'hei"),
    ("log_scale", True, r"log_scale is True, but 'speed' ranges from"),
    ("colours", "magma", r"FlowHandle has no attribute 'colours'; did you mean 'color'"),
    ("contrast", 2, r"has no attribute 'contrast'; it is a setting: use settings\.con"),
]


def test_what_does_not_fit_is_refused(plotter: Any) -> None:
    handle = plotter.flowtex.add(heights())
    before = shot(plotter)
    for name, value, said in REFUSED:
        with pytest.raises((AttributeError, FieldError), match=said):
            setattr(handle, name, value)
        np.testing.assert_array_equal(shot(plotter), before)


def test_a_node_without_a_value_is_grey(plotter: Any) -> None:
    field = heights()
    values = np.where(field.points[..., 0] < 1, np.nan, field.points[..., 0])
    nan = flowtex.FlowField.from_arrays(field.points, field.velocity, scalars={"gap": values})
    plotter.flowtex.add(nan, scalars="gap", strength=0.0, show_scalar_bar=False)
    grey = np.rint(255 * np.array(pv.Color(NO_VALUE_COLOR).float_rgb))
    assert (shot(plotter) == grey).all(axis=-1).mean() > 0.2


def test_another_surface_is_drawn_as_if_it_were_the_first(plotter: Any) -> None:
    handle = plotter.flowtex.add(gyre())
    points, velocity = gyre().points, gyre().velocity
    for part in (np.s_[:, :30], np.s_[::2, 8:]):
        field = flowtex.FlowField.from_arrays(
            points[part], velocity[0][part], scalars={"x": points[part][..., 0]}
        )
        handle.set_surface(field)
        fresh: Any = pv.Plotter(off_screen=True, window_size=plotter.window_size)
        fresh.disable_anti_aliasing()
        fresh.flowtex.add(field, clim=handle.scene.scalar_limits)
        fresh.camera = plotter.camera.copy()
        np.testing.assert_array_equal(shot(plotter), shot(fresh))
        fresh.close()
    # At a later time of a series, a flow that is steady takes its place, and of another kind.
    handle.set_surface(series := flowtex.examples.double_gyre_field(True, (11, 21)))
    handle.time = float(series.times[-2])
    shot(plotter)
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    numbers = [[0, 1, 2], [1, 3, 2]]
    handle.set_surface(flowtex.FlowField.from_triangles(corners, numbers, np.ones((4, 2))))
    assert handle.time == 0 and np.ptp(shot(plotter)) > 0
    handle.set_surface(field)
    handle.scalars = "x"
    with pytest.raises(FieldError, match="no scalar 'x'"):
        handle.set_surface(gyre())
    assert handle.field.shape == gyre().velocity[0][::2, 8:].shape[:2]
    before = shot(plotter)
    handle.settings.contrast = 0.2
    assert np.abs(shot(plotter) - before).max() > 10


def test_a_lit_body_has_shadows(plotter: Any) -> None:
    """Shadows are nearly as deep as those of PyVista, 2.6, where dark streaks would be lost."""
    sphere = pv.Sphere(theta_resolution=24, phi_resolution=24)
    sphere["velocity"] = np.cross(sphere.points, (0.0, 0.0, 1.0))
    plotter.set_background("white")
    plotter.enable_lightkit()
    plotter.flowtex.add(sphere, scalars=False, strength=0.0)
    plotter.render()
    grey = np.asarray(plotter.screenshot(return_img=True))[..., :3].mean(axis=-1)
    dark, bright = np.percentile(grey[grey < 250], [2, 98])
    assert 1.9 < bright / dark < 2.6
    assert dark > 60


def test_values_of_another_type_are_refused_by_name(plotter: Any) -> None:
    with pytest.raises(FieldError, match="scalar_bar_args is 'title'; expected a dict"):
        plotter.flowtex.add(gyre(), scalar_bar_args="title")
    handle = plotter.flowtex.add(gyre())
    with pytest.raises(FieldError, match=r"log_scale is array\(\[1, 2\]\); expected True"):
        handle.log_scale = np.array([1, 2])
    assert handle.log_scale is False
