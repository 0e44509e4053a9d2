"""Constructors of a field from meshes, files and datasets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, cast

from flowtex.errors import require_pyvista
from flowtex.field.field_arrays import FieldArrays
from flowtex.field.options import OF_BOTH, OF_DATASETS, OF_MESHES, FieldOptions, accepts_options
from flowtex.field.uncertainty import UNCERTAINTY, with_uncertainty
from flowtex.field.validation import with_gaps

if TYPE_CHECKING:
    import xarray as xr


#: Arguments of :meth:`FieldConstructors.from_file`. Files contain their times.
OF_FILES = tuple(name for name in (*OF_DATASETS, *OF_MESHES) if name != "times")


class FieldConstructors:
    """Class methods that make a field from a mesh, a file or a dataset."""

    @classmethod
    def of(cls, arrays: FieldArrays) -> Self:
        """Return the field of the arrays of a source.

        Raises
        ------
        NotImplementedError
            In this class; :class:`flowtex.FlowField` has the method.
        """
        raise NotImplementedError

    @classmethod
    @accepts_options(FieldOptions, names=("vectors", *OF_MESHES, *OF_BOTH), settings=False)
    def from_pyvista(cls, mesh: Any, *, name: str = "", **options: Any) -> Self:
        """Make a field from a PyVista mesh, or from a series of them.

        Parameters
        ----------
        mesh
            A StructuredGrid, RectilinearGrid or ImageData, drawn in rows and columns, or as
            triangles if its cells turn by 35 degrees or more along a line of nodes; or a PolyData
            or an UnstructuredGrid, whose surface is drawn as triangles. Of a volume this is the
            outer surface, unless ``slice`` or ``contour`` cuts it. A MultiBlock with one structured
            block, or one volume, is treated as that block; otherwise the surfaces of its blocks are
            drawn together. Structured surfaces that meet at their borders become one surface. The
            time steps of a series are a list or tuple of meshes, a MultiBlock of meshes with the
            same nodes, or a PyVista reader with time values.
        vectors
            Name of the velocity on points or cells, with 2 or 3 components. By default the only
            array that can be the velocity, or the active vectors of the mesh. Components in
            separate arrays are named with commas between, as in ``"u,v,w"``. They are found
            automatically if the mesh has no array of vectors and their names differ only in the
            component, such as ``X Velocity``, ``Y Velocity`` and ``Z Velocity``. Two components
            lie in the plane of a flat mesh: in y = 0 they are along x and z. Those of a volume or a
            curved surface are along x and y, unless their names say otherwise.
        plane
            Index plane to draw of a three-dimensional structured mesh: ``"k=20"``, ``"j=0"`` or
            ``"i=-1"``, where negative numbers count from the end. On a k-plane the surface's (i, j)
            are the mesh's (i, j), on a j-plane (i, k), on an i-plane (j, k). A mesh that is one
            node thick along an axis needs no plane; its (i, j) follow the same rule.
        slice
            Plane through a volume of any kind, drawn as triangles: ``"x=0.5"``, a normal such as
            ``"1,1,0"``, a normal and a point as in ``"1,1,0 through 0.5,0.5,0.2"``, or a pair of
            normal and point. Without a point the plane goes through the middle of the mesh; without
            ``block`` it cuts all volumes of a MultiBlock.
        contour
            An array and a value, ``"pressure=101325"``: the isosurface in a volume.
        times
            Time of each step, (T,). By default the reader's time values, or ``TimeValue`` in the
            field data of every step, by which steps are sorted, or 0, 1, 2, ...
        components
            Directions of the components: ``"polar"`` or ``"cylindrical"`` for away from the z axis,
            around it, and along it, ``"spherical"`` for away from the origin, southward and
            eastward. Of two components the spherical ones are southward and eastward. By default
            they are along x, y and z.
        periodic, name, sign_free
            As for :meth:`from_arrays`; ``periodic`` and ``sign_free`` are for structured meshes
            only.
        block
            Number or path of the block of a MultiBlock to draw, such as ``"Base/Zone 1"``. Numbers
            count from 0 and include only blocks with cells.
        preference
            The array to read where points and cells have one of the same name: ``"point"``, the
            default, or ``"cell"``.
        mask
            ``False`` to draw vectors with a fill value, such as -999, too.
        length_unit, time_unit, velocity_unit
            Units of the positions, the times and the velocity, for legends and scale bars.
        uncertainty
            As for :meth:`from_xarray`: a scalar, or an array with a value for each node.

        Returns
        -------
        FlowField
            Positions are in the mesh's units. Arrays with one component become ``scalars``; those
            on cells are drawn flat, also on a cut, and between two layers of cells a plane has the
            values of the second one. A velocity on cells is averaged over the visible cells around
            each node, on triangles weighted by area, and so is its magnitude.

        Raises
        ------
        FieldError
            When the mesh has no surface, the plane or the vectors are missing or ambiguous, the
            steps of a series differ in their nodes, or :meth:`from_arrays` or
            :meth:`from_triangles` raises it.

        Warns
        -----
        Notice
            When flowtex made a choice, such as the outer surface of a volume, or when 5 % of the
            flow are normal to a surface, or half of it to a cut of a volume.

        Notes
        -----
        Points and cells that VTK's ghost arrays hide, points with ``IBlank`` 0 (PLOT3D), and points
        that a sampling filter marked in ``vtkValidPointMask`` are not drawn, and neither are
        vectors with a fill value, such as -999. Steps whose nodes are in another order are matched
        by ``GlobalPointIds`` or by position. ``field.reading`` lists all. The mesh is not changed.

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
        from flowtex.sources.meshes.read_meshes import read_meshes

        require_pyvista(f"a flow from an object of type {type(mesh).__name__}")
        chosen = FieldOptions.of(**options)
        field = cls.of(read_meshes(mesh, chosen, name=name))
        return with_uncertainty(field, chosen.uncertainty)

    @classmethod
    @accepts_options(FieldOptions, names=OF_FILES, settings=False)
    def from_file(
        cls,
        path: str | Path | Sequence[str | Path],
        *,
        time: float | str | None = None,
        **options: Any,
    ) -> Self:
        """Make a field from a file, or from several that belong together.

        Parameters
        ----------
        path
            A mesh in any format that PyVista reads, or a PLOT3D grid or solution, whose counterpart
            is found by its name in the same folder: ``postxyz.bin`` and ``postq.bin``, ``wing.xyz``
            (or ``.x``, ``.g``) and ``wing.q``. For an OBJ, PLY or STL the vectors are in a file
            with the same name, ``hull.npy`` for ``hull.stl``: (N, 3) for its points or triangles,
            or (T, N, 3), in the order of the file. Or data of the Earth: NetCDF, a Zarr store,
            GRIB, GeoJSON of points, CSV with a header, or the JSON of wind maps;
            ``model.nc/ocean`` is a group of a file. Several such
            files, the parts of a model's output or the steps of a series, are given as a list.
        vectors
            Name of the velocity, as for :meth:`from_pyvista`. For a PLOT3D solution it is
            ``Velocity``, computed from density and momentum.
        plane, slice, contour, periodic, sign_free, preference
            As for :meth:`from_pyvista`.
        time
            One time of the file, drawn as a steady field, or ``"first"`` or ``"last"``. Between two
            times of a mesh the flow is interpolated. All times by default.
        block
            Number or path of the block to draw, such as ``"Base/Zone 1"``, if the file has several.
            Numbers count from 0 and include only blocks with cells.
        components
            As for :meth:`from_pyvista` and :meth:`from_xarray`.
        projection, globe, level, sel, isel, dims, direction, max_edge
            As for :meth:`from_xarray`, for gridded data and models.
        mask, length_unit, time_unit, velocity_unit
            As for :meth:`from_pyvista` and :meth:`from_xarray`.
        uncertainty
            As for :meth:`from_xarray`; of a mesh a scalar.

        Returns
        -------
        FlowField
            Its ``name`` is the file's, without folder and suffix.

        Raises
        ------
        FieldError
            When the file is missing, empty, unreadable, corrupt or of an unknown format, or does
            not contain a flow; the text starts with the path.

        Examples
        --------
        >>> import flowtex
        >>> flowtex.examples.airfoil().save("airfoil.vts")
        >>> flowtex.FlowField.from_file("airfoil.vts").shape
        (65, 193)
        """
        from flowtex.sources.read_files import errors_of, read_files

        chosen = FieldOptions.of(**options)
        with errors_of(path):
            arrays = read_files(path, chosen, time=time)
            return with_uncertainty(cls.of(cast("FieldArrays", arrays)), chosen.uncertainty)

    @classmethod
    @accepts_options(FieldOptions, names=OF_DATASETS[1:], settings=False)
    def from_xarray(
        cls,
        data: xr.Dataset | xr.DataTree | xr.DataArray | Sequence[Any] | Any,
        u: str | None = None,
        v: str | None = None,
        *,
        name: str = "",
        **selection: Any,
    ) -> Self:
        """Make a field from xarray datasets, arrays or tables, such as the output of a model.

        Parameters
        ----------
        data
            A Dataset, or a list of several that belong together, such as NEMO's files of U, of V
            and of coordinates, or the steps of a series; or a DataTree, of which one group has a
            velocity. A DataArray has an axis of two or three components, or is one of a list. A
            DataFrame of pandas, GeoPandas or Polars has columns for positions, perhaps for time,
            and for the components: rows of a grid become a grid, other rows are points. Points
            along one dimension are joined by triangles to their neighbours, but not across gaps;
            so are reduced Gaussian grids. Only coordinates and one step are read at first, or three
            where data are missing; further steps are read when they are drawn.
        u, v
            Names of the components. By default the only pair that is recognised as the velocity by
            CF standard names, long names or names.
        projection
            A flat map, or ``"globe"``; see :class:`flowtex.field.earth.Projection`. By default
            plate carree around the middle of the data, or a polar projection near and around a
            pole.
        globe
            Whether to draw on a sphere; the same as ``projection="globe"``.
        name
            Name for captions.
        sel, isel
            Selections along axes, by value and by index, such as ``sel={"level": 500}``, or of a
            range of times, its ends included: ``sel={"time": slice("2001-02", "2001-03")}``.
        uncertainty
            The uncertainty of the direction, where streaks are shorter and fainter: the name of a
            scalar, or an array of the nodes, with the standard deviation of the velocity over its
            magnitude; or a dimension, such as ``"number"`` of an ensemble: the mean over it is
            drawn, and its spread becomes a scalar.
        mask
            Name of the only variable that marks missing data, or ``False`` to draw all values. By
            default flowtex applies masks with CF standard names or common names, quality flags, and
            undeclared fill values such as -999. Land masks do not apply to winds that vary over
            land.
        components
            Directions of the components: ``"earth"`` for eastward and northward, ``"grid"`` for
            along rows and columns, ``"plane"`` for along x and y, ``"polar"`` for away from the
            origin and around it, ``"spherical"`` for southward and eastward, along the colatitude
            and the longitude. The angle of a speed is ``"from"`` where the flow comes, ``"to"``
            where it goes, both clockwise from north, or an ``"angle"`` counterclockwise from x. By
            default the names of the variables and the grid decide;
            ``field.reading.of("components")`` names the rule.
        dims
            Coordinates that are drawn across and upward, such as ``"lon,lat"``. By default their
            names and attributes decide.
        length_unit, time_unit, velocity_unit
            Units in place of those in the data: of x and y, of times that are numbers, and of the
            velocity.
        direction
            Name of the direction of a speed, as in ``vectors="ff", direction="dd"``. Its names and
            attributes decide whether the flow comes from there or goes there, clockwise from north,
            or whether it is an angle counterclockwise from x.
        max_edge
            Longest edge of the triangles that join scattered points, in the unit of the positions,
            on the Earth in kilometres, or with a unit, as in ``"50 km"``. By default triangles that
            are much larger than others nearby are left out.
        **selection
            The same as ``sel``, such as ``level=500`` or ``time="2000-01-02"``. ``time`` and
            ``level`` select along these axes whatever their names. By default all times, the level
            nearest to the surface, and the first entry of any other axis.

        Returns
        -------
        FlowField
            Positions on longitude and latitude become metres on the map or the globe; x and y keep
            their unit, and velocities keep theirs as ``velocity_unit``. A flat map has the
            projected velocity in m/s, and its scalar ``"speed"`` is the speed on the Earth in the
            unit of the data. Components on the sides of cells (Arakawa C) are averaged to the
            centres. Other variables at the same nodes are ``scalars``. ``reading`` lists what was
            done.

        Raises
        ------
        FieldError
            When components or coordinates are not recognised, a selection does not exist, the
            components lie at different positions or times, or positions move within a series.
        ModuleNotFoundError
            When xarray, cf_xarray or pyproj is missing.

        Warns
        -----
        DatasetNotice
            When flowtex made a choice, such as a level, or left out values that only one of the
            components has.

        Examples
        --------
        >>> import flowtex
        >>> winds = flowtex.examples.weather()
        >>> field = flowtex.FlowField.from_xarray(winds, level=500, projection="robinson")
        >>> print(field.reading)
        select: velocity: u, v (standard name with 'eastward' and 'northward')
        select: level: 500 hPa
        coordinates: longitude and latitude
        components: eastward and northward (by the names of the variables)
        """
        from flowtex.sources.datasets.own_values import with_values
        from flowtex.sources.datasets.read_datasets import read_datasets

        options = FieldOptions.of_dataset({"u": u, "v": v, **selection})
        uncertainty: Any = options.uncertainty
        if uncertainty is not None and not isinstance(uncertainty, str):
            values = with_gaps("uncertainty", uncertainty)
            changed = with_values(data, UNCERTAINTY, values, "uncertainty", options.vectors)
            if changed is not data:
                data = changed
                options = replace(options, uncertainty=UNCERTAINTY)
        field = cls.of(cast("FieldArrays", read_datasets(data, options, name=name)))
        return with_uncertainty(field, options.uncertainty)
