"""The common parts of critical points, separatrices and orbits: steps, and tables."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import Any

from flowtex._util.extras import import_extra
from flowtex._util.progress import track
from flowtex.errors import FieldError
from flowtex.field import FlowField


class Records(ABC):
    """Features that are rows of a table, with places on the Earth for a field there."""

    @abstractmethod
    def records(self) -> list[dict[str, Any]]:
        """Return a dictionary of numbers and strings for each row."""

    @abstractmethod
    def _geometries(self) -> list[dict[str, Any] | None]:
        """Return the GeoJSON geometry of each row, or ``None`` for those not on the Earth."""

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` of :meth:`records`."""
        return import_extra("pandas", "xarray").DataFrame(self.records())

    def to_geojson(self) -> dict[str, Any]:
        """Return a GeoJSON ``FeatureCollection``; lines are split where they cross 180 degrees.

        Raises
        ------
        FieldError
            When the field is not in coordinates of the Earth.
        """
        geometries, features = self._geometries(), []
        if None in geometries:
            msg = "GeoJSON needs longitudes and latitudes, but this field is not on the Earth"
            raise FieldError(msg)
        for geometry, row in zip(geometries, self.records(), strict=True):
            properties = {key: value for key, value in row.items() if key not in ("lon", "lat")}
            features.append({"type": "Feature", "geometry": geometry, "properties": properties})
        return {"type": "FeatureCollection", "features": features}


def steady_parts(field: FlowField, steps: Sequence[int] | None, text: str) -> Iterator[FlowField]:
    """Return the fields of some time steps, or of all, with a progress bar of this text."""
    numbers = range(len(field.times)) if steps is None else [field.step_number(n) for n in steps]
    return map(field.at_step, track(numbers, len(numbers), text))
