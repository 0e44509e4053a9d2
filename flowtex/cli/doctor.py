"""``flowtex doctor``: what flowtex needs, what is missing, and what installs it."""

from __future__ import annotations

import importlib.metadata
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from flowtex._util.terminal import terminal
from flowtex.errors import install_extra
from flowtex.rendering import shaders
from flowtex.rendering.diagnostics import has_display, opengl_report

REQUIRED = ("numpy", "scipy", "pyvista", "vtk", "h5py")
OPTIONAL = {"trame": "app", "trame-vuetify": "app", "trame-rca": "app", "anywidget": "notebook"}
OF_PYVISTA = {"trame-pyvista": "export_html and pages in notebooks", "imageio": "open_gif"}


@dataclass(frozen=True)
class Check:
    """One line of the diagnosis: subject, status, result and remedy.

    Examples
    --------
    >>> from flowtex.cli.doctor import Check
    >>> Check("OpenGL", "fail", "not found", "apt-get install libegl1").status
    'fail'
    """

    name: str
    status: Literal["ok", "warn", "fail"]
    detail: str
    remedy: str = ""


def diagnose() -> list[Check]:
    """Check everything that flowtex needs; never raises.

    Examples
    --------
    >>> from flowtex.cli.doctor import diagnose
    >>> [check.name for check in diagnose()][:4]
    ['Python', 'OpenGL', 'Display', 'Shaders']
    """
    python = Check("Python", "ok", f"{sys.version.split()[0]}, {sys.executable}")
    found = "none: pictures and the browser work, windows do not open"
    if has_display():
        found = os.environ.get("DISPLAY") or "the system's"
    return [python, _opengl(), Check("Display", "ok", found), _shaders(), *_packages()]


def _opengl() -> Check:
    report = opengl_report()
    if not report.usable:
        return Check("OpenGL", "fail", report.failure, report.remedy)
    kind = "the processor draws" if report.software else "a graphics card draws"
    return Check(
        "OpenGL",
        "ok",
        f"{report.version}; {report.renderer} ({report.vendor}), {kind}; {report.window_class}; "
        f"textures up to {report.max_texture_size}, {report.texture_units} at once",
    )


def _shaders() -> Check:
    remedy = "python -m pip install --force-reinstall --no-deps flowtex"
    try:
        folder, names = shaders.shader_folder(), shaders.shader_names()
    except FileNotFoundError as error:
        return Check("Shaders", "fail", str(error), remedy)
    return Check("Shaders", "ok" if names else "fail", f"{len(names)} files in {folder}", remedy)


def _packages() -> list[Check]:
    checks = []
    for name in (*REQUIRED, *OPTIONAL, *OF_PYVISTA):
        extra = OPTIONAL.get(name)
        try:
            checks.append(Check(name, "ok", importlib.metadata.version(name)))
        except importlib.metadata.PackageNotFoundError:
            remedy = install_extra(extra) if extra else f"python -m pip install {name}"
            status: Literal["warn", "fail"] = "fail" if name in REQUIRED else "warn"
            use = "not installed"
            if extra:
                use += f"; needed only for the extra {extra!r}"
            elif name in OF_PYVISTA:
                use += f"; needed only for PyVista's {OF_PYVISTA[name]}"
            checks.append(Check(name, status, use, remedy))
    return checks


def print_checks(checks: Sequence[Check]) -> None:
    """Print the checks as a table, and each remedy on its own line that can be copied."""
    from rich.table import Table
    from rich.text import Text

    colours = {"ok": "green", "warn": "yellow", "fail": "bold red"}
    table = Table("", "what", "found", box=None)
    for check in checks:
        table.add_row(Text(check.status, colours[check.status]), check.name, Text(check.detail))
    console = terminal()
    console.print(table)
    for check in checks:
        if check.remedy and check.status != "ok":
            console.print(f"\n{check.name}, to fix it:")
            console.print(f"  {check.remedy}", soft_wrap=True)


def doctor() -> int:
    """Check the system that flowtex runs on, and name what is missing."""
    checks = diagnose()
    print_checks(checks)
    return int(any(check.status == "fail" for check in checks))
