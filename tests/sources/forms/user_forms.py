"""Forms that users have in their own files: text, grids and arrays without any attribute."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from form_table import form, variants
from known_flow import Truth, at_points, earth, in_plane, on_earth, plane, wind, without

X, Y = np.linspace(0.0, 3.0, 13), np.linspace(0.0, 1.0, 9)
LON, LAT = np.arange(0.0, 24, 2), np.arange(20.0, 51, 3)


def flat() -> tuple[Any, Any, Any, Any]:
    """Return positions and components in the plane, (N,) each."""
    x, y = (part.ravel() for part in np.meshgrid(X, Y))
    return (x, y, *plane(x, y))


# --- a speed and its angle ----------------------------------------------------------------------


@form(says="angle.*counterclockwise")
def speed_and_angle_by_name() -> Any:
    u, v = plane(*np.meshgrid(X, Y))
    return {"x": X, "y": Y, "speed": np.hypot(u, v), "angle": np.arctan2(v, u)}, in_plane(X, Y)


@variants(["angle", "phase"], options={"direction": "turn", "components": "to"})
def speed_on_the_earth_with_a_named_direction(other: str) -> Any:
    """The only speed needs no name; another angle is no direction."""
    u, v = wind(*np.meshgrid(LON, LAT))
    turn = np.degrees(np.arctan2(u, v))
    named = {"lon": LON, "lat": LAT, "speed": np.hypot(u, v), "turn": turn, other: 0 * turn}
    return named, on_earth(LON, LAT)


@form(error="direction is 'course', and there is no such array", options={"direction": "course"})
def direction_that_is_missing() -> Any:
    return {"x": X, "y": Y, "speed": np.ones((9, 13)), "angle": np.ones((9, 13))}


@form(error="no two variables are recognised")
def speed_of_wind_and_an_angle_of_the_satellite() -> Any:
    """As of scatterometers, whose angle is not that of the wind."""
    values = np.ones((len(LAT), len(LON)))
    return {"lon": LON, "lat": LAT, "wind_speed": values, "incidence_angle": 40 * values}


# --- ASCII grids --------------------------------------------------------------------------------

CELLS = 0.1 + 0.2 * np.arange(12), 0.3 + 0.2 * np.arange(7)


def write_grids(folder: Path, corner: str, names: tuple[str, str]) -> Truth:
    """Write both components with a missing value, and return the truth."""
    pytest.importorskip("rioxarray")
    u, v = plane(*np.meshgrid(*CELLS))
    u[2, 3] = np.nan
    at = (0.0, 0.2) if corner == "corner" else (0.1, 0.3)
    for name, values in zip(names, (u, v), strict=True):
        rows = [" ".join(f"{value:.8g}" for value in row) for row in np.nan_to_num(values, nan=-99)]
        head = f"NCOLS 12\nNROWS 7\nXLL{corner.upper()} {at[0]}\nYLL{corner.upper()} {at[1]}\n"
        text = head + "CELLSIZE 0.2\nNODATA_value -99\n" + "\n".join(rows[::-1]) + "\n"
        (folder / name).write_text(text)
    truth = in_plane(*CELLS)
    lost = np.isnan(u).ravel()
    return Truth(truth.places[~lost], on_earth=False, flow=plane, speed_unit="")


@variants(["corner", "center"])
def ascii_grids_with_the(corner: str, folder: Path) -> Any:
    truth = write_grids(folder, corner, ("u.asc", "v.asc"))
    return [folder / "u.asc", folder / "v.asc"], truth


@form(error="one component of a velocity, 'u', but not the other one")
def one_ascii_grid(folder: Path) -> Any:
    write_grids(folder, "corner", ("u.asc", "v.asc"))
    return folder / "u.asc"


@form(error="mesh.vtu is no dataset or table.*a .pvd file")
def a_mesh_beside_an_ascii_grid(folder: Path) -> Any:
    write_grids(folder, "corner", ("u.asc", "v.asc"))
    (folder / "mesh.vtu").write_text("<VTKFile>")
    return [folder / "u.asc", folder / "mesh.vtu"]


# --- columns and zones --------------------------------------------------------------------------


@variants([".dat", ".tsv", ".csv"])
def columns_below_a_comment(ending: str, folder: Path) -> Any:
    """As ``np.savetxt`` writes them."""
    path = folder / f"flow{ending}"
    separator = {".dat": " ", ".tsv": "\t", ".csv": ","}[ending]
    header = separator.join("xyuv")
    np.savetxt(path, np.column_stack(flat()), delimiter=separator, header=header)
    return path, in_plane(X, Y)


ZONE = 'TITLE = "flow"\nVARIABLES = "X" "Y" "U" "V"\nZONE T="one", I=13, J=9, F=POINT\n'


@variants([".tec", ".dat", ".plt"])
def structured_zone_of_tecplot(ending: str, folder: Path) -> Any:
    path = folder / f"flow{ending}"
    np.savetxt(path, np.column_stack(flat()), header=ZONE.rstrip(), comments="")
    return path, in_plane(X, Y)


@form(error="a binary file of Tecplot.*ParaView")
def binary_file_of_tecplot(folder: Path) -> Any:
    path = folder / "flow.plt"
    path.write_bytes(b"#!TDV112" + bytes(200))
    return path


@form()
def columns_with_exponents_of_fortran(folder: Path) -> Any:
    path = folder / "flow.dat"
    rows = [" ".join(f"{value:.8e}" for value in row) for row in np.column_stack(flat())]
    path.write_text("\n".join(rows).replace("e", "D"))
    return path, in_plane(X, Y)


# --- points -------------------------------------------------------------------------------------

PLACES = np.random.default_rng(3).uniform(0, 1, (300, 3))


@variants(["Coordinates Velocities", "points velocity", "positions vel"])
def arrays_of_points_and_vectors(names: str) -> Any:
    """As h5py has them from snapshots of simulations; other arrays of the points are scalars."""
    places, vectors = names.split()
    u, v = plane(*PLACES[:, :2].T)
    arrays = {places: PLACES[:, :2], vectors: np.stack([u, v, 0 * u], axis=-1), "Density": u + v}
    scalars = {"Density": lambda x, y, t: sum(plane(x, y))}
    return arrays, at_points(PLACES[:, :2], scalars=scalars)


@form(error="the points fill a volume.*Choose a layer.*or drop z")
def points_in_a_volume() -> Any:
    return {"Coordinates": PLACES, "Velocities": PLACES}


@form()
def points_on_a_hill() -> Any:
    """Heights that depend on the place leave a surface, drawn from above."""
    x, y = PLACES[:, :2].T
    u, v = plane(x, y)
    columns = {"x": x, "y": y, "z": np.exp(-10 * (x - 0.5) ** 2), "u": u, "v": v}
    return pd.DataFrame(columns), at_points(PLACES[:, :2])


@form()
def columns_of_floris() -> Any:
    """Models of wakes of turbines: places x1, x2 and x3, the height of the plane."""
    x, y, u, v = flat()
    columns = {"x1": x, "x2": y, "x3": 90 + 0 * x, "u": u, "v": v, "w": 0 * u}
    return pd.DataFrame(columns), in_plane(X, Y)


@form(says="direction from")
def columns_of_a_weather_service() -> Any:
    """Open-Meteo and others: the height is behind the speed, and units are in brackets."""
    lon, lat = (part.ravel() for part in np.meshgrid(LON, LAT))
    u, v = wind(lon, lat)
    columns = {
        "longitude": lon,
        "latitude": lat,
        "wind_speed_10m (km/h)": 3.6 * np.hypot(u, v),
        "wind_direction_10m (°)": np.degrees(np.arctan2(-u, -v)) % 360,
    }
    return pd.DataFrame(columns), on_earth(LON, LAT)


# --- columns of dates, and rows that end with a separator ---------------------------------------


@form()
def columns_of_years_months_days_and_hours() -> Any:
    lon, lat = (part.ravel() for part in np.meshgrid(LON, LAT))
    parts = []
    for hour in (0, 6):
        u, v = wind(lon, lat, hour)
        date = {"Year": 2024, "Month": 1, "Day": 1, "Hour": hour}
        parts.append(pd.DataFrame({**date, "Lat": lat, "Long": lon, "U_COMP": u, "V_COMP": v}))
    return pd.concat(parts), on_earth(LON, LAT, (0.0, 6.0))


@form()
def rows_that_end_with_a_separator(folder: Path) -> Any:
    """Without a last end of line."""
    path = folder / "flow.csv"
    rows = [",".join(f"{value:.8g}" for value in row) + "," for row in np.column_stack(flat())]
    path.write_text("\n".join(["x,y,u,v,", *rows]))
    return path, in_plane(X, Y)


@variants([-9999.0, 1e20])
def one_missing_value_that_is_not_declared(fill: float) -> Any:
    ds = earth(LON, LAT)
    ds.u[3, 4] = fill
    lost = np.zeros(ds.u.shape, dtype=bool)
    lost[3, 4] = True
    return ds, without(on_earth(LON, LAT), lost)
