"""Files that lie: what they declare is not what they have, or lies elsewhere."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from cfd_files import box, write_ensight

#: Sides of the grids: few nodes, of which all values differ.
ROWS, COLUMNS = 6, 9


def hdf5_axes(file: Any) -> None:
    """Write the coordinates of a map of ROWS by COLUMNS."""
    for name, count, unit in (("lat", ROWS, "degrees_north"), ("lon", COLUMNS, "degrees_east")):
        axis = file.create_dataset(name, data=np.linspace(10.0, 20.0, count))
        axis.make_scale(name)
        axis.attrs["units"] = np.bytes_(unit)


def hdf5_component(file: Any, name: str, **options: Any) -> None:
    """Write a component of the wind; options are those of h5py's ``create_dataset``."""
    values = {"data": np.ones((ROWS, COLUMNS), "f4")} if not options else {}
    wind = file.create_dataset(
        name, **{"shape": (ROWS, COLUMNS), "dtype": "f4", **values, **options}
    )
    wind.dims[0].attach_scale(file["lat"])
    wind.dims[1].attach_scale(file["lon"])
    wind.attrs["standard_name"] = np.bytes_(f"{'east' if name == 'u' else 'north'}ward_wind")


def external_storage(path: Path, secret: Path) -> None:
    """Write a NetCDF-4 file whose eastward wind are the bytes of another file."""
    import h5py

    with h5py.File(path, "w", track_order=True) as file:
        hdf5_axes(file)
        nbytes = 4 * ROWS * COLUMNS
        hdf5_component(file, "u", external=[(str(secret), 0, nbytes)])
        hdf5_component(file, "v")


def external_link(path: Path, secret: Path) -> None:
    """Write a file with a group that lies in another file."""
    import h5py

    with h5py.File(path, "w", track_order=True) as file:
        hdf5_axes(file)
        hdf5_component(file, "u")
        hdf5_component(file, "v")
        file.create_group("deep")["link"] = h5py.ExternalLink(str(secret), "/")


def virtual_dataset(path: Path, secret: Path) -> None:
    """Write a file whose eastward wind is a virtual dataset of another file."""
    import h5py

    with h5py.File(path, "w", track_order=True) as file:
        hdf5_axes(file)
        layout = h5py.VirtualLayout((ROWS, COLUMNS), "f4")
        layout[:] = h5py.VirtualSource(str(secret), "x", (ROWS, COLUMNS))
        file.create_virtual_dataset("u", layout)
        hdf5_component(file, "v")


def large_chunk(path: Path) -> None:
    """Write a file of a few kB with one chunk of 32 MB."""
    import h5py

    with h5py.File(path, "w", track_order=True) as file:
        hdf5_axes(file)
        hdf5_component(file, "u", shape=(2000, 4000), chunks=(2000, 4000), compression="gzip")
        hdf5_component(file, "v")


def vtu(points: int, connected: int = 3) -> bytes:
    """Return an unstructured grid of one triangle that declares any number of points."""
    arrays = b"".join(
        struct.pack("<I", len(data)) + data
        for data in (
            np.zeros(9, "<f8").tobytes(),
            np.arange(3, dtype="<i8").tobytes(),
            np.array([connected], "<i8").tobytes(),
            b"\x05",
        )
    )
    head = f"""<?xml version="1.0"?><VTKFile type="UnstructuredGrid" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="{points}" NumberOfCells="1"><Points>
<DataArray type="Float64" NumberOfComponents="3" format="appended" offset="0"/></Points><Cells>
<DataArray type="Int64" Name="connectivity" format="appended" offset="76"/>
<DataArray type="Int64" Name="offsets" format="appended" offset="104"/>
<DataArray type="UInt8" Name="types" format="appended" offset="116"/></Cells></Piece>
</UnstructuredGrid><AppendedData encoding="raw">_"""
    return head.encode() + arrays + b"</AppendedData></VTKFile>"


def image(extent: str, values: str = "1 2 3") -> bytes:
    """Return an image as VTK's XML with few values."""
    return f"""<VTKFile type="ImageData"><ImageData WholeExtent="{extent}"><Piece Extent="{extent}">
<PointData><DataArray type="Float64" Name="velocity" NumberOfComponents="3" format="ascii">{values}
</DataArray></PointData></Piece></ImageData></VTKFile>""".encode()


def legacy(declared: str, values: str = "1 2 3") -> bytes:
    """Return a legacy file of VTK."""
    return f"# vtk DataFile Version 3.0\ntitle\nASCII\n{declared}\n{values}\n".encode()


def write_crashing(path: Path) -> None:
    """Write an EnSight case by which VTK writes outside of its memory: a part does not exist."""
    write_ensight(path, [("Tip", box(4, 3, 1))], times=(0.5,))
    values = path.with_suffix(".velocity000")
    text = values.read_text(encoding="ascii")
    values.write_text(text.replace(f"{1:10d}", f"{2**31 - 1:10d}", 1), encoding="ascii")


def winds(columns: int, rows: int, values: int = 4) -> bytes:
    """Return winds as JSON that declare a grid and have few values."""
    header = {"nx": columns, "ny": rows, "lo1": 0, "la1": 0, "dx": 1, "dy": 1}
    return json.dumps(
        [{"header": header | {"parameterNumber": n}, "data": [1.0] * values} for n in (2, 3)]
    ).encode()


def netcdf_header(version: int, length: int) -> bytes:
    """Return NetCDF classic of one variable of this many bytes, without any of them."""
    number = ">Q" if version == 5 else ">I"

    def count(value: int) -> bytes:
        return struct.pack(number, value)

    def tag(kind: int, entries: int) -> bytes:
        return struct.pack(">I", kind) + count(entries)

    name = count(1) + b"x\0\0\0"
    begin = struct.pack(">I" if version == 1 else ">Q", 200)
    variable = name + count(1) + count(0) + tag(0, 0) + struct.pack(">I", 1) + count(8) + begin
    head = b"CDF" + bytes([version]) + count(0) + tag(10, 1) + name + count(length)
    return head + tag(0, 0) + tag(11, 1) + variable


def grib2(points: int) -> bytes:
    """Return the head of a message of GRIB 2 whose grid has this many points, and no more of it."""
    grid = struct.pack(">IBBIBBH", 72, 3, 0, points, 0, 0, 0) + bytes(58)
    content = struct.pack(">IB", 21, 1) + bytes(16) + grid + b"7777"
    return b"GRIB\0\0\0\x02" + struct.pack(">Q", 16 + len(content)) + content


def grib2_without_data() -> bytes:
    """Return messages of which the first has the number of another section on its values."""
    messages = bytearray(grib(2))
    place = 16
    while messages[place + 4] != 7:
        place += int.from_bytes(messages[place : place + 4], "big")
    messages[place + 4] = 5
    return bytes(messages)


def grib(
    edition: int, *, packed: int = 12, bits: int | None = None, latitude: float | None = None
) -> bytes:
    """Return two messages of winds; ``bits`` and ``latitude`` replace the true declarations."""
    import eccodes

    messages = b""
    for number in (165, 166):
        message = eccodes.codes_grib_new_from_samples(f"regular_ll_sfc_grib{edition}")
        name = {165: "10u", 166: "10v"}[number]
        key = ("indicatorOfParameter", number) if edition == 1 else ("shortName", name)
        eccodes.codes_set(message, *key)
        count = eccodes.codes_get(message, "numberOfDataPoints")
        eccodes.codes_set(message, "bitsPerValue", packed)
        eccodes.codes_set_values(message, np.linspace(number, number + (packed > 0), count))
        places = {
            key: eccodes.codes_get_offset(message, key)
            for key in ("bitsPerValue", "latitudeOfFirstGridPoint")
        }
        data = bytearray(eccodes.codes_get_message(message))
        eccodes.codes_release(message)
        if bits is not None:
            data[places["bitsPerValue"]] = bits
        if latitude is not None:
            width, unit = (3, 1e3) if edition == 1 else (4, 1e6)
            at = places["latitudeOfFirstGridPoint"]
            data[at : at + width] = round(latitude * unit).to_bytes(width, "big")
        messages += bytes(data)
    return messages


def zarr_of_a_size(path: Path, version: int, **declared: Any) -> None:
    """Write a Zarr folder of a wind, and then what it declares of its arrays."""
    import xarray as xr

    lat, lon = np.linspace(0, 9, ROWS), np.linspace(0, 9, COLUMNS)
    wind = np.ones((ROWS, COLUMNS), "f4")
    words = [{"standard_name": f"{axis}ward_wind", "units": "m/s"} for axis in ("east", "north")]
    data = {"u": (("lat", "lon"), wind, words[0]), "v": (("lat", "lon"), wind, words[1])}
    axes = {"lat": ("lat", lat, {"units": "degrees_north"})}
    axes["lon"] = ("lon", lon, {"units": "degrees_east"})
    xr.Dataset(data, axes).to_zarr(path, zarr_format=version, consolidated=version == 2)
    for file in (*path.rglob("zarr.json"), *path.rglob(".z*")):
        told = json.loads(file.read_text())
        many = told.get("metadata", {file.parent.name + "/": told})
        for name, one in many.items():
            if (wanted := declared.get(name.partition("/")[0])) and "shape" in one:
                one["shape"] = wanted
                if "chunks" in one:
                    one["chunks"] = wanted
                else:
                    one["chunk_grid"]["configuration"]["chunk_shape"] = wanted
        file.write_text(json.dumps(told))
