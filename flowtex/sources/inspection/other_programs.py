"""Files that other packages read: what they are, and a line of code that draws them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex.sources.inspection.tecplot_files import is_tecplot_text

if TYPE_CHECKING:
    import h5py

#: Description of a file by its ending, and a line that draws it; ``{name}`` is its name.
LINES = {
    ".ovf": (
        "an OVF file of micromagnetics",
        'flowtex.show(discretisedfield.Field.from_file("{name}").to_xarray())',
    ),
    ".mat": (
        "a MATLAB file",
        'flowtex.show(scipy.io.loadmat("{name}")), whose arrays have names such as x, y, u and v; '
        'vectors="a,b" names other components',
    ),
    ".npy": (
        "an array of NumPy without positions",
        "flowtex.show(flowtex.FlowField.from_arrays((x, y), "
        'numpy.load("{name}"))) with velocities of the shape (len(y), len(x), 2)',
    ),
    ".npz": (
        "an archive of NumPy arrays",
        'flowtex.show(numpy.load("{name}")), whose arrays have names such as x, y, u and v; '
        'vectors="a,b" names other components',
    ),
    ".parquet": ("a table of Parquet", 'flowtex.show(pandas.read_parquet("{name}"))'),
    ".feather": ("a table of Arrow", 'flowtex.show(pandas.read_feather("{name}"))'),
    ".xlsx": ("a spreadsheet", 'flowtex.show(pandas.read_excel("{name}"))'),
    ".shp": ("a shapefile", 'flowtex.show(geopandas.read_file("{name}"))'),
    ".gpkg": ("a GeoPackage", 'flowtex.show(geopandas.read_file("{name}"))'),
    ".sim": (
        "a simulation of Simcenter STAR-CCM+",
        'File, Export in STAR-CCM+ with the type EnSight Gold, and flowtex.show("flow.case")',
    ),
    ".mph": (
        "a model of COMSOL",
        'Results, Export, Data in COMSOL with the file type VTK, and flowtex.show("flow.vtu")',
    ),
    ".plt": (
        "a binary file of Tecplot",
        'File, Save Data in ParaView with the ending .vtm, and flowtex.show("flow.vtm")',
    ),
    ".im7": (
        "an image of DaVis",
        'export vectors as text in DaVis, and flowtex.show("B00001.txt")',
    ),
    ".vc7": (
        "a vector field of DaVis",
        'export it as text in DaVis, and flowtex.show("B00001.txt")',
    ),
}
#: Endings of images.
IMAGES = (".png", ".jpg", ".jpeg", ".bmp", ".gif")
#: Endings of the same formats.
ALIKE = {
    ".omf": ".ovf",
    ".arrow": ".feather",
    ".xls": ".xlsx",
    ".ccm": ".sim",
    ".szplt": ".plt",
}
#: Endings of HDF5.
HDF5 = (".h5", ".hdf5", ".hdf", ".he5")
#: Groups of HDF5 that PyVista's readers know: VTK, and Common Fluids Format of Fluent.
OF_READERS = ("VTKHDF", "meshes")
#: Most arrays that a message lists.
MOST_LISTED = 6


def advice_of(path: Path) -> str:
    """Return what a file is that another package reads, and how; empty for other files.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    str
        One or two sentences with a line of code to type.
    """
    suffix = path.suffix.lower()
    if is_tecplot_text(path):
        return ""
    if suffix in HDF5:
        return _of_hdf5(path)
    if suffix in IMAGES:
        return (
            "this is an image, which has colours and no velocity. The flow between two images is "
            "v, u = skimage.registration.optical_flow_tvl1(first, second)"
        )
    found = LINES.get(ALIKE.get(suffix, suffix))
    if found is None:
        return ""
    what, line = found
    return f"this is {what}, which flowtex does not open itself; use {line.format(name=path)}"


def _of_hdf5(path: Path) -> str:
    import h5py

    try:
        with h5py.File(path, "r", locking=False) as file:
            return _of_content(path, file)
    except (OSError, RuntimeError, KeyError, ValueError):
        return ""  # the check of the file has the error


def _of_content(path: Path, file: h5py.File) -> str:
    if any(group in file for group in OF_READERS):
        return ""
    if "openPMD" in file.attrs:
        return _of_openpmd(path, file)
    if _text(file.attrs.get("type", "")).startswith("discretisedfield"):
        line = f'discretisedfield.Field.from_file("{path.name}").to_xarray()'
        return f"this is a field of discretisedfield; use flowtex.show({line})"
    if _text(file.attrs.get("File Type", "")).startswith("HEC-RAS"):
        return (
            "this is a file of HEC-RAS, which has only the component of the velocity normal to "
            "each face. Fit the velocity of each cell to its faces, as in u, v = "
            "numpy.linalg.lstsq(normals, speeds)[0], and draw it with "
            "flowtex.show(flowtex.FlowField.from_triangles(points, triangles, velocity))"
        )
    return _of_arrays(path, file)


def _text(value: Any) -> str:
    """Return an attribute as text, which some programs write as bytes."""
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    return str(value)


def _of_openpmd(path: Path, file: h5py.File) -> str:
    """Return how to get the arrays of a vector of openPMD."""
    vectors = []

    def add(name: str, item: Any) -> None:
        if "axisLabels" in item.attrs and hasattr(item, "keys"):
            vectors.append((name, item))

    file.visititems(add)
    if not vectors:
        return "this is a file of openPMD without fields; only fields on grids are drawn"
    name, record = vectors[0]
    labels = list(map(_text, record.attrs["axisLabels"]))
    if len(labels) != 2:
        return (
            f"this is a file of openPMD with {len(labels)} axes; select a plane with openpmd-viewer"
        )
    rows, columns = labels
    line = (
        f'E = h5py.File("{path.name}")["{name}"], and flowtex.show(flowtex.FlowField.from_arrays('
        f'({columns}, {rows}), numpy.stack([E["{columns}"], E["{rows}"]], axis=-1)))'
    )
    return (
        f"this is a file of openPMD, which flowtex does not open itself; use {line}. Its "
        "attributes gridSpacing, gridGlobalOffset and position give the positions of the values"
    )


def _of_arrays(path: Path, file: h5py.File) -> str:
    arrays: list[str] = []
    places: list[str] = []

    def add(name: str, item: Any) -> None:
        shape = getattr(item, "shape", ())
        if len(shape) >= 2:
            arrays.append(f"{name} ({' x '.join(map(str, shape))})")
        elif shape:
            places.append(f"{name} ({shape[0]})")

    file.visititems(add)
    found = [*arrays, *places]
    listed = ", ".join(found[:MOST_LISTED])
    more = len(found) - MOST_LISTED
    if more > 0:
        listed += f" and {more} more"
    if not arrays:
        return f"this HDF5 file has no array of two axes; its arrays are {listed or 'none'}"
    name = found[0].rpartition(" (")[0]
    return (
        f"this HDF5 file follows no convention that is known; its arrays are {listed}. Draw them "
        f'with file = h5py.File("{path.name}"), and flowtex.show(x, y, u, v) with arrays of this '
        f'file, such as file["{name}"][:]'
    )
