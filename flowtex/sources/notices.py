"""Notices about choices in a dataset, issued at the caller's line."""

from __future__ import annotations

from typing import Any

from flowtex._util import notices


class DatasetNotice(notices.Notice):
    """flowtex chose something in a dataset, such as a level.

    Examples
    --------
    >>> import warnings
    >>> import flowtex
    >>> from flowtex.sources.notices import DatasetNotice
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", DatasetNotice)
    ...     field = flowtex.FlowField.from_xarray(flowtex.examples.weather())
    """


def notify(text: str) -> None:
    """Warn at the line that called the package."""
    notices.notify(text, DatasetNotice)


def notify_section(section: Any) -> None:
    """Warn where a vertical section, as :attr:`FlowField.section` has it, is drawn without axes."""
    if section is not None:
        notify(
            f"this is a vertical section of {section.x} and {section.y}, which need independent "
            "axis scales; use flowtex.axes or ds.flowtex.plot instead"
        )
