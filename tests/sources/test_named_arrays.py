"""Arrays by name, scattered, with labels and on the Earth, as functions that draw read them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FieldError, FlowField
from flowtex.errors import Notice
from flowtex.field.options import FieldOptions
from flowtex.scene.fields import DATA, read_field
from flowtex.scene.options import Options

LINE_X, LINE_Y = np.linspace(-1, 1, 8), np.linspace(-2, 2, 11)
X, Y = np.meshgrid(LINE_X, LINE_Y)
#: A flow that tells its place and its components apart at every node.
U, V = 1 - Y + 0.3 * X, 2 * X + 0.1 * Y
LON, LAT = np.arange(0.0, 360, 30), np.arange(-60.0, 61, 20)
ZONAL = 10 * np.cos(np.radians(np.meshgrid(LON, LAT)[1]))
MERIDIONAL = np.sin(np.radians(np.meshgrid(LON, LAT)[0]))

quiet = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")


def read(*arrays: Any, **options: Any) -> FlowField:
    mesh = arrays if len(arrays) > 1 else arrays[0]
    return read_field(mesh, Options.split("field", "appearance", **options).field)


def check(field: FlowField) -> None:
    x, y, _ = np.moveaxis(field.points, -1, 0)
    expected = np.stack([1 - y + 0.3 * x, 2 * x + 0.1 * y], axis=-1)
    np.testing.assert_allclose(field.velocity[0][..., :2], expected, atol=1e-12)


def structured() -> Any:
    records = np.zeros(X.shape, [(name, float) for name in "xyuvp"])
    for name, values in zip("xyuvp", (X, Y, U, V, U * V), strict=True):
        records[name] = values
    return records


NAMED: dict[str, dict[str, Any]] = {
    "lines": {"x": LINE_X, "y": LINE_Y, "u": U, "v": V},
    "capital letters": {"X": X, "Y": Y, "U": U, "V": V},
    "other names": {"x": LINE_X, "y": LINE_Y, "vx": U, "vy": V},
    "of MATLAB": {"__header__": b"MATLAB", "x": LINE_X[None], "y": LINE_Y[:, None], "u": U, "v": V},
    "one array": {"x": LINE_X, "y": LINE_Y, "velocity": np.stack([U, V])},
    "three components": {"x": X, "y": Y, "u": U, "v": V, "w": 0 * U},
}


@pytest.mark.parametrize("arrays", NAMED.values(), ids=NAMED)
def test_named_arrays_are_read_by_their_names(arrays: dict[str, Any]) -> None:
    field = read({**arrays, "p": U * V})
    assert field.shape == X.shape
    check(field)
    assert np.array_equal(field.scalars["p"][0], U * V)


@pytest.mark.parametrize("arrays", NAMED.values(), ids=NAMED)
def test_constructor_reads_named_arrays_too(arrays: dict[str, Any]) -> None:
    field = FlowField.from_arrays(arrays, name="named", scalars={"p": U * V}, velocity_unit="m/s")
    check(field)
    assert field.name == "named"
    np.testing.assert_array_equal(field.scalars["p"][0], U * V)


@pytest.mark.parametrize("argument", ["velocity", "valid", "vectors", "units"])
def test_constructor_refuses_what_names_tell(argument: str) -> None:
    value: Any = U > 0
    if argument in ("vectors", "units"):
        value = "B"
    with pytest.raises(FieldError, match=f"{argument} is given beside arrays by name"):
        FlowField.from_arrays(NAMED["lines"], **{argument: value})


@quiet
@pytest.mark.parametrize("lines", [(LINE_X, LINE_Y), (X, Y), (LINE_X[None], LINE_Y[:, None])])
@pytest.mark.parametrize(
    "names",
    [("Ve", "Vn"), ("u10", "v10"), ("V_x", "V_y"), ("vel.x", "vel.y"), ("U.east", "U.north")],
    ids=" ".join,
)
def test_components_have_the_names_that_datasets_have(
    names: tuple[str, str], lines: tuple[Any, Any]
) -> None:
    arrays = {"x": lines[0], "y": lines[1], names[0]: U, names[1]: V, "time": [3.0]}
    field = read(arrays, scalars=U * V)
    check(field)
    np.testing.assert_array_equal(field.scalars[DATA][0], U * V)
    series = {**arrays, names[0]: np.stack([U, 2 * U]), names[1]: np.stack([V, 2 * V])}
    field = read({**series, "time": [3.0, 5.0]})
    check(field)
    assert field.times.tolist() == [3.0, 5.0]
    np.testing.assert_allclose(field.velocity[1], 2 * field.velocity[0])


@quiet
def test_speed_and_direction_are_known_by_their_names() -> None:
    speed = np.hypot(ZONAL, MERIDIONAL)
    direction = np.degrees(np.arctan2(-ZONAL, -MERIDIONAL)) % 360
    arrays = {"lon": LON, "lat": LAT, "speed": speed, "wind_direction": direction}
    expected = read({"lon": LON, "lat": LAT, "u": ZONAL, "v": MERIDIONAL})
    np.testing.assert_allclose(read(arrays).velocity, expected.velocity, atol=1e-9)
    arrays["wave_angle"] = arrays.pop("wind_direction")
    with pytest.raises(FieldError, match='vectors="speed", direction="wave_angle"'):
        read(arrays)


def test_chosen_names_are_taken() -> None:
    arrays = {"x": X, "y": Y, "u": 0 * U, "v": 0 * V, "a": U, "b": V}
    check(read(arrays, vectors="a,b"))
    check(read(arrays, u="a", v="b"))
    with pytest.raises(FieldError, match="there is no array 'c'; expected names among x, y, u"):
        read(arrays, vectors="a,c")
    with pytest.raises(FieldError, match=r"named first, second; expected x, y, u and v.*by posit"):
        read({"first": U, "second": V})


def test_structured_arrays_and_archives_are_named(tmp_path: Path) -> None:
    field = read(structured())
    check(field)
    assert np.array_equal(field.scalars["p"][0], U * V)
    np.savez(tmp_path / "flow.npz", x=LINE_X, y=LINE_Y, u=np.stack([U] * 2), v=[V] * 2, t=[3, 5])
    with np.load(tmp_path / "flow.npz") as archive:
        field = read(archive)
    check(field)
    assert field.times.tolist() == [3, 5]


def test_files_of_matlab_have_columns_of_times(tmp_path: Path) -> None:
    """As of coastal radar, with the times last: the error tells how to move them."""
    io = pytest.importorskip("scipy.io")
    series = {"U": np.stack([U] * 3, axis=-1), "V": np.stack([V] * 3, axis=-1)}
    io.savemat(tmp_path / "radar.mat", {"X": X, "Y": Y, "T": [[3.0], [4.0], [6.0]], **series})
    with pytest.raises(FieldError, match=r'use flowtex.show\(scipy.io.loadmat\(".*radar.mat"\)\)'):
        FlowField.from_file(tmp_path / "radar.mat")
    arrays = io.loadmat(tmp_path / "radar.mat")
    with pytest.raises(FieldError, match=r"times first: .* np.moveaxis\(u, -1, 0\)"):
        read(arrays)
    moved = {name: np.moveaxis(arrays[name], -1, 0) for name in series}
    field = read({**arrays, **moved})
    check(field)
    assert field.times.tolist() == [3, 4, 6]


@quiet
def test_rows_of_a_lattice_are_a_grid_and_other_points_are_joined() -> None:
    pytest.importorskip("xarray")
    order = np.random.default_rng(1).permutation(X.size)
    rows = [part.ravel()[order] for part in (X, Y, U, V)]
    for field in (read(*rows), read(dict(zip("xyuv", rows, strict=True)))):
        assert field.shape == X.shape
        check(field)
    check(read(structured().ravel()[order]))
    field = read(*(part[:40] for part in rows[:2]), rows[2][:40] + 1j * rows[3][:40])
    assert field.triangles is not None
    check(field)


@quiet
def test_positions_on_the_earth_are_those_of_a_map() -> None:
    pytest.importorskip("pyproj")
    by_name = read({"lon": LON, "lat": LAT, "u": ZONAL, "v": MERIDIONAL})
    nodes = np.meshgrid(LON, LAT)
    for field in (
        by_name,
        read(LON, LAT, ZONAL, MERIDIONAL, projection="platecarree"),
        read(LON, LAT[::-1], ZONAL[::-1], MERIDIONAL[::-1], projection="robinson"),
        read(*nodes, ZONAL, MERIDIONAL, globe=True),
    ):
        assert field.projection is not None
        at = field.at(60, 20)
        assert at is not None
        expected = 10 * np.cos(np.radians(20)), np.sin(np.radians(60))
        assert (at.eastward, at.northward) == pytest.approx(expected, abs=1e-4)
    assert by_name.projection is not None and by_name.projection.name == "platecarree"


@quiet
def test_scalars_of_arrays_lie_at_their_nodes() -> None:
    pytest.importorskip("pyproj")
    speed = np.hypot(ZONAL, MERIDIONAL)
    field = read(LON, LAT, ZONAL, MERIDIONAL, scalars=speed, projection="robinson")
    np.testing.assert_allclose(field.scalars[DATA][0], field.scalars["speed"][0])
    assert np.array_equal(read(LINE_X, LINE_Y, U, V, scalars=U).scalars[DATA][0], U)
    ring = np.linspace(0, 2 * np.pi, 12, endpoint=False)[:, None]
    radii = np.array([1.0, 2.0])
    x, y = radii * np.cos(ring), radii * np.sin(ring)
    assert read(x, y, -y, x, scalars=x).scalars[DATA][0].shape == (13, 2)


@quiet
def test_labelled_arrays_by_position_are_read_by_labels() -> None:
    xr = pytest.importorskip("xarray")
    square = np.arange(8.0)
    x, y = np.meshgrid(square, square)
    at = {"a": ("a", square), "b": ("b", square)}
    ds = xr.Dataset(
        {"one": (("a", "b"), (1 - y + 0.3 * x).T), "two": (("a", "b"), (2 * x + 0.1 * y).T)}
    )
    ds = ds.assign_coords(at)
    # The number of values does not tell the axes of a square apart, and labels do.
    check(read(ds.a, ds.b, ds.one, ds.two))
    check(read(ds.one, ds.two))


def test_columns_of_speed_and_direction() -> None:
    columns = {"x": X.ravel(), "y": Y.ravel(), "ff": np.hypot(U, V).ravel()}
    columns["dd"] = np.arctan2(V, U).ravel()
    with pytest.warns(UserWarning, match="ff and dd, a direction to, as nothing says otherwise"):
        field = read(columns, vectors="ff", direction="dd")
    # A direction is clockwise from the y axis.
    assert np.allclose(field.velocity[0, ..., :2], np.stack([V, U], axis=-1))


@quiet
@pytest.mark.parametrize("components", ["polar", "cylindrical"])
def test_components_along_a_radius_and_an_angle(components: str) -> None:
    angle = np.arctan2(Y, X)
    radial = U * np.cos(angle) + V * np.sin(angle)
    around = V * np.cos(angle) - U * np.sin(angle)
    check(read(LINE_X, LINE_Y, radial, around, components=components))
    check(read({"x": LINE_X, "y": LINE_Y, "u": radial, "v": around}, components=components))


def test_other_arguments_of_arrays_are_refused() -> None:
    for options in ({"plane": "k=3"}, {"level": 500}, {"mask": False}):
        with pytest.raises(FieldError, match="applies to meshes, files and datasets"):
            read(LINE_X, LINE_Y, U, V, **options)
    with pytest.raises(FieldError, match="vectors is 'u,v', but the arrays have no names"):
        read(LINE_X, LINE_Y, U, V, vectors="u,v")
    named = {"x": LINE_X, "y": LINE_Y, "length": np.hypot(U, V), "angle": np.arctan2(V, U)}
    for arrays in ((named,), tuple(named.values())):
        with pytest.raises(FieldError, match=r"direction is 'angle'(;|, but .* no names)"):
            read(*arrays, direction="angle")
    with pytest.raises(FieldError, match=r"u is array.*; expected the name of an array. Pass"):
        FieldOptions.of(u=U, v=V)
    with pytest.raises(
        FieldError, match=r"two arrays of the shape .* may be u and v, or positions"
    ):
        read(np.stack([X, Y], -1), np.stack([U, V], -1))
    assert read(LINE_X, LINE_Y, U, V, sign_free=True).sign_free
    assert read(LINE_X, LINE_Y, U, V, periodic="i").periodic == (False, True)


#: Angles of a direction by the words for them in ``components``.
ANGLES = {
    "angle": lambda u, v: np.arctan2(v, u),
    "to": lambda u, v: np.degrees(np.arctan2(u, v)) % 360,
    "from": lambda u, v: np.degrees(np.arctan2(-u, -v)) % 360,
}


@pytest.mark.parametrize("word", ANGLES)
@pytest.mark.parametrize("form", ["position", "names", "velocity alone", "times"])
def test_speed_and_direction_are_components(word: str, form: str) -> None:
    x, y = np.linspace(0, 3, 9), np.linspace(0, 2, 7)
    across, upward = np.meshgrid(x, y)
    u, v = 1 + upward, 2 - across
    if form == "times":
        u, v = np.stack([u, 2 * u]), np.stack([v, -v])
    angle, speed = ANGLES[word](u, v), np.hypot(u, v)
    options: dict[str, Any] = {"direction": angle, "components": word}
    data: Any = (x, y, speed)
    if form == "names":
        data = {"x": x, "y": y, "ff": speed, "dd": angle}
        options |= {"vectors": "ff", "direction": "dd"}
    if form == "velocity alone":
        data = speed
    field = read_field(data, FieldOptions.of(**options))
    np.testing.assert_allclose(field.velocity[..., 0].squeeze(), u, atol=1e-12)
    np.testing.assert_allclose(field.velocity[..., 1].squeeze(), v, atol=1e-12)


def test_meaning_of_a_direction_is_reported_unless_named() -> None:
    speed, angle = np.ones((4, 5)), np.full((4, 5), 30.0)
    with pytest.warns(Notice, match='counterclockwise from x, .*components="to".*"from"') as told:
        read_field(speed, FieldOptions.of(direction=angle))
    assert len(told) == 1


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"direction": np.ones((3, 3))}, r"the speed has shape \(4, 5\) and direction \(3, 3\)"),
        ({"direction": "dd"}, "the arrays have no names; expected an array of angles"),
        ({"direction": np.ones((4, 5)), "components": "polar"}, "components is 'polar' beside"),
    ],
)
def test_direction_that_does_not_fit_raises(options: dict[str, Any], told: str) -> None:
    with pytest.raises(FieldError, match=told):
        read_field(np.ones((4, 5)), FieldOptions.of(**options))
