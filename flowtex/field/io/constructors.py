"""How a field is made of a mesh, of a file and of datasets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, cast

from numpy.typing import ArrayLike

from flowtex.field.io.arrays import FieldArrays

if TYPE_CHECKING:
    import xarray as xr


class FieldConstructors:
    """Class methods that read something and make a field of what it gives."""

    @classmethod
    def of(cls, arrays: FieldArrays) -> Self:
        """Return the field of what a source gives."""
        raise NotImplementedError

    @classmethod
    def from_pyvista(
        cls,
        mesh: Any,
        *,
        vectors: str | None = None,
        plane: str | None = None,
        slice: Any = None,
        contour: Any = None,
        times: ArrayLike | None = None,
        periodic: str | None = None,
        name: str = "",
        sign_free: bool = False,
        block: int | str | None = None,
    ) -> Self:
        """Make a field from a PyVista mesh, or from a series of them.

        Parameters
        ----------
        mesh
            A StructuredGrid, RectilinearGrid or ImageData, drawn in rows and columns; or a
            PolyData or an UnstructuredGrid, whose surface is drawn as triangles. Of a volume that
            is the outer surface, unless it is cut. A MultiBlock with one structured block, or one
            volume, stands for that block; the surfaces of others are drawn together. A list or
            tuple of meshes, a MultiBlock of several with the same nodes, and a PyVista reader with
            time values are time steps.
        vectors
            Name of the velocity on points or cells, with 2 or 3 components. By default the only
            array that can be the velocity, or the one that the mesh marks as its active vectors.
            Two or three arrays of one component are named with commas between, as in
            ``"u,v,w"``, and found where there is no array of vectors, if their names differ in the
            component alone, such as ``X Velocity``, ``Y Velocity`` and ``Z Velocity``.
        plane
            Surface to draw from a mesh of three dimensions: ``"k=20"``, ``"j=0"`` or ``"i=-1"``,
            counted from the end when negative. On a k-plane the surface's (i, j) are the mesh's
            (i, j), on a j-plane (i, k), on an i-plane (j, k). A mesh with one flat index
            direction needs none, and follows the same table.
        slice
            Plane through a volume of any kind, drawn as triangles: ``"x=0.5"``, a normal such as
            ``"1,1,0"``, one with a point as in ``"1,1,0 through 0.5,0.5,0.2"``, or a pair of both.
            It goes through the middle of the mesh where there is no point, and through all volumes
            of a MultiBlock where no block is chosen.
        contour
            An array and its value, ``"pressure=101325"``: the surface in a volume where it has it.
        times
            Time of each step, (T,). By default the reader's time values, or ``TimeValue`` in the
            field data of every step, or 0, 1, 2, ...
        periodic, name, sign_free
            As for :meth:`from_arrays`, of structured meshes alone.
        block
            Number or path of the block to draw of a MultiBlock, such as ``"Base/Zone 1"``. Numbers
            count the meshes with cells from 0.

        Returns
        -------
        FlowField
            Positions in the mesh's units. Arrays with one component become ``scalars``; those on
            cells, and vectors on cells, become means of the visible cells around each node, on
            triangles by their areas. In a volume that is cut they are interpolated.

        Raises
        ------
        FieldError
            When the mesh has no surface, when the plane or the vectors have to be chosen or do not
            exist, when the steps of a series differ in their nodes, and for what
            :meth:`from_arrays` and :meth:`from_triangles` refuse.

        Warns
        -----
        Notice
            When something was taken without being asked for, such as the outer surface of a
            volume, and when most of the flow points out of a surface of triangles.

        Notes
        -----
        Hidden are points and cells that VTK's ghost arrays hide, points with ``IBlank`` 0
        (PLOT3D), and points that a sampling filter marked in ``vtkValidPointMask``. The mesh is
        not changed.

        Examples
        --------
        >>> import numpy as np
        >>> import pyvista as pv
        >>> import flowtex
        >>> box = pv.ImageData(dimensions=(12, 10, 8))
        >>> box["wind"] = np.stack(
        ...     [box.points[:, 1], -box.points[:, 0], 0 * box.points[:, 2]], axis=-1
        ... )
        >>> flowtex.FlowField.from_pyvista(box, plane="k=4").shape
        (10, 12)
        """
        from flowtex.field.io.from_pyvista import read_meshes

        options: dict[str, Any] = {"periodic": periodic, "sign_free": sign_free, "block": block}
        options |= {"plane": plane, "slice": slice, "contour": contour, "times": times}
        return cls.of(read_meshes(mesh, vectors=vectors, name=name, **options))

    @classmethod
    def from_file(
        cls,
        path: str | Path | Sequence[str | Path],
        *,
        vectors: str | None = None,
        plane: str | None = None,
        slice: Any = None,
        contour: Any = None,
        periodic: str | None = None,
        time: float | str | None = None,
        block: int | str | None = None,
        sign_free: bool = False,
        projection: str | None = None,
        globe: bool = False,
        level: float | str | None = None,
        sel: Mapping[str, Any] | None = None,
        isel: Mapping[str, Any] | None = None,
    ) -> Self:
        """Make a field from a file, or from several that belong together.

        Parameters
        ----------
        path
            A mesh in any format that PyVista reads, or a PLOT3D grid or solution. The
            other one of the two is found beside it by its name: ``postxyz.bin`` and
            ``postq.bin``, ``wing.xyz`` (or ``.x``, ``.g``) and ``wing.q``. An OBJ, PLY or STL has
            its vectors beside it as well: ``hull.npy`` for ``hull.stl``, (N, 3) for its points or
            triangles, or (T, N, 3), in the order of the file. Or data of the Earth:
            NetCDF, a Zarr store, GRIB, or the JSON of wind maps; of these several at once, as the
            parts of a model's output or the steps of a series.
        vectors
            Name of the velocity, as for :meth:`from_pyvista`. A PLOT3D solution gives
            ``Velocity``, made from its density and momentum.
        plane, slice, contour, periodic, sign_free
            As for :meth:`from_pyvista`.
        time
            Draw this one of the times in the file, as a steady field. All of them by default.
        block
            Number or path of the block to draw, such as ``"Base/Zone 1"``, where the file has
            several meshes. Numbers count those with cells from 0.
        projection, globe, level, sel, isel
            As for :meth:`from_xarray`, for data of the Earth.

        Returns
        -------
        FlowField
            Its ``name`` is the file's, without folder and suffix.

        Raises
        ------
        FieldError
            When the file is missing, empty, not readable, of an unknown or broken format, or does
            not hold a flow; the text starts with the path.

        Examples
        --------
        >>> import flowtex
        >>> flowtex.examples.airfoil().save("airfoil.vts")
        >>> flowtex.FlowField.from_file("airfoil.vts").shape
        (65, 193)
        """
        from flowtex.field.io.files import errors_of, read_files

        options: dict[str, Any] = {"plane": plane, "slice": slice, "contour": contour}
        options |= {"block": block, "periodic": periodic, "sign_free": sign_free, "level": level}
        options |= {"projection": projection, "globe": globe, "sel": sel, "isel": isel}
        with errors_of(path):
            arrays = read_files(path, vectors=vectors, time=time, **options)
            return cls.of(cast("FieldArrays", arrays))

    @classmethod
    def from_xarray(
        cls,
        data: xr.Dataset | Sequence[xr.Dataset],
        u: str | None = None,
        v: str | None = None,
        *,
        projection: str | None = None,
        globe: bool = False,
        name: str = "",
        sel: Mapping[str, Any] | None = None,
        isel: Mapping[str, Any] | None = None,
        **selection: Any,
    ) -> Self:
        """Make a field from a dataset of xarray's, as ocean and weather models write them.

        Parameters
        ----------
        data
            A Dataset, or several that belong together, such as NEMO's files of U, of V and of
            coordinates. Nothing but coordinates and one step is read at once; further steps are
            read when they are drawn.
        u, v
            Names of the components. By default the only pair that is likely to be the velocity,
            by CF's standard names, long names and names.
        projection
            A flat map, or ``"globe"``; see :class:`flowtex.earth.Projection`. By default plate
            carree around the middle of the data, and a polar one near a pole.
        globe
            Whether it is put on a sphere: the same as ``projection="globe"``.
        name
            A word for captions.
        sel, isel
            What to draw along axes, by value and by number, such as ``sel={"level": 500}``.
        **selection
            The same as ``sel``, such as ``level=500`` or ``time="2000-01-02"``. ``time`` and
            ``level`` stand for those axes whatever their names. All times by default, the level
            nearest to the surface, and the first along any other axis.

        Returns
        -------
        FlowField
            On longitude and latitude its positions are metres on the map, and its velocity in m/s
            is mapped along; else they are those of the x and y coordinates. Components on the
            sides of cells (Arakawa C) become means in the middle. Other variables at the same
            nodes are ``scalars``; on a flat map ``"speed"`` is that on the Earth.

        Raises
        ------
        FieldError
            When the components, the coordinates or what is chosen cannot be told.
        ModuleNotFoundError
            When xarray, cf_xarray or pyproj is missing.

        Warns
        -----
        DatasetNotice
            When something was chosen without being asked for, such as a level.

        Examples
        --------
        >>> import flowtex
        >>> winds = flowtex.examples.weather()
        >>> flowtex.FlowField.from_xarray(winds, level=500, projection="robinson").steady
        True
        """
        from flowtex.field.datasets.read import read_datasets

        options: dict[str, Any] = {"projection": projection, "globe": globe, "name": name}
        options |= {"sel": sel, "isel": isel, **selection}
        return cls.of(cast("FieldArrays", read_datasets(data, u, v, **options)))
