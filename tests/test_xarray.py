"""``ds.flowtex``: the calls of the package on a dataset."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

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
