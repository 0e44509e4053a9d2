"""Each choice is reported once, with text that is accepted where it is typed."""

from __future__ import annotations

import shlex
import warnings
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest
import test_forms
import test_supported
import xarray as xr
from cyclopts import App
from form_table import FORMS, data_of
from supported import ROWS, shown

from flowtex import FlowField
from flowtex.cli.console import typed
from flowtex.cli.options import FLAT, FieldFlags, arguments
from flowtex.errors import FieldError, Notice
from flowtex.field import units
from flowtex.field.options import FieldOptions
from flowtex.remedies import Remedy, for_page
from flowtex.scene.fields import read_field

pytest.importorskip("pyproj")
#: Modules that fill the tables of forms.
TABLES = (test_forms, test_supported)


def noticed(data: Any, **options: Any) -> tuple[FlowField, list[Notice]]:
    """Read data, and return the field and all notices."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        field = read_field(data, FieldOptions.of(**options))
    notices = [each.message for each in caught if isinstance(each.message, Notice)]
    return field, notices


shell = App(result_action="return_value")


@shell.default
def options_of(*, flow: Annotated[FieldFlags | None, FLAT] = None) -> dict[str, Any]:
    """Return the options that were typed."""
    return arguments(flow)


@cache
def typed_in_shell(text: str) -> dict[str, Any]:
    """Return the options of words that are typed in a shell; many notices say the same ones."""
    options: dict[str, Any] = shell(shlex.split(text))
    return options


def with_option(options: dict[str, Any], name: str, value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        value = {**options.get(name, {}), **value}
    return {**options, name: value}


def number_in(text: Any) -> float:
    return float(str(text).split(" ")[0])


def selects(field: FlowField, remedy: Remedy) -> bool:
    """Return whether a field is what a remedy says."""
    reading = str(field.reading)
    value = remedy.value
    if remedy.name == "level":
        found = float(field.reading.caption.split(" ")[-2 if " " in str(value) else -1])
        return found == pytest.approx(number_in(value), rel=1e-4)
    if remedy.name == "sel":
        ((axis, label),) = value.items()
        return axis == "time" or f"select: {axis}: {label}" in reading
    if remedy.name in ("length_unit", "time_unit", "velocity_unit"):
        unit = str(getattr(field, remedy.name))
        if remedy.name == "velocity_unit":
            unit = field.unit_of("speed")
        return unit == value or units.factor(unit, value) is not None
    if remedy.name == "vectors":
        return f"velocity: {value.replace(',', ', ')}" in reading or f'"{value}", as' in reading
    if remedy.name == "max_edge":
        return f"edges of up to {value}" in reading
    if remedy.name == "components":
        return (field.reading.of("components") != () and f"components={value!r}" in reading) or (
            value in ("from", "to")
        )
    return True


def check_notices(data: Any, options: dict[str, Any], notices: list[Notice]) -> None:
    """Type what each notice of some data says, in Python and in a shell."""
    texts = [str(notice) for notice in notices]
    assert len(set(texts)) == len(texts), texts
    for notice in notices:
        for remedy in notice.remedies:
            assert remedy.in_python in str(notice)
            assert remedy.in_shell in typed(str(notice))
            argument = eval(f"dict({remedy.in_python})")
            assert argument == {remedy.name: remedy.value}
            assert typed_in_shell(remedy.in_shell) == argument
            changed, again = noticed(data, **with_option(options, remedy.name, remedy.value))
            assert str(notice) not in map(str, again), f"{remedy.in_python} leaves {notice}"
            assert selects(changed, remedy), f"{remedy.in_python} gives {changed.reading}"


@pytest.mark.parametrize("name", FORMS)
def test_typed_text_of_forms_is_accepted(name: str, tmp_path: Path) -> None:
    form = FORMS[name]
    data, _ = data_of(form, tmp_path)
    try:
        _, notices = noticed(data, **form.options)
    except FieldError:
        return
    check_notices(data, form.options, notices)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.make.__name__)
def test_typed_text_of_supported_data_is_accepted(
    row: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if row.needs:
        pytest.importorskip(row.needs.replace("-", "_"))
    monkeypatch.chdir(tmp_path)
    variables, _ = row.make(tmp_path)
    data, options = shown(row.code, variables)
    check_notices(data, options, noticed(data, **options)[1])


def box(**arrays: Any) -> Any:
    """Return a volume whose velocity grows along x, y and z."""
    pv = pytest.importorskip("pyvista")
    mesh = pv.ImageData(dimensions=(7, 6, 5))
    mesh["velocity"] = mesh.points + 1.0
    for name, values in arrays.items():
        mesh[name] = values(mesh.points)
    return mesh


def wall() -> Any:
    """Return a wall at rest with a stress."""
    mesh = box().slice("z")
    mesh["velocity"] *= 0
    mesh["wallShearStress"] = mesh.points + 1.0
    return mesh


def plane_with_fills() -> Any:
    mesh = box().extract_subset((0, 6, 0, 5, 0, 0))
    values = np.array(mesh["velocity"])
    values[:12] = -999.0
    mesh["velocity"] = values
    return mesh


def on_axes(*names: str, **attrs: Any) -> xr.Dataset:
    """Return a flow on axes with these names, of 5 and 4 values."""
    sizes = (5, 4)
    values = np.arange(20.0).reshape(sizes)
    lines = {name: (name, np.arange(float(n)), attrs) for name, n in zip(names, sizes, strict=True)}
    unit = {"units": "m/s"}
    return xr.Dataset({"u": (names, values + 1, unit), "v": (names, 2 - values, unit)}, lines)


def two_pairs() -> xr.Dataset:
    ds = on_axes("y", "x", units="m")
    winds = {
        "u": ds.u.assign_attrs(standard_name="eastward_wind"),
        "v": ds.v.assign_attrs(standard_name="northward_wind"),
    }
    return ds.assign(uo=ds.u * 2, vo=ds.v * 2).assign(winds)


def tracks() -> Any:
    pd = pytest.importorskip("pandas")
    rng = np.random.default_rng(1)
    places = rng.uniform(0, 2, (40, 2))
    rows = []
    for number, (x, y) in enumerate(places):
        for step in range(1 + number % 2, 5):
            rows.append((number, f"2024-01-0{step + 1}T06:00", x + 0.1 * step, y))
    frame = pd.DataFrame(rows, columns=["id", "time", "x", "y"])
    return frame.assign(time=pd.to_datetime(frame.time))


def at_rest_at_first() -> xr.Dataset:
    ds = on_axes("y", "x", units="m")
    times = np.array(["2024-01-01", "2024-01-01T06", "2024-01-01T12"], "datetime64[ns]")
    series = xr.concat([ds * 0, ds * 0, ds], "time").assign_coords(time=times)
    for name in ds.data_vars:
        series[name].attrs = ds[name].attrs
    return series


CHOICES: dict[str, Any] = {
    "plane of a grid": (box, "plane", "slice"),
    "outside of a volume": (
        lambda: box(p=lambda p: p[:, 0]).cast_to_unstructured_grid(),
        "slice",
        "contour",
    ),
    "vectors of other names": (lambda: box(force=lambda p: p).slice("z"), "vectors"),
    "stress on a wall": (wall, "vectors"),
    "fill values of a mesh": (plane_with_fills, "mask"),
    "axes a and b": (lambda: on_axes("a", "b"), "dims"),
    "axes i and j": (lambda: on_axes("i", "j"), "dims"),
    "axes j and i": (lambda: on_axes("j", "i"), "dims"),
    "rows and columns": (lambda: on_axes("row", "col"), "dims"),
    "dimensions without names": (lambda: on_axes("dim_0", "dim_1"), "dims"),
    "two pairs": (two_pairs, "vectors"),
    "time of drifters": (tracks, "sel", "max_edge"),
    "rest in the first steps": (at_rest_at_first, "sel"),
    "no units": (
        lambda: (
            on_axes("y", "x", units="m")
            .drop_attrs()
            .assign_coords(x=("x", np.arange(4.0), {"units": "km"}))
        ),
    ),
}


@pytest.mark.parametrize("name", CHOICES)
def test_choice_is_reported_and_can_be_changed(name: str) -> None:
    make, *arguments_of_notices = CHOICES[name]
    data = make()
    _, notices = noticed(data)
    names = [remedy.name for notice in notices for remedy in notice.remedies]
    assert names == arguments_of_notices
    check_notices(data, {}, notices)


@pytest.mark.parametrize("names", [("a", "b"), ("i", "j"), ("j", "i"), ("row", "col")])
def test_exchanged_axes_are_drawn_as_named(names: tuple[str, str]) -> None:
    """The coordinate that is named first is drawn across, with u along it."""
    ds = on_axes(*names)
    first, second = names
    field, notices = noticed(ds, dims=f"{first},{second}")
    assert not notices
    across = field.points[..., 0]
    assert across.shape == (4, 5)
    assert np.array_equal(across[0], ds[first])
    assert np.array_equal(field.velocity[0, ..., 0], ds.u.transpose(second, first))


def test_axes_that_attributes_tell_are_not_reported() -> None:
    ds = on_axes("a", "b")
    ds["b"].attrs["axis"] = "X"
    ds["a"].attrs["axis"] = "Y"
    _, notices = noticed(ds)
    assert not notices


def test_page_names_its_controls() -> None:
    remedies = (Remedy("plane", "j=3"), Remedy("slice", "z", "or cut anywhere, as in"))
    text = 'the plane is "k=2"; choose another, as in plane="j=3", or cut anywhere, as in slice="z"'
    controls = {"plane": "Plane", "slice": "Plane"}
    words = for_page(text, remedies, controls)
    assert words == 'the plane is "k=2"; choose another with the control Plane'
    assert for_page(text, remedies, {}) == typed(text)
    assert typed(text).endswith("--plane j=3, or cut anywhere, as in --slice z")


@pytest.mark.parametrize(
    "value", ["250 hPa", 'a"b', "$HOME", 3, 2.5, {"number": 1}, {"step": "6 h"}]
)
def test_any_value_can_be_typed_in_a_shell(value: Any) -> None:
    name = "sel" if isinstance(value, dict) else "level"
    remedy = Remedy(name, value)
    assert typed_in_shell(remedy.in_shell) == {name: value}


def fronts(folder: Path) -> dict[str, Any]:
    """Return functions that draw data, by the names of the front ends."""
    import flowtex

    small: dict[str, Any] = {"size": (40, 30), "samples": 3}
    return {
        "field": FlowField.from_xarray,
        "render": lambda ds: flowtex.render(ds, **small),
        "export": lambda ds: flowtex.export(ds, folder / "flow.html", samples=3),
        "movie": lambda ds: flowtex.movie(ds, folder / "flow.gif", seconds=0.2, fps=10, **small),
        "pyramid": lambda ds: flowtex.pyramid.build(ds, folder / "flow.zarr"),
    }


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("front", ["field", "render", "export", "movie", "pyramid"])
def test_front_end_reports_a_choice_once(front: str, tmp_path: Path) -> None:
    times = np.array(["2024-01-01", "2024-01-02", "2024-01-03"], dtype="datetime64[ns]")
    places = {"lon": np.arange(8.0), "lat": np.arange(40.0, 46), "plev": [1000.0, 500.0]}
    dims = ("time", *places)
    unit = {"units": "m/s"}
    values = np.random.default_rng(0).normal(size=(3, 8, 6, 2)) + 5
    values[1:, :3, :3] = -999.0
    ds = xr.Dataset(
        {"u": (dims, values, unit), "v": (dims, values, unit)}, {"time": times, **places}
    )
    ds.plev.attrs["units"] = "hPa"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        fronts(tmp_path)[front](ds.transpose("time", "plev", "lat", "lon"))
    texts = [str(each.message) for each in caught if issubclass(each.category, Notice)]
    assert len(texts) == len(set(texts)) > 1, texts
    assert sum('level="500 hPa"' in text for text in texts) == 1
