"""Formats of surfaces that cannot store vectors, with vectors in a file beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.sources.meshes.parts import TimeStep
from flowtex.sources.meshes.vectors import candidates

#: Endings of such files.
SUFFIXES = (".obj", ".ply", ".stl")
#: Name of the vectors.
NAME = "velocity"


def read_with_vectors(file: Path) -> tuple[Any, str | None, str]:
    """Return the mesh of a file, or its time steps, with vectors, their name, and the problem.

    They are in ``NAME.npy``, in the order of points or triangles of the reader; points of an STL
    may be three for each triangle, as in the file, or one for each place, as in PyVista.
    """
    import pyvista as pv

    reader: Any = pv.get_reader(str(file))
    mesh = reader.read()
    if candidates(mesh):
        return mesh, None, ""
    path, is_stl = file.with_suffix(".npy"), file.suffix.lower() == ".stl"
    points, cells = mesh.n_points, mesh.n_cells
    vectors, problem = _vectors(path)
    if vectors.shape[-2] == 3 * cells != points and is_stl:
        reader.reader.SetMerging(0)
        mesh = reader.read()
    if not problem and vectors.shape[-2] not in (mesh.n_points, cells):
        problem = f"{path.name} has shape {vectors.shape}"
    if problem:
        corners = f", ({3 * cells}, 3) for the corners of the faces" if is_stl else ""
        places = f"({points}, 3) for the points, ({cells}, 3) for the faces{corners}"
        text = f"{problem}; expected them in {path.name} in the same folder, written by numpy.save"
        text += f": numbers of shape {places}, or (T, {points}, 3) for times, in the order of the"
        return mesh, None, f"{text} file"

    def with_vectors(step: AnyArray) -> Any:
        copy = mesh.copy(deep=False)
        data = copy.point_data if len(step) == mesh.n_points else copy.cell_data
        data[NAME] = step
        return copy

    if vectors.ndim == 2:
        return with_vectors(vectors), NAME, ""
    steps = [TimeStep(with_vectors(v), float(n), f"step {n}") for n, v in enumerate(vectors)]
    return steps, NAME, ""


def _vectors(path: Path) -> tuple[AnyArray, str]:
    """Return the array beside a file, (N, 2 or 3) or (T, N, 2 or 3), and the problem with it."""
    nothing = np.empty((0, 3))
    if not path.is_file():
        return nothing, "the file has no vectors, because its format cannot store them"
    try:
        # Mapped first: NumPy allocates the declared size even if the file is shorter.
        vectors = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError, OSError) as error:
        return nothing, f"{path.name} is not a NumPy array ({error})"
    if not isinstance(vectors, np.ndarray):  # an archive
        return nothing, f"{path.name} contains several arrays"
    real = vectors.dtype.kind in "fiu" and vectors.size
    if not real or vectors.ndim not in (2, 3) or vectors.shape[-1] not in (2, 3):
        return nothing, f"{path.name} has shape {vectors.shape} and type {vectors.dtype}"
    return np.array(vectors), ""
