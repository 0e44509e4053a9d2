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
    found = "none: pictures and the browser work, windows do not open"
    if has_display():
        found = os.environ.get("DISPLAY") or "the system's"
    checks = [
        Check("Python", "ok", f"{sys.version.split()[0]}, {sys.executable}"),
        _opengl(),
        Check("Display", "ok", found),
    ]
    try:
        checks.append(Check("Shaders", "ok", f"{shaders.shader_folder()}"))
    except FileNotFoundError as error:
        remedy = "python -m pip install --force-reinstall --no-deps flowtex"
        checks.append(Check("Shaders", "fail", str(error), remedy))
    for name in (*REQUIRED, *OPTIONAL):
        try:
            checks.append(Check(name, "ok", importlib.metadata.version(name)))
        except importlib.metadata.PackageNotFoundError:
            if (extra := OPTIONAL.get(name)) is None:
                remedy = f"python -m pip install {name}"
                checks.append(Check(name, "fail", "not installed", remedy))
                continue
            use = f"not installed; needed only for the extra {extra!r}"
            checks.append(Check(name, "warn", use, install_extra(extra)))
    return checks


def _opengl() -> Check:
    report = opengl_report()
    if not report.usable:
        return Check("OpenGL", "fail", report.failure, report.remedy)
    if report.software:
        kind = "the processor draws"
    else:
        kind = "a graphics card draws"
    return Check(
        "OpenGL",
        "ok",
        f"{report.version}; {report.renderer} ({report.vendor}), {kind}; {report.window_class}; "
        f"textures up to {report.max_texture_size}, {report.texture_units} at once",
    )


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
    for check in checks:
        if check.status == "fail":
            return 1
    return 0
