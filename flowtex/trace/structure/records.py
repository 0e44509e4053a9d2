"""What critical points and separatrices share: the form of a table."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from flowtex._util.extras import import_extra


class Records(ABC):
    """Things that are rows of a table."""

    @abstractmethod
    def records(self) -> list[dict[str, Any]]:
        """Return a dictionary of numbers and strings for each row."""

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` of :meth:`records`."""
        return import_extra("pandas", "xarray").DataFrame(self.records())
