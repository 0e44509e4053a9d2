"""``ds.flowtex``: the calls of the package on a dataset."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

import xarray as xr
from earth_data import winds

import flowtex
import flowtex.xarray
from flowtex import FieldError
from flowtex.scene.scene import Scene
from flowtex.settings import SettingsError


@pytest.mark.usefixtures("quick_export")
def test_a_dataset_has_the_calls_of_the_package(opengl: Any, tmp_path: Path) -> None:
    del opengl
    ds = winds(np.arange(-180.0, 180.0, 20.0), np.arange(-80.0, 81.0, 20.0))
    assert ds.flowtex.field(globe=True).projection.is_globe
    picture = ds.flowtex.render(globe=True, size=(60, 40))
    assert np.array_equal(picture, flowtex.render(ds, globe=True, size=(60, 40)))
    ds.flowtex.export(tmp_path / "page.html", projection="robinson")
    assert (tmp_path / "page.html").stat().st_size > 10_000
    pytest.importorskip("anywidget")
    assert ds.flowtex.widget(globe=True).settings.samples > 0
    with pytest.raises(SettingsError, match="globe"):
        ds.flowtex.render(glob=True)
    with pytest.raises(FieldError, match="plane applies to meshes"):
        ds.flowtex.render(plane="k=2")
    with pytest.raises(FieldError, match="globe applies to datasets"):
        flowtex.render(flowtex.examples.double_gyre(), globe=True)


def test_the_texture_of_the_earth_fades_where_it_is_calm() -> None:
    ds = winds(np.arange(-20.0, 21.0, 2.0), np.arange(40.0, 61.0, 2.0))
    assert Scene.of(ds).settings.fade == 0.05
    assert Scene.of(ds, fade=False).settings.fade == 0
    assert Scene.of(flowtex.examples.double_gyre()).settings.fade == 0
    assert Scene.of(flowtex.examples.double_gyre(), fade=True).settings.fade == 0.05


@pytest.mark.parametrize("projection", ["platecarree", "robinson", "mercator", "south"])
def test_no_map_makes_the_earth_calm(projection: str) -> None:
    """Next to the poles a flat map stretches velocities without limit."""
    winds = flowtex.examples.weather()
    one, whole = (
        Scene.of(winds, level=250, **where).textures.typical_speed
        for where in ({"projection": projection}, {"globe": True})
    )
    assert one == pytest.approx(whole, rel=0.05)  # some leave out a part


def test_values_are_told_at_a_place_of_the_earth(tmp_path: Path) -> None:
    lon, lat = np.arange(-20.0, 21.0, 2.0), np.arange(40.0, 61.0, 2.0)
    ds = winds(lon, lat)
    ds["u"][:], ds["v"][:] = 3.0 + 0.1 * ds["lon"], -1.0
    for place, tolerance in (((4.0, 50.0), 1e-6), ((5.0, 51.0), 0.02)):  # a node, and in a cell
        at = ds.flowtex.field(projection="robinson").at(*place)
        assert at is not None
        expected = (3.0 + 0.1 * place[0], -1.0)
        assert (at.eastward, at.northward) == pytest.approx(expected, abs=tolerance)
        assert at.lonlat == pytest.approx(place, abs=tolerance)
    for beside in ((50.0, 51.0), (5.0, 95.0)):
        assert ds.flowtex.field(globe=True).at(*beside) is None
    assert ds.flowtex.pyramid(tmp_path / "flow.zarr", progress=False).made > 0


def few_winds() -> Any:
    """Every third wind of the example."""
    return flowtex.examples.weather().isel(
        latitude=slice(None, None, 3), longitude=slice(None, None, 3)
    )


def test_a_dataset_is_plotted_with_the_words_of_xarray(opengl: Any) -> None:
    del opengl
    import matplotlib.pyplot as plt

    ds = few_winds()
    figure, ax = plt.subplots()
    image = ds.sel(level=250).flowtex.plot(ax=ax, u="u", v="v", vmax=40.0, samples=3, cmap="magma")
    assert image.axes is ax and image.get_clim()[1] == 40
    assert figure.axes[1].get_ylabel() == "speed (m/s)"
    plain = ds.sel(level=500).flowtex.plot(
        figsize=(3, 2), hue="vorticity", robust=True, add_colorbar=False
    )
    assert len(plain.figure.axes) == 1 and -1e-4 < plain.get_clim()[0] < 0
    plt.close("all")


def test_facets_have_one_range_of_colours(opengl: Any) -> None:
    del opengl
    import matplotlib.pyplot as plt

    crs = pytest.importorskip("cartopy.crs")
    ds = few_winds()
    panels = ds.flowtex.plot(
        col="level",
        col_wrap=2,
        samples=3,
        transform=crs.PlateCarree(),
        subplot_kws={"projection": crs.Robinson()},
    )
    assert [ax.get_visible() for ax in panels.axs.flat] == [True, True, True, False]
    assert panels.axs.flat[2].get_title() == "level = 250.0"
    limits = {ax.images[0].get_clim() for ax in panels.axs.flat[:3]}
    assert len(limits) == 1 and limits.pop()[1] > 70, "the fastest winds are at 250 hPa"
    panels.fig.canvas.draw()
    plt.close("all")


X, Y = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-2, 2, 13))


def plane() -> xr.Dataset:
    """A flow on axes without usual names, with positions in two dimensions beside them."""
    u, v = 1 - Y, 2 * X
    return xr.Dataset(
        {"u": (("row", "column"), u), "v": (("row", "column"), v)},
        {
            "far": ("column", X[0]),
            "high": ("row", Y[:, 0]),
            "px": (("row", "column"), X + 0.5 * Y),
            "py": (("row", "column"), Y),
        },
    )


def test_an_array_has_the_calls_of_the_package(opengl: Any) -> None:
    del opengl
    import matplotlib.pyplot as plt

    both = np.stack([1 - Y, 2 * X])
    array = xr.DataArray(both, {"x": X[0], "y": Y[:, 0], "c": ["u", "v"]}, ("c", "y", "x"))
    picture = array.flowtex.render(size=(60, 40), samples=3)
    assert np.array_equal(picture, flowtex.render(array, size=(60, 40), samples=3))
    assert np.array_equal(array.flowtex.field().velocity[0][..., 0], both[0])
    series = xr.concat([array, 2 * array], xr.Variable("time", [0.0, 1.0]))
    panels = series.flowtex.plot(col="time", samples=3)
    speeds = [ax.images[0].flow.speed.max() for ax in panels.axs.flat]
    assert speeds[1] == pytest.approx(2 * speeds[0])
    plt.close("all")


@pytest.mark.parametrize("order", [("row", "column"), ("column", "row")])
def test_a_plot_lies_on_the_coordinates_that_are_named(opengl: Any, order: tuple[str, str]) -> None:
    del opengl
    import matplotlib.pyplot as plt

    ds = plane().transpose(*order)
    for x, y, across in (("far", "high", X), ("px", "py", X + 0.5 * Y)):
        field = ds.flowtex.plot(ax=plt.figure().add_subplot(), x=x, y=y, samples=3).flow
        place = field.at(across[4, 3], Y[4, 3])
        assert place is not None
        np.testing.assert_allclose(place.velocity[:2], [1 - Y[4, 3], 2 * X[4, 3]], atol=1e-9)
    plt.close("all")


def test_a_plot_has_levels_norms_and_limits(opengl: Any) -> None:
    del opengl
    import matplotlib.pyplot as plt
    from matplotlib.colors import BoundaryNorm, PowerNorm

    named = {"x": "far", "y": "high", "samples": 3}
    image = plane().flowtex.plot(**named, levels=[0, 1, 4], xlim=(-0.5, 1), ylim=(0, 2))
    assert isinstance(image.norm, BoundaryNorm) and image.norm.boundaries.tolist() == [0, 1, 4]
    assert image.axes.get_xlim() == (-0.5, 1) and image.axes.get_ylim() == (0, 2)
    colours = image.make_image(None)[0][..., :3].reshape(-1, 3)
    assert len(np.unique(colours // 64, axis=0)) < 30
    even = plane().flowtex.plot(ax=plt.figure().add_subplot(), **named, levels=4).norm.boundaries
    assert len(even) <= 6 and np.ptp(np.diff(even)) < 1e-9
    norm = PowerNorm(0.5, 0, 3)
    image = plane().flowtex.plot(ax=plt.figure().add_subplot(), **named, norm=norm)
    assert isinstance(image.norm, PowerNorm) and image.get_clim() == (0, 3)
    plt.close("all")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"x": "lat", "y": "lon"}, "exchanged; use x='lon', y='lat'"),
        ({"x": "far"}, "x is 'far' and y is None; expected the names of both"),
        ({"x": "fat", "y": "high"}, "the data have no 'fat'; did you mean"),
        ({"x": "far", "y": "py"}, "expected two axes, or two coordinates over both"),
        ({"norm": "symlog", "vmax": 3}, "vmax is 3; expected one of them"),
        ({"x": "far", "y": "high", "levels": [2, 1]}, "expected edges that increase"),
    ],
)
def test_a_plot_names_invalid_arguments(opengl: Any, options: dict[str, Any], words: str) -> None:
    del opengl
    import matplotlib.pyplot as plt

    ds = plane().assign_coords(lat=("row", Y[:, 0]), lon=("column", X[0]))
    with pytest.raises(FieldError, match=words):
        ds.flowtex.plot(**options, samples=3)
    plt.close("all")
