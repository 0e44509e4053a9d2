"""Text files of image velocimetry and of solvers, each with the flow in the plane."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from known_flow import Truth, in_plane, on_earth, plane, wind, without
from supported import Made, supported

X = np.linspace(0.0, 2.0, 13)
Y = np.linspace(0.0, 1.0, 9)
KIND = "Image velocimetry"
SOLVERS = "Tables of solvers"


def rows(time: float = 0.0) -> tuple[Any, Any, Any, Any]:
    """Return the places and the components at all nodes, (N,) each."""
    x, y = (part.ravel() for part in np.meshgrid(X, Y))
    return (x, y, *plane(x, y, time))


def text(columns: Iterable[Any], separator: str = " ", decimal: str = ".") -> str:
    """Return rows of numbers as text."""
    lines = []
    for values in zip(*columns, strict=True):
        words = [f"{value:.9g}".replace(".", decimal) for value in values]
        lines.append(separator.join(words) + "\n")
    return "".join(lines)


def truth(**more: Any) -> Truth:
    return in_plane(X, Y, **more)


@supported(
    KIND,
    "OpenPIV: `x y u v flags mask`",
    'flowtex.show("openpiv.txt")',
    "rows of a lattice become a grid; flagged and masked vectors are left out",
)
def openpiv(folder: Path) -> Made:
    x, y, u, v = rows()
    flags, mask = (np.arange(len(x)) == number for number in (20, 50))
    u[20] = v[50] = 99.0
    head = "# x\ty\tu\tv\tflags\tmask\n"
    (folder / "openpiv.txt").write_text(head + text((x, y, u, v, flags, mask), "\t"))
    return {}, without(truth(), flags | mask)


@supported(
    KIND,
    "OpenPIV, earlier versions: `x y u v mask`",
    'flowtex.show("image.bmp.txt")',
    "vectors with mask 1, which the validation rejected, are left out",
)
def early_openpiv(folder: Path) -> Made:
    x, y, u, v = rows()
    rejected = np.arange(len(x)) == 20
    u[20] = 99.0
    head = "# x\ty\tu\tv\tmask\n"
    (folder / "image.bmp.txt").write_text(head + text((x, y, u, v, rejected), "\t"))
    return {}, without(truth(), rejected)


@supported(
    KIND,
    "OpenPIV and others, without a header",
    'flowtex.show("piv.txt")',
    "columns are taken as x, y, u, v, and a flag or the ratio of signal to noise",
)
def piv_without_header(folder: Path) -> Made:
    x, y, u, v = rows()
    flag = np.arange(len(x)) == 30
    u[30] = 99.0
    (folder / "piv.txt").write_text(text((x, y, u, v, flag)))
    return {}, without(truth(), flag)


@supported(
    KIND,
    "PIVlab",
    'flowtex.show("PIVlab_0001.txt")',
    "units in brackets; vectors of type 0 are left out",
)
def pivlab(folder: Path) -> Made:
    x, y, u, v = rows()
    kind = np.where(np.arange(len(x)) == 40, 0, 1)
    head = (
        "PIVlab by W.Th. & E.J.S., ASCII chart output - 04-Mar-2024 10:11:12\n"
        "FRAME: 1, filenames: A.png & B.png, conversion factor xy (px -> m): 1\n"
        "x [px],y [px],u [px/frame],v [px/frame],Vector type [-]\n"
    )
    (folder / "PIVlab_0001.txt").write_text(head + text((x, y, u, v, kind), ","))
    true = replace(truth(unit="px"), speed_unit="px/frame")
    return {}, without(true, kind == 0)


@supported(
    KIND,
    "DaVis",
    'flowtex.show("B00001.txt")',
    "units of the header and decimal commas; zero vectors are left out",
)
def davis(folder: Path) -> Made:
    x, y, u, v = rows()
    lost = np.arange(len(x)) == 7
    u[7] = v[7] = 0.0
    head = '#DaVis 8.1.6 2D-vector 32 9 13 "position" "mm" "position" "mm" "velocity" "mm/s"\n'
    (folder / "B00001.txt").write_text(head + text((x, y, u, v), "\t", ","))
    return {}, without(replace(truth(unit="mm"), speed_unit="mm/s"), lost)


@supported(
    SOLVERS,
    "COMSOL: exported text, also with columns for each time",
    'flowtex.show("comsol.txt")',
    "header lines with `%`; columns of a time become steps",
)
def comsol(folder: Path) -> Made:
    x, y, *first = rows()
    later = rows(2.0)[2:]
    head = "% Model:   flow.mph\n% Dimension:   2\n% Length unit:   mm\n"
    names = [f"{name} (mm/s) @ t={time}" for time in (0, 2) for name in "uv"]
    head += "% x      y      " + "   ".join(names) + "\n"
    (folder / "comsol.txt").write_text(head + text((x, y, *first, *later), "   "))
    return {}, replace(truth(times=(0.0, 2.0), unit="mm"), speed_unit="mm/s")


@supported(
    SOLVERS,
    "Star-CCM+: table of a plane",
    'flowtex.show("star.csv")',
    "`Velocity[i]` and `Velocity[j]` are the components along x and y",
)
def star(folder: Path) -> Made:
    x, y, u, v = rows()
    names = [f"Velocity[{letter}] (m/s)" for letter in "ijk"]
    head = ",".join(f'"{name}"' for name in (*names, "X (m)", "Y (m)", "Z (m)")) + "\n"
    zero = np.zeros_like(u)
    (folder / "star.csv").write_text(head + text((u, v, zero, x, y, zero), ","))
    return {}, replace(truth(unit="m"), speed_unit="m/s")


@supported(
    SOLVERS,
    "ANSYS Fluent: ASCII export",
    'flowtex.show("fluent.csv")',
    "`x-coordinate`, `x-velocity` and their partners",
)
def fluent(folder: Path) -> Made:
    x, y, u, v = rows()
    head = "nodenumber,    x-coordinate,    y-coordinate,      x-velocity,      y-velocity\n"
    (folder / "fluent.csv").write_text(head + text((np.arange(len(x)), x, y, u, v), ","))
    return {}, truth()


@supported(
    SOLVERS,
    "ANSYS CFX: export with `[Data]`",
    'flowtex.show("cfx.csv")',
    "the section of data; faces are not read",
)
def cfx(folder: Path) -> Made:
    x, y, u, v = rows()
    head = "\n[Name]\nPlane 1\n\n[Data]\n"
    head += "X [ m ], Y [ m ], Z [ m ], Velocity u [ m s^-1 ], Velocity v [ m s^-1 ]\n"
    faces = "\n[Faces]\n0, 1, 14, 13\n1, 2, 15, 14\n"
    (folder / "cfx.csv").write_text(head + text((x, y, 0 * x, u, v), ", ") + faces)
    return {}, replace(truth(unit="m"), speed_unit="m/s")


@supported(
    SOLVERS,
    "ParaView: spreadsheet of points",
    'flowtex.show("paraview.csv")',
    "`Points:0` and `U:0` are x and the component along x",
)
def paraview(folder: Path) -> Made:
    x, y, u, v = rows()
    names = [f"{vector}:{number}" for vector in ("U", "Points") for number in range(3)]
    head = ",".join(f'"{name}"' for name in ("p", *names)) + "\n"
    (folder / "paraview.csv").write_text(head + text((x, u, v, 0 * u, x, y, 0 * x), ","))
    return {}, truth()


@supported(
    SOLVERS,
    "OpenFOAM: sampled surface in raw format, or `.xy`",
    'flowtex.show("U_cutPlane.raw")',
    "`x y z U_x U_y U_z`, on a plane of x and y",
)
def sampled_by_openfoam(folder: Path) -> Made:
    x, y, u, v = rows()
    zero = 0 * x
    head = f"# U  POINT_DATA {len(x)}\n#  x  y  z  U_x  U_y  U_z\n"
    (folder / "U_cutPlane.raw").write_text(head + text((x, y, zero, u, v, zero), " "))
    return {}, truth()


@supported(
    "Points",
    "CODAR: totals of radars",
    'flowtex.show("TOTL_2024.tuv")',
    "`LOND`, `LATD`, and `VELU`, `VELV` in cm/s",
)
def totals_of_codar(folder: Path) -> Made:
    lon, lat = (a.ravel() for a in np.meshgrid(np.arange(-75, -72, 0.25), np.arange(36, 39, 0.25)))
    u, v = wind(lon, lat)
    head = (
        '%CTF: 1.00\n%FileType: LLUV tots "CurrentMap"\n%TableType: LLUV TOT4\n'
        "%TableColumns: 5\n%TableColumnTypes: LOND LATD VELU VELV VFLG\n%TableStart:\n"
        "%%   Longitude   Latitude    U comp   V comp  VectorFlag\n"
        "%%     (deg)       (deg)     (cm/s)   (cm/s)  (GridCode)\n"
    )
    table = text((lon, lat, 100 * u, 100 * v, 0 * lon), "  ")
    (folder / "TOTL_2024.tuv").write_text(head + table + "%TableEnd:\n%%\n%End:\n")
    return {}, on_earth(lon[None], lat[None])
