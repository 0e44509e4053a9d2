"""The flow on a surface: the class that users make, and its constructors.

Data are checked when a :class:`FlowField` is made, with all faults in one error; the rest of the
package relies on it. Meshes, files and datasets are read by the readers of
:mod:`flowtex.field.readers`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.progress import finish
from flowtex.errors import notify
from flowtex.field.checked_nodes import CheckedNodes
from flowtex.field.derived.quantities import derive, with_derived
from flowtex.field.earth.projection import Projection, as_projection
from flowtex.field.field_arrays import GridArrays, SourceArrays, TriangleArrays
from flowtex.field.field_data import FieldData
from flowtex.field.folds import TEXTS, faces_of
from flowtex.field.grids.grid_nodes import grid_nodes
from flowtex.field.options import OF_BOTH, OF_DATASETS, OF_MESHES, FieldOptions, accepts_options
from flowtex.field.plain_arrays import are_named, plain_grid, refuse_beside_names
from flowtex.field.quantities import PointValues, values_near, with_speed_on_earth
from flowtex.field.readers import reader
from flowtex.field.scalars import Scalars
from flowtex.field.steps import LazySteps, Steps, moves, scaled_steps
from flowtex.field.triangles.triangle_arguments import READING_PARTS, triangle_nodes
from flowtex.field.validation import ALL_AT_REST, Checked, in_own_units

if TYPE_CHECKING:
    import xarray as xr

#: Arguments of :meth:`FlowField.from_file`. Files contain their times.
OF_FILES = tuple(name for name in (*OF_DATASETS, *OF_MESHES) if name != "times")


class FlowField(FieldData):
    """Velocity on a surface, steady or time-varying.

    Make one with :meth:`from_arrays`, :meth:`from_triangles`, :meth:`from_pyvista`,
    :meth:`from_xarray` or :meth:`from_file`. The nodes of a structured surface have the shape (J,
    I); those of triangles are one row, (1, N). Along a periodic axis the last line of nodes repeats
    the first; if a mesh ends one cell earlier, the line is appended to every array.

    Attributes
    ----------
    points
        Node positions, (J, I, 3), in the mesh's own units.
    velocity
        Velocity, (T, J, I, 3) with T = 1 when steady, in units of length per unit of time; zero at
        nodes that are not valid. Long series of datasets are read step by step.
    times
        Time of each step, (T,), strictly increasing.
    valid
        Nodes that have data, (J, I): neither blanked nor masked nor NaN.
    periodic
        Whether the (j, i) axis closes on itself.
    scalars
        Other nodal arrays, name to (T or 1, J, I). Those in ``on_cells`` are drawn flat: a cell has
        the value of its first node (j, i), and triangles have one each, (T or 1, 1, M).
    name, length_unit, time_unit
        Text for captions; empty when unknown.
    has_position
        Nodes whose position is known, (J, I), or ``None`` for all; others have the nearest one.
    sign_free
        Whether v and -v mean the same, as in a field of polarisations or principal directions.
    units, long_names
        Unit of each scalar, and its description for legends, where they are known.
    start
        The date at time 0, a ``datetime`` or a date of cftime, if the times count from a date.
    projection
        The map from longitude and latitude to positions, for a field of the Earth.
    triangles
        Indices of the nodes at the corners of triangles, (M, 3); ``None`` on a structured surface.
    formula
        The formula, if :func:`flowtex.formula` made the field.
    uncertainty
        Name of the scalar with the uncertainty of the direction; empty for none.
    section
        Texts for the axes of a vertical section; ``None`` for other surfaces.
    reading
        What was done to the data of a file, mesh or dataset, step by step; ``print(field.reading)``
        lists it.
    velocity_unit
        Unit of the velocity of the data, and of :attr:`speed`; empty for length per time.
    volume_values
        Values (N,) of scalars in the volume of a slice, at all times: the extremes, and a sample.
        Colours have their range.
    on_cells
        Names of the scalars that belong to cells.
    vectors
        Name of the vectors in the data, for legends; empty for a velocity without a name.
    parts
        Components of other vectors of a mesh, such as ``gradP_x``, by name, as in ``scalars``.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.airfoil_field()
    >>> field.shape, field.steady, field.periodic
    ((65, 193), True, (False, True))
    >>> float(field.speed.max()) > 1
    True
    """

    @classmethod
    def of(cls, arrays: SourceArrays) -> Self:
        """Make a field from a source.

        Examples
        --------
        >>> import flowtex
        >>> from flowtex.field.field_arrays import GridArrays
        >>> arrays = GridArrays(points=([0, 1, 2], [0, 1]), velocity=[[(1, 0)] * 3] * 2)
        >>> flowtex.FlowField.of(arrays).shape
        (2, 3)
        """
        field = cls._checked(arrays)
        field = field._with_faces()
        if isinstance(field.velocity, LazySteps) or arrays.projection is not None:
            return field
        reading = field.reading.with_normal_share(field.normal_share, arrays.notable_normal)
        if reading != field.reading and reading[-1].notable:
            notify(reading[-1].text)
        return field.same_flow(reading=reading)

    @classmethod
    def from_arrays(
        cls,
        points: Any,
        velocity: Any = None,
        *components: Any,
        times: ArrayLike | None = None,
        valid: ArrayLike | None = None,
        periodic: str | None = None,
        scalars: Mapping[str, Any] | None = None,
        cell_scalars: Mapping[str, Any] | None = None,
        name: str = "",
        length_unit: str = "",
        time_unit: str = "",
        velocity_unit: str = "",
        vectors: str = "",
        sign_free: bool = False,
        units: Mapping[str, str] | None = None,
        long_names: Mapping[str, str] | None = None,
        projection: Projection | str | None = None,
    ) -> Self:
        """Make a field from arrays.

        Parameters
        ----------
        points
            Node positions, (J, I, 2) or (J, I, 3), in any unit of length. Or a tuple of
            coordinates: ``(x, y)`` of a rectilinear grid, (I,) and (J,), or two or three arrays
            (J, I). Or all arrays by name, as in ``dict(x=x, y=y, u=u, v=v)``, an ``.npz`` file or a
            structured array; arrays at the same nodes become scalars.
        velocity
            Velocity at the nodes, (J, I, 2 or 3), or (T, J, I, 2 or 3) for a time-varying field, in
            ``velocity_unit``; or complex, u + iv, or with the components first. NaN and masked
            entries blank a node. A node with data at only some times is at rest at the others,
            without streaks, and the scalar ``"no data"`` is 1 there. Lazy steps (``LazySteps``)
            stay lazy: at most three are read to find such nodes.
        *components
            Further arrays: ``from_arrays(x, y, u, v)`` takes those of ``plt.streamplot`` and
            ``plt.quiver``, with u and v of the shape (J, I) or (T, J, I). ``from_arrays(u, v)``
            counts positions from 0, and ``from_arrays(x, y, z, u, v, w)`` is a surface in space.
            Quantities of pint and astropy have their units.
        times
            Time of each step, (T,), strictly increasing; 0, 1, 2, ... by default. Dates
            (``datetime64``, or cftime's) become seconds since the first, and are shown as dates.
        valid
            Nodes that have data, (J, I). All by default.
        periodic
            Axes that close on themselves: ``""``, ``"i"``, ``"j"`` or ``"ij"``. By default they are
            detected: first and last lines of nodes that coincide, a ring that ends one cell short,
            and global longitude on a flat map.
        scalars
            Further nodal arrays, name to (J, I) or (T, J, I); values beyond 1e100 become NaN.
        cell_scalars
            Arrays of one value for each cell, (J - 1, I - 1) or (T, J - 1, I - 1), drawn flat.
        name, length_unit, time_unit
            Text for captions.
        velocity_unit
            Unit of the velocity, such as ``"m/s"`` where positions are in mm; by default the unit
            of length per unit of time.
        vectors
            Name of the vectors for legends, such as ``"B"``; by default they are a velocity.
        sign_free
            Whether v and -v mean the same. Such a field is steady; it is drawn to both sides, and
            kernels and motions that distinguish forward from backward are not available. Vectors
            are reversed where that makes neighbours agree.
        units
            Unit of each scalar by its name, for legends.
        long_names
            Descriptions of scalars for legends, where they differ from their names.
        projection
            The map from longitude and latitude to the points, for a field of the Earth, or its
            name, such as ``"globe"`` or ``"EPSG:3413"``, as ``from_xarray`` takes it. It is used
            for coordinates of points and for coastlines. On a flat map the speed on the Earth is
            the scalar ``"speed"``, unless ``scalars`` has one.

        Returns
        -------
        FlowField

        Raises
        ------
        FieldError
            When the arrays do not describe a field. The error lists all faults.

        Warns
        -----
        UserWarning
            When the velocity is zero everywhere, so that the picture is plain.

        Notes
        -----
        The arrays are copied to float64 and never changed. At a fold, where cells turn by 35
        degrees or more, velocities of both sides mix over one cell, and a picture issues a notice;
        :meth:`from_pyvista` makes triangles of such a mesh, which keep them apart.

        Examples
        --------
        >>> import numpy as np
        >>> import flowtex
        >>> x, y = np.linspace(-1, 1, 41), np.linspace(-1, 1, 31)
        >>> v = np.stack(np.meshgrid(x, y), axis=-1)[..., ::-1] * (1, -1)  # (31, 41, 2): (y, -x)
        >>> flowtex.FlowField.from_arrays((x, y), v, name="a vortex").shape
        (31, 41)
        """
        if are_named(points):
            others = {"velocity": velocity, "valid": valid, "cell_scalars": cell_scalars}
            labels = {"vectors": vectors, "units": units, "long_names": long_names}
            refuse_beside_names({**others, **labels})
            return cls._by_name(
                points,
                name,
                scalars,
                times=times,
                periodic=periodic,
                sign_free=sign_free or None,
                length_unit=length_unit or None,
                time_unit=time_unit or None,
                velocity_unit=velocity_unit or None,
                projection=projection,
            )
        plain = plain_grid(points, velocity, components)
        arrays = GridArrays(
            points=plain.points,
            velocity=plain.velocity,
            times=times,
            valid=valid,
            periodic=periodic,
            scalars=_mapping(scalars),
            cell_scalars=_mapping(cell_scalars),
            name=name,
            length_unit=length_unit or plain.length_unit,
            time_unit=time_unit,
            velocity_unit=velocity_unit or plain.velocity_unit,
            vectors=vectors,
            sign_free=sign_free,
            units=_mapping(units),
            long_names=_mapping(long_names),
            projection=as_projection(projection),
        )
        return cls._checked(arrays)

    @classmethod
    def _by_name(
        cls, arrays: Any, name: str, scalars: Mapping[str, Any] | None, **options: Any
    ) -> Self:
        """Return the field of arrays by name."""
        given = FieldOptions.of(**options)
        field: Self = reader("arrays")(arrays, given, _mapping(scalars))
        return replace(field, name=name)

    @classmethod
    def from_triangles(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        velocity: Any,
        *,
        times: ArrayLike | None = None,
        valid: ArrayLike | None = None,
        scalars: Mapping[str, Any] | None = None,
        cell_scalars: Mapping[str, Any] | None = None,
        name: str = "",
        length_unit: str = "",
        time_unit: str = "",
        velocity_unit: str = "",
        vectors: str = "",
        units: Mapping[str, str] | None = None,
        long_names: Mapping[str, str] | None = None,
        projection: Projection | str | None = None,
    ) -> Self:
        """Make a field on a surface of triangles from arrays.

        Parameters
        ----------
        points
            Node positions, (N, 2) or (N, 3), in any unit of length.
        triangles
            Indices of the nodes at the corners of each triangle, (M, 3). Triangles may face either
            way and share an edge with several others; the surface may have borders and several
            parts.
        velocity
            Velocity at the nodes, (N, 2 or 3), or (T, N, 2 or 3) for a time-varying field. NaN and
            masked entries blank a node. The component normal to the surface is not drawn
            (:attr:`normal_share`). The velocity may be lazy.
        times, name, length_unit, time_unit, velocity_unit, vectors, units, long_names, projection
            As for :meth:`from_arrays`.
        valid
            Nodes that have data, (N,). All by default.
        scalars
            Further nodal arrays, name to (N,) or (T, N), to colour by.
        cell_scalars
            Arrays of one value for each triangle, (M,) or (T, M), drawn flat.

        Returns
        -------
        FlowField
            Its nodes are those that triangles use; border nodes at the same position are merged,
            with the mean of their values. At sharp edges, of 35 degrees or more, each face has its
            own nodes, which have the values of nodes in that face.

        Raises
        ------
        FieldError
            When the arrays do not describe a field. The error lists all faults.

        Warns
        -----
        UserWarning
            When triangles without area or repeated triangles are left out, or the velocity is zero
            everywhere.

        Examples
        --------
        >>> import flowtex
        >>> points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        >>> velocity = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0)]
        >>> flowtex.FlowField.from_triangles(points, [(0, 1, 2), (0, 2, 3)], velocity).size_text
        '4 nodes, 2 triangles'
        """
        arrays = TriangleArrays(
            points=points,
            triangles=triangles,
            velocity=velocity,
            times=times,
            valid=valid,
            scalars=_mapping(scalars),
            cell_scalars=_mapping(cell_scalars),
            name=name,
            length_unit=length_unit,
            time_unit=time_unit,
            velocity_unit=velocity_unit,
            vectors=vectors,
            units=_mapping(units),
            long_names=_mapping(long_names),
            projection=as_projection(projection),
        )
        return cls._checked(arrays)

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
        made: Self = reader("mesh")(mesh, FieldOptions.of(**options), name=name)
        return made

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
        made: Self = reader("file")(path, FieldOptions.of(**options), time=time)
        return made

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
        options = FieldOptions.of_dataset({"u": u, "v": v, **selection})
        made: Self = reader("dataset")(data, options, name=name)
        return made

    @classmethod
    def _checked(cls, arrays: SourceArrays) -> Self:
        """Check arrays, and make a field of them."""
        on_globe = arrays.projection is not None and arrays.projection.is_globe
        if isinstance(arrays, TriangleArrays):
            own = in_own_units(arrays, axes=1)
            steps = triangle_nodes(arrays, own, on_globe=on_globe)
            nodes = finish(steps, READING_PARTS, "Reading")
        else:
            own = in_own_units(arrays, axes=2)
            nodes = grid_nodes(arrays, own, on_globe=on_globe)
        field = cls._made(arrays, own, nodes)
        if "speed" in arrays.scalars:
            return field
        return with_speed_on_earth(field)

    @classmethod
    def _made(cls, arrays: SourceArrays, own: Checked, nodes: CheckedNodes) -> Self:
        """Make a field of checked arrays; warn if it is at rest."""
        surface = nodes.surface
        velocity = scaled_steps(nodes.velocity, own.scale)
        if not moves(velocity):
            notify(ALL_AT_REST, UserWarning)
        if own.times is None:
            times = np.arange(len(velocity), dtype=float)
        else:
            times = own.times.copy()
        scalars = Scalars(nodes.scalars)
        parts = {name: scalars.pop(name) for name in arrays.parts}
        field = cls(
            points=surface.points,
            velocity=velocity,
            times=times,
            valid=surface.valid,
            periodic=surface.periodic,
            scalars=scalars,
            name=arrays.name,
            length_unit=own.length_unit,
            time_unit=own.time_unit,
            has_position=nodes.has_position,
            sign_free=nodes.sign_free,
            units=own.units,
            long_names=dict(arrays.long_names),
            start=own.start,
            projection=arrays.projection,
            triangles=nodes.triangles,
            uncertainty=own.uncertainty,
            section=nodes.section,
            reading=arrays.reading,
            velocity_unit=own.velocity_unit,
            volume_values=arrays.volume_values,
            on_cells=tuple(arrays.cell_scalars),
            vectors=arrays.vectors,
            parts=parts,
        )
        return field.with_surface(surface)

    def _with_faces(self) -> Self:
        """Return the field with nodes for each face where a grid is folded; others as they are."""
        arrays = faces_of(self)
        if arrays is None:
            return self
        faced = self._checked(arrays)
        if not faced.surface.at_edge.any():
            return self
        texts = {name: getattr(self, name) for name in TEXTS}
        return faced.same_flow(**texts)

    def derive(self, name: str, *, horizon: float | None = None) -> Steps:
        """Compute a scalar from the velocity and its gradient along the surface.

        Parameters
        ----------
        name
            ``"vorticity"``: positive where the flow turns anticlockwise, seen from outside, or
            from the positive side of a flat surface. ``"divergence"``. ``"shear"``: the magnitude
            of the rate of strain without divergence, sqrt((du/dx - dv/dy)^2 + (dv/dx + du/dy)^2).
            ``"okubo_weiss"``: squared shear less squared vorticity, negative in
            vortices. ``"ftle"``: the finite-time Lyapunov exponent, the largest rate at which
            particles that start near a node separate.
        horizon
            How long particles are followed for ``"ftle"``, in the unit of time; backward if
            negative. Where that leads beyond the series, a notice states the longest one.

        Returns
        -------
        numpy.ndarray
            (T, J, I), or (T, 1, N) on triangles, in 1 over the unit of time (its square for
            Okubo-Weiss); NaN where too few neighbours have data at that time, and where a particle
            leaves the domain or the series. Lazy where the velocity is.

        Raises
        ------
        FieldError
            When the name is unknown, the horizon is invalid, the field is sign-free, or not all of
            its nodes are in memory, as of a large store.

        Notes
        -----
        Errors are of second order in the size of cells, on any surface. On flat maps of the Earth
        the values are those on the sphere.

        Examples
        --------
        >>> import flowtex
        >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
        >>> field.derive("vorticity").shape
        (1, 41, 81)
        """
        return derive(self, name, horizon)

    def with_derived(self, name: str, *, horizon: float | None = None) -> Self:
        """Return the field with the result of ``derive`` among its scalars.

        Examples
        --------
        >>> import flowtex
        >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
        >>> sorted(field.with_derived("shear").scalars)
        ['shear', 'vorticity']
        """
        return with_derived(self, name, horizon)

    def at(self, x: float, y: float, z: Any = None, time: Any = None) -> PointValues | None:
        """Return the values at a point and a time; ``None`` outside the data.

        Parameters
        ----------
        x, y, z
            A position in the unit of length; ``z`` is optional on a plane of constant z. For a
            field of the Earth, longitude and latitude in degrees, on every map: then the third
            argument is the time.
        time
            Time in the field's unit, or a date if the times are dates; values are interpolated. The
            first one at which something moves by default, which pictures, axes and the widget show
            too.

        Returns
        -------
        PointValues or None
            Speed and components in the units of the data, scalars, and the position. Where a node
            around the point has no data at one of the two steps around the time, they are the
            values of the nearer step, and the velocity is NaN if that has none.

        Raises
        ------
        FieldError
            When a number is not finite, or the time is outside the field's times.

        Examples
        --------
        >>> import flowtex
        >>> round(flowtex.examples.double_gyre_field().at(0.5, 0.25).speed, 3)
        0.222
        """
        return values_near(self, x, y, z, time)


def _mapping(values: Mapping[str, Any] | None) -> Mapping[str, Any]:
    """Return named values; none are an empty mapping."""
    if values is None:
        return {}
    return values
