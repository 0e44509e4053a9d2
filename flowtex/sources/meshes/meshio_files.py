"""Files of meshes that meshio reads and PyVista does not, such as those of Gmsh."""

from __future__ import annotations

import io
import warnings
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex.errors import FieldError, import_package
from flowtex.sources.inspection.exodus_files import is_of_meshio

if TYPE_CHECKING:
    import pyvista as pv

#: Endings of files that only meshio reads: Gmsh, SALOME, MOAB, SU2, Medit, Nastran, AVS.
SUFFIXES = (".msh", ".med", ".h5m", ".su2", ".mesh", ".bdf", ".nas", ".avs")
#: The ending of AVS UCD, which PyVista reads, and of Abaqus.
ABAQUS_SUFFIX = ".inp"
#: First character of files of Abaqus, where AVS has a number or a comment.
ABAQUS = b"*"
#: Endings of Exodus, which PyVista reads unless meshio wrote it.
EXODUS_SUFFIXES = (".e", ".ex2", ".exii", ".exo")
#: Sign in the names of tags that meshio makes of groups of cells, as in ``su2:tag``.
TAG = ":"
#: Bytes that are read of a file to tell them apart.
HEAD_BYTES = 80


def is_meshio_file(path: Path) -> bool:
    """Return whether a file is one that meshio reads and PyVista does not."""
    suffix = path.suffix.lower()
    if suffix in EXODUS_SUFFIXES:
        return is_of_meshio(path)
    if suffix != ABAQUS_SUFFIX:
        return suffix in SUFFIXES
    with path.open("rb") as file:
        return file.read(HEAD_BYTES).lstrip().startswith(ABAQUS)


def read_meshio(path: Path) -> pv.UnstructuredGrid:
    """Read a file with meshio.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    pyvista.UnstructuredGrid
        The mesh, with all arrays of nodes and cells.

    Raises
    ------
    ModuleNotFoundError
        If meshio is not installed.
    FieldError
        For a file that meshio cannot read, or that has a mesh without arrays.
    """
    meshio = import_package("meshio", f"a {path.suffix} file")
    messages = io.StringIO()
    try:
        # meshio prints its errors, and ends the process.
        with redirect_stderr(messages), redirect_stdout(messages), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of deprecated calls of NumPy
            mesh = meshio.read(path)
    except SystemExit as error:
        reason = " ".join(messages.getvalue().split())
        raise FieldError(f"meshio cannot read it: {reason}") from error
    if all(TAG in name for name in (*mesh.point_data, *mesh.cell_data)):
        raise FieldError(
            "it has a mesh without arrays, so there is no velocity. Open the file of the solution "
            "instead, or add the velocity to the mesh, as in "
            f'mesh = pyvista.read_meshio("{path.name}"); mesh["velocity"] = ...'
        )
    return of_meshio(mesh)


def of_meshio(mesh: Any) -> pv.UnstructuredGrid:
    """Return a mesh of meshio as one of PyVista."""
    import pyvista as pv

    return pv.from_meshio(mesh)
