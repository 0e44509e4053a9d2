"""Errors for missing optional packages, with the command that installs them."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

_CHECKOUT = Path(__file__).resolve().parents[2]


def import_extra(module: str, extra: str) -> Any:
    """Import an optional library; the error names the command that installs it."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"{module} is missing; install it with {install_extra(extra)}", name=module
        ) from error


def require_pyvista(what: str) -> None:
    """Import PyVista, or raise an error that names the functions that work without it."""
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
    if (_CHECKOUT / "pyproject.toml").is_file():
        return f'python -m pip install -e ".[{extra}]"'
    return f'python -m pip install "flowtex[{extra}]"'
