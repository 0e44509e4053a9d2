"""Formats of other programs that flowtex recognises but does not read: each with the remedy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flowtex.errors import FieldError

#: Programs by the suffixes of their files, and by the first bytes.
SUFFIXES = {".slf": "TELEMAC", ".selafin": "TELEMAC", ".omf": "OVF", ".ovf": "OVF"}
BEGINNINGS = {b"# OOMMF": "OVF"}
#: Programs by an attribute of the root of HDF5, and the beginning of its value.
ATTRIBUTES = {
    "File Type": ("HEC-RAS", "HEC-RAS"),
    "openPMD": ("", "openPMD"),
    "discretisedfield.__version__": ("", "discretisedfield"),
}
#: What files contain, and how to draw it.
REMEDIES = {
    "TELEMAC": (
        "a SELAFIN file of TELEMAC; install xarray-selafin, and pass the dataset of "
        "xarray.open_dataset(path, engine='selafin')"
    ),
    "OVF": (
        "an OVF file of micromagnetics; install discretisedfield, and pass the array of "
        "discretisedfield.Field.from_file(path).to_xarray()"
    ),
    "discretisedfield": (
        "a field of discretisedfield; install it, and pass the array of "
        "discretisedfield.Field.from_file(path).to_xarray()"
    ),
    "HEC-RAS": (
        "a file of HEC-RAS, which stores only the velocity normal to each face, not vectors. The "
        "vector w of a cell follows from its faces, with the unit normals n ('Faces "
        "NormalUnitVector and Length') and the velocities q ('Face Velocity'), by least squares: "
        "w = numpy.linalg.lstsq(n, q)[0]. Pass a table with x, y ('Cells Center Coordinate'), u "
        "and v of the cells"
    ),
    "openPMD": (
        "a file of openPMD; read its arrays with openpmd-api or openpmd-viewer, as in "
        "OpenPMDTimeSeries(folder).get_field(field='E', coord='x', iteration=n), average "
        "components that lie half a cell apart, and pass an xarray Dataset of both"
    ),
}


def check_other(path: Path, head: bytes) -> None:
    """Raise a FieldError for a file of another program, by its name and its first bytes."""
    programs = (name for begin, name in BEGINNINGS.items() if head.startswith(begin))
    if program := next(programs, SUFFIXES.get(path.suffix.lower())):
        _refuse(program)


def check_attributes(attributes: Any) -> None:
    """Raise a FieldError for HDF5 of another program, by the attributes of its root."""
    for name, (begin, program) in ATTRIBUTES.items():
        if name in attributes:
            value = attributes[name]
            text = value.decode(errors="replace") if isinstance(value, bytes) else str(value)
            if text.startswith(begin):
                _refuse(program)


def _refuse(program: str) -> None:
    msg = f"this is {REMEDIES[program]}"
    raise FieldError(msg)
