"""Errors and notices for users: all faults of a call at once, and missing optional packages.

Checks return each fault as one sentence that names the value, what was expected and the remedy.
:func:`raise_faults` turns them into a single error, so that a user corrects a call once and not
once for every argument.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from flowtex.remedies import Remedy

_PACKAGE = Path(__file__).resolve().parent


class FieldError(ValueError):
    """Invalid data or arguments; the text names the value, what was expected, and the remedy.

    All other errors of this package for invalid input are subclasses of it.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.FlowField.from_file("missing.vts")
    Traceback (most recent call last):
    flowtex.FieldError: ...
    """


FieldError.__module__ = "flowtex"  # where it is public, as tracebacks show it


def raise_faults(faults: Sequence[str]) -> None:
    """Raise one error with all faults; do nothing without faults.

    Parameters
    ----------
    faults
        One sentence for each fault.

    Raises
    ------
    FieldError
        When there is at least one fault.
    """
    if not faults:
        return
    if len(faults) == 1:
        raise FieldError(faults[0])
    lines = [f"{len(faults)} things are wrong:"]
    for number, fault in enumerate(faults, start=1):
        lines.append(f"  {number}. {fault}")
    raise FieldError("\n".join(lines))


class Notice(UserWarning):
    """Something of the data was chosen automatically, or is not drawn."""

    #: Arguments that draw something else; the text has them as they are typed in Python.
    remedies: tuple[Remedy, ...] = ()


def notify(text: str, kind: type[Warning] = Notice, remedies: Sequence[Remedy] = ()) -> None:
    """Warn at the line that called the package, however deep the call stack is."""
    level = 2
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(str(_PACKAGE)):
        level = level + 1
        frame = frame.f_back
    warning = kind(text)
    if isinstance(warning, Notice):
        warning.remedies = tuple(remedies)
    warnings.warn(warning, stacklevel=level)


def import_extra(module: str, extra: str) -> Any:
    """Import a module that needs an extra.

    Parameters
    ----------
    module
        Name of the module, such as ``"zarr.storage"``.
    extra
        Extra that installs it, such as ``"store"``.

    Returns
    -------
    module
        The module.

    Raises
    ------
    ModuleNotFoundError
        When its package is not installed; the error names the command that installs it.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        missing = (error.name or module).partition(".")[0]
        raise ModuleNotFoundError(
            f"{missing} is missing; install it with {install_extra(extra)}", name=missing
        ) from error


def import_package(package: str, what: str) -> Any:
    """Import a package that is in no extra; the error names the command that installs it.

    Parameters
    ----------
    package
        Name of the package; the name of its module has ``_`` in place of ``-``.
    what
        The data that need it, such as ``"a .msh file"``.

    Raises
    ------
    ModuleNotFoundError
        If the package is not installed.
    """
    try:
        return import_module(package.replace("-", "_"))
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"{what} needs {package}; install it with python -m pip install {package}",
            name=package,
        ) from error


def require_pyvista(what: str) -> None:
    """Check that PyVista and VTK can be imported.

    Parameters
    ----------
    what
        What needs them, as the first words of the error.

    Raises
    ------
    ModuleNotFoundError
        When one of them is missing; the error names functions that work without.
    """
    try:
        import_module("pyvista")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"{what} needs PyVista and VTK, but {error.name} is missing; install it with "
            "python -m pip install pyvista. Python in a browser has neither: make a field there "
            "with FlowField.from_arrays or from_xarray, and draw it with flowtex.FlowWidget or "
            "flowtex.export",
            name=error.name,
        ) from error


def install_extra(extra: str) -> str:
    """Return the command that installs an extra, in a checkout an editable one."""
    if (_PACKAGE.parent / "pyproject.toml").is_file():
        return f'python -m pip install -e ".[{extra}]"'
    return f'python -m pip install "flowtex[{extra}]"'
