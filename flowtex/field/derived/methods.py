"""The methods of a field that compute quantities, and return values at points."""

from __future__ import annotations

from typing import Any, Self

from flowtex.errors import FieldError
from flowtex.field.derived import FOLLOWED, LONG_NAMES, derived_steps, derived_unit, followed_steps
from flowtex.field.point_values import PointValues, point_at
from flowtex.field.steps import Steps


class FieldQuantities:
    """Quantities that are computed from the arrays of a field, which inherits this class."""

    def derive(self, name: str, *, horizon: float | None = None) -> Steps:
        """Compute a scalar from the velocity and its gradient along the surface.

        Parameters
        ----------
        name
            ``"vorticity"``: positive where the flow turns anticlockwise, seen from outside, or
            from the positive side of a flat surface. ``"divergence"``. ``"shear"``: the magnitude
            of the rate of strain without divergence, sqrt((du/dx - dv/dy)^2 + (dv/dx + du/dy)^2).
            ``"okubo_weiss"``: the square of the shear less that of the vorticity, negative in
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
            When the name is unknown, the horizon is invalid, or the field is sign-free.

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
        field: Any = self
        if field.sign_free:
            raise FieldError(f"{name} needs a direction, but this field is sign-free")
        if horizon is not None or name in FOLLOWED:
            return followed_steps(name, field, horizon)
        return derived_steps(name, field)

    def with_derived(self, name: str, *, horizon: float | None = None) -> Self:
        """Return the field with the result of ``derive`` among its scalars.

        Examples
        --------
        >>> import flowtex
        >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
        >>> sorted(field.with_derived("shear").scalars)
        ['shear', 'vorticity']
        """
        field: Any = self
        result: Self = field.same_flow(
            scalars={**field.scalars, name: self.derive(name, horizon=horizon)},
            units={**field.units, name: derived_unit(name, field)},
            long_names={**field.long_names, name: LONG_NAMES.get(name, name)},
        )
        return result

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
            last one by default.

        Returns
        -------
        PointValues or None
            Speed and components in the units of the data, scalars, and the position.

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
        field: Any = self
        if field.projection is not None and z is not None:
            if time is not None:
                raise FieldError(f"z is {z}, but the field lies on the Earth; omit z")
            z, time = None, z
        return point_at(field, (x, y) if z is None else (x, y, z), time)
