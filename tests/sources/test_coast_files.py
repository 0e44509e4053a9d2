"""Lines of a user in place of the coasts: GeoJSON, files of GDAL and GeoDataFrames."""

from __future__ import annotations

import json
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex.errors import FieldError
from flowtex.field.earth.coast import Coast
from flowtex.scene.options import Appearance, Options, coast_of
from flowtex.sources.coast_files import as_coast

pyproj = pytest.importorskip("pyproj")
LINE = [[-20.0, -30.0], [40.0, 50.0]]
SQUARE = [[100.0, -40.0], [140.0, -40.0], [140.0, 10.0], [100.0, 10.0], [100.0, -40.0]]


def feature(kind: str, coordinates: Any) -> dict[str, Any]:
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "properties": {}, "geometry": geometry}


def written(folder: Path, *features: Any, **more: Any) -> Path:
    path = folder / "coast.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features, **more}))
    return path


def lines_of(coast: Coast) -> list[Any]:
    """Return the separate lines of a coast."""
    return np.split(coast.lonlat, 1 + np.flatnonzero(~coast.joined))


def lies_on(line: Any, corners: Any) -> bool:
    """Return whether the points of a line are on the straight pieces between corners."""
    corners = np.asarray(corners)
    nearest = np.full(len(line), np.inf)
    for begin, end in pairwise(corners):
        along = np.clip((line - begin) @ (end - begin) / np.sum((end - begin) ** 2), 0, 1)
        distances = np.linalg.norm(line - begin - along[:, None] * (end - begin), axis=1)
        nearest = np.minimum(nearest, distances)
    return bool(nearest.max() < 1e-6)


@pytest.mark.parametrize(
    ("kind", "coordinates"),
    [
        ("LineString", LINE),
        ("MultiLineString", [LINE, SQUARE]),
        ("Polygon", [SQUARE]),
        ("MultiPolygon", [[SQUARE], [[[-60, 0], [-50, 0], [-50, 9], [-60, 0]]]]),
    ],
)
def test_geojson_gives_its_lines(kind: str, coordinates: Any, tmp_path: Path) -> None:
    coast = as_coast(written(tmp_path, feature(kind, coordinates), feature("Point", [0, 0])))
    flat: dict[str, Any] = {
        "LineString": lambda: [coordinates],
        "MultiLineString": lambda: coordinates,
        "Polygon": lambda: coordinates,
        "MultiPolygon": lambda: [ring for part in coordinates for ring in part],
    }
    expected = flat[kind]()
    lines = lines_of(coast)
    assert len(lines) == len(expected)
    for line, corners in zip(lines, expected, strict=True):
        assert line[0] == pytest.approx(corners[0]) and line[-1] == pytest.approx(corners[-1])
        assert lies_on(line, corners)
        assert np.abs(np.diff(line, axis=0)).max() <= 0.5 + 1e-9


def test_coordinates_are_reprojected_by_the_crs(tmp_path: Path) -> None:
    change = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:3857", always_xy=True)
    metres = [list(change.transform(*point)) for point in LINE]
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}
    coast = as_coast(written(tmp_path, feature("LineString", metres), crs=crs))
    assert coast.lonlat[[0, -1]] == pytest.approx(np.array(LINE))


def test_line_across_the_date_line_is_cut(tmp_path: Path) -> None:
    line = [[170.0, 0.0], [179.0, 1.0], [-179.0, 2.0], [-170.0, 3.0]]
    coast = as_coast(written(tmp_path, feature("LineString", line)))
    assert len(lines_of(coast)) == 2


def test_changed_file_is_read_again(tmp_path: Path) -> None:
    import os

    path = written(tmp_path, feature("LineString", LINE))
    first = as_coast(path)
    assert as_coast(str(path)) is first
    written(tmp_path, feature("LineString", SQUARE))
    os.utime(path, ns=(1, 1))
    assert as_coast(path).lonlat[0] == pytest.approx(SQUARE[0])


class Frame:
    """A stand-in for a GeoDataFrame, with the attributes of its interface."""

    def __init__(self, crs: Any, *features: Any) -> None:
        self.geometry = self
        self.crs = crs
        self.__geo_interface__ = {"type": "FeatureCollection", "features": features}


def test_frame_gives_its_lines() -> None:
    coast = as_coast(Frame(None, feature("LineString", LINE)))
    assert lies_on(coast.lonlat, LINE)


@pytest.mark.parametrize("suffix", [".shp", ".gpkg", ".fgb"])
def test_files_of_gdal_are_reprojected(suffix: str, tmp_path: Path) -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    frame = geopandas.GeoDataFrame(geometry=[shapely.LineString(LINE)], crs="EPSG:4326")
    frame.to_crs("EPSG:3035").to_file(tmp_path / f"coast{suffix}")
    expected = np.array(LINE)
    for source in (tmp_path / f"coast{suffix}", frame, frame.geometry, frame.to_crs("EPSG:3857")):
        coast = as_coast(source)
        assert coast.lonlat[[0, -1]] == pytest.approx(expected, abs=1e-6)


def test_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "geopandas", None)
    path = tmp_path / "coast.shp"
    path.write_bytes(b"")
    with pytest.raises(ModuleNotFoundError, match=r"coast.shp: .* python -m pip install geopandas"):
        as_coast(path)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ('{"type": "FeatureCollection", "features": []}', "no lines or polygons"),
        (json.dumps(feature("Point", [0, 0])), "no lines or polygons"),
        ("{", "cannot be read as GeoJSON"),
        ("[1, 2]", "no lines or polygons"),
        (json.dumps(feature("LineString", [["a", 1], [2, 3]])), "expected pairs of numbers"),
        (json.dumps(feature("LineString", [[4e5, 6e6], [5e5, 7e6]])), "positions reach 500000"),
    ],
)
def test_file_without_lines_raises(content: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "coast.json"
    path.write_text(content)
    with pytest.raises(FieldError, match=told):
        as_coast(path)


@pytest.mark.parametrize("source", [3, [1, 2], "nowhere.geojson", b"x", {"type": "Point"}])
def test_other_source_raises(source: Any) -> None:
    with pytest.raises(FieldError, match="coastlines is"):
        Options.split(coastlines=source)


def test_lines_stay_when_they_are_hidden_and_shown(tmp_path: Path) -> None:
    look = Options.split(coastlines=written(tmp_path, feature("LineString", LINE))).appearance
    hidden = look.changed(coastlines=False)
    again = hidden.changed(coastlines=True)
    first, last = coast_of(look), coast_of(again)
    assert not hidden.coastlines and again.coastlines
    assert first is not None and last is not None and last.lonlat is first.lonlat


def test_appearance_reads_no_files(tmp_path: Path) -> None:
    """Pages and links change an appearance, and must not name files of the server."""
    path = written(tmp_path, feature("LineString", LINE))
    with pytest.raises(FieldError, match="expected True or False"):
        Appearance.of(coastlines=str(path))


def test_web_page_and_widget_take_the_lines(tmp_path: Path) -> None:
    """The client receives the lines of the file, and none of the coasts."""
    import flowtex
    from flowtex.host.view import colours_of
    from flowtex.scene.scene import Scene

    path = written(tmp_path, feature("LineString", LINE))
    field = flowtex.FlowField.from_xarray(flowtex.examples.weather(), level=250)
    scene = Scene.of(field, coastlines=path, samples=3)
    colours = colours_of(scene, field, None)
    assert colours.coastlines and colours.coast is scene.appearance.coastlines
    scene.change({"coastlines": False})
    assert not colours_of(scene, field, None).coastlines
    scene.change({"coastlines": True})
    assert colours_of(scene, field, None).coast is not None
    sizes = []
    for lines in (path, True):
        page = flowtex.export(field, tmp_path / "winds.html", coastlines=lines, samples=3)
        sizes.append(page.nbytes)
    assert sizes[0] < sizes[1] - 20_000


@pytest.mark.usefixtures("opengl")
def test_command_line_takes_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from PIL import Image

    import flowtex
    from flowtex.cli.commands import main

    winds = tmp_path / "winds.nc"
    flowtex.examples.weather().sel(level=[250]).to_netcdf(winds)
    path = written(tmp_path, feature("LineString", [[-90, 10], [90, 10]]))
    pictures = {}
    flags = {"with": ["--coastlines-file", str(path)], "without": ["--no-coastlines"]}
    for name, words in flags.items():
        target = tmp_path / f"{name}.png"
        command = ["render", str(winds), "-o", str(target), "--size", "360x180", "--no-graticule"]
        assert main([*command, "--samples", "3", *words]) == 0
        with Image.open(target) as picture:
            pictures[name] = np.asarray(picture.convert("L"), dtype=float)
    darker = pictures["without"] - pictures["with"]
    rows = np.flatnonzero(darker.max(axis=1) > 20)
    assert 1 <= len(rows) <= 4
    assert abs(rows.mean() - (90 - 10)) < 4
    refused = ["render", str(winds), "-o", "x.png", "--coastlines", "--coastlines-file", str(path)]
    assert main(refused) == 2
    assert "expected one of them" in capsys.readouterr().err
