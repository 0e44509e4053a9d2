"""Notices about choices in a dataset, issued at the caller's line."""

from __future__ import annotations

from flowtex._util import notices


class DatasetNotice(notices.Notice):
    """flowtex chose something in a dataset, such as a level.

    Examples
    --------
    >>> import warnings
    >>> import flowtex
    >>> from flowtex.field.datasets.notices import DatasetNotice
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", DatasetNotice)
    ...     field = flowtex.FlowField.from_xarray(flowtex.examples.weather())
    """


def notify(text: str) -> None:
    """Warn at the line that called the package."""
    notices.notify(text, DatasetNotice)
