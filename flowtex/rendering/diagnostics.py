"""Diagnosis of OpenGL: its version and renderer, or the command that installs it.

VTK without an OpenGL library ends the process (a segmentation fault), so OpenGL is tried in a
second process, once. It runs this file alone, without the package, draws a picture of 16 x 16
pixels, reads it back and prints its report as one line of JSON.
"""

from __future__ import annotations

import importlib.metadata
import importlib.util
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import asdict, dataclass
from pathlib import Path

WINDOW_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
TRIAL_COMMAND = (sys.executable, "-P", str(Path(__file__).resolve()))
TRIAL_TIMEOUT_S = 120.0
#: Words in the names of renderers that draw with the processor.
SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "basic render", "gdi generic")

_trials: list[Future[OpenGLReport]] = []  #: The trial, once it has begun.


class OpenGLMissingError(RuntimeError):
    """VTK cannot draw on this machine; the text names what to install.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.rendering.diagnostics import OpenGLMissingError
    >>> try:
    ...     picture = flowtex.render(flowtex.examples.airfoil_field(), size=(80, 60), samples=5)
    ... except OpenGLMissingError as error:
    ...     print(error)
    """


@dataclass(frozen=True)
class OpenGLReport:
    """The OpenGL that VTK uses.

    ``usable`` says whether a picture could be drawn and read back; if not, ``failure`` says why and
    ``remedy`` what to do. ``software`` is true if the processor draws instead of a graphics card.
    ``max_texture_size`` is in texels along one side; ``texture_units`` is the number of textures
    that one fragment can read.

    Examples
    --------
    >>> from flowtex.rendering.diagnostics import opengl_report
    >>> opengl_report().texture_units >= 16
    True
    """

    usable: bool
    window_class: str = ""
    vendor: str = ""
    renderer: str = ""
    version: str = ""
    software: bool = False
    max_texture_size: int = 0
    texture_units: int = 0
    failure: str = ""
    remedy: str = ""


def has_display() -> bool:
    """Return whether a window could be opened."""
    if not sys.platform.startswith("linux"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def prefer_headless() -> None:
    """Have VTK draw through EGL where there is no display, unless the user chose otherwise."""
    if not has_display():  # VTK would warn of X for every window
        os.environ.setdefault(WINDOW_VARIABLE, "vtkEGLRenderWindow")


def begin_trial() -> Future[OpenGLReport]:
    """Start the trial of OpenGL in a second process, and return its future report."""
    if not _trials:
        prefer_headless()
        from flowtex._util.forks import call_at_fork
        from flowtex._util.progress import pool

        _trials.append(pool(1, "flowtex OpenGL").submit(run_trial, TRIAL_COMMAND))
        call_at_fork(after=_forget_unfinished_trial)
    return _trials[0]


def _forget_unfinished_trial() -> None:
    """Forget, in a forked process, a trial for which a thread of the process before waits."""
    if _trials and not _trials[0].done():
        _trials.clear()


def take_report(report: OpenGLReport) -> None:
    """Use the report of another process in place of a trial."""
    prefer_headless()
    trial = Future[OpenGLReport]()
    trial.set_result(report)
    _trials[:] = [trial]


def opengl_report() -> OpenGLReport:
    """Return a report on OpenGL. A second process tests it in about a second; the report is cached.

    Examples
    --------
    >>> from flowtex.rendering.diagnostics import opengl_report
    >>> opengl_report().usable
    True
    """
    return begin_trial().result()


def run_trial(command: Sequence[str], timeout: float = TRIAL_TIMEOUT_S) -> OpenGLReport:
    """Run a command whose last line is a report as JSON; return it, or a failed one."""
    try:
        process = subprocess.run(
            command,
            capture_output=True,
            encoding="utf-8",
            errors="replace",  # drivers print in any encoding
            timeout=timeout,
            check=False,
        )
    except (subprocess.TimeoutExpired, OSError) as error:
        return _unusable(f"the test could not be run: {error}")
    lines = process.stdout.strip().splitlines()
    if process.returncode == 0 and lines:
        report = OpenGLReport(**json.loads(lines[-1]))
        if report.usable:
            return report
        return _unusable(report.failure)
    code = process.returncode
    if code >= 0:
        errors = re.sub(r"\x1b\[[0-9;]*m", "", process.stderr).strip().splitlines()
        if errors:
            detail = f"; its last message: {errors[-1].rstrip('.')}"
        else:
            detail = ""
        return _unusable(f"the test process ended with code {code}{detail}")
    # Before a crash VTK prints advice about another library than the one that is missing.
    name = signal.strsignal(-code) or f"signal {-code}"
    return _unusable(f"{name} ended the test process, which happens without an OpenGL library")


def require_opengl() -> OpenGLReport:
    """Return the report of OpenGL, or raise an error if it cannot be used.

    Raises
    ------
    OpenGLMissingError
        When VTK cannot draw, which would crash the process. The text says what to install.

    Examples
    --------
    >>> from flowtex.rendering.diagnostics import require_opengl
    >>> require_opengl().usable
    True
    """
    report = opengl_report()
    if not report.usable:
        raise OpenGLMissingError(
            f"VTK cannot draw here: {report.failure}. To fix it:\n  {report.remedy}"
        )
    return report


def _unusable(failure: str) -> OpenGLReport:
    chosen = os.environ.get(WINDOW_VARIABLE, "")
    return OpenGLReport(usable=False, window_class=chosen, failure=failure, remedy=_remedy())


def _remedy() -> str:
    chosen = os.environ.get(WINDOW_VARIABLE, "")
    if importlib.util.find_spec("vtkmodules") is None:
        return "python -m pip install vtk"
    if "OSOpenGL" in chosen:
        return f"{install_command('libosmesa6')}, or unset {WINDOW_VARIABLE}"
    if not sys.platform.startswith("linux"):
        return "install a graphics driver with OpenGL 3.2 or later"
    if "EGL" in chosen or not has_display():
        return install_command("libegl1", "libgl1-mesa-dri")
    return install_command("libgl1", "libegl1", "libgl1-mesa-dri")


def install_command(*packages: str) -> str:
    """Return the command that installs Debian packages, or their names for other systems."""
    if shutil.which("apt-get") is None:
        return f"install Mesa's OpenGL (on Debian and Ubuntu: {' '.join(packages)})"
    if os.geteuid() == 0:
        sudo = ""
    else:
        sudo = "sudo "
    install = f"{sudo}apt-get install --no-install-recommends {' '.join(packages)}"
    return f"{sudo}apt-get update && {install}"


def try_opengl() -> OpenGLReport:
    """Draw a red picture with VTK and read it back, which may crash the process."""
    import vtkmodules.vtkRenderingOpenGL2 as gl
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

    window = gl.vtkOpenGLRenderWindow.SafeDownCast(vtkRenderWindow())
    renderer = vtkRenderer()
    pixel = vtkUnsignedCharArray()
    window.SetOffScreenRendering(1)
    window.SetSize(16, 16)
    renderer.SetBackground(1.0, 0.0, 0.0)
    window.AddRenderer(renderer)
    window.Render()
    window.GetPixelData(8, 8, 8, 8, 0, pixel, 0)
    rgb = tuple(pixel.GetValue(n) for n in range(pixel.GetNumberOfValues()))
    lines = window.ReportCapabilities().splitlines()
    words = dict(line.split(" string:", 1) for line in lines if " string:" in line)
    return OpenGLReport(
        usable=rgb == (255, 0, 0),
        window_class=window.GetClassName(),
        vendor=words.get("OpenGL vendor", "").strip(),
        renderer=(name := words.get("OpenGL renderer", "").strip()),
        version=words.get("OpenGL version", "").strip(),
        software=any(word in name.lower() for word in SOFTWARE),
        max_texture_size=gl.vtkTextureObject.GetMaximumTextureSize(window),
        texture_units=window.GetTextureUnitManager().GetNumberOfTextureUnits(),
        failure="" if rgb == (255, 0, 0) else f"a red test picture has the colour {rgb}",
    )


if __name__ == "__main__":
    sys.modules["numpy"] = None  # type: ignore[assignment] # VTK would load it, to no use here
    prefer_headless()
    sys.stdout.write(json.dumps(asdict(try_opengl())) + "\n")
