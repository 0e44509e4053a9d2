from __future__ import annotations

import ctypes.util
import os
import re
import sys

import pytest
from waiting import PATIENCE_S

from flowtex.rendering import diagnostics

WINDOW = diagnostics.WINDOW_VARIABLE


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """Be a user on Linux with apt-get, without a display and without a choice of the user's."""
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", WINDOW):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("shutil.which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(os, "geteuid", lambda: 1000, raising=False)  # Windows has none
    return monkeypatch


def test_the_trial_drew_a_picture(opengl: diagnostics.OpenGLReport) -> None:
    assert opengl.usable
    assert opengl.window_class.endswith("RenderWindow")
    assert opengl.vendor
    assert opengl.renderer
    assert re.match(r"\d\.\d", opengl.version)
    assert opengl.max_texture_size >= 4096
    assert opengl.texture_units >= 16
    assert opengl.failure == opengl.remedy == ""


@pytest.mark.parametrize(
    ("command", "timeout", "failure"),
    [
        (
            "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)",
            PATIENCE_S,
            "Segmentation fault ended the test",
        ),
        ("import threading; threading.Event().wait()", 0.2, r"timed out after 0\.2 seconds"),
        (
            "raise SystemExit('\\033[31mbad\\033[0m')",
            PATIENCE_S,
            "process ended with code 1; .* message: bad",
        ),
        ("""print('{"usable": false, "failure": "it is black"}')""", PATIENCE_S, "it is black"),
    ],
)
def test_trial_that_fails_is_reported(
    machine: pytest.MonkeyPatch, command: str, timeout: float, failure: str
) -> None:
    found = diagnostics.run_trial((sys.executable, "-c", command), timeout)
    assert not found.usable and re.search(failure, found.failure)
    words = "apt-get install --no-install-recommends libegl1 libgl1-mesa-dri"
    assert found.remedy == f"sudo apt-get update && sudo {words}"
    machine.setenv("DISPLAY", ":0")
    found = diagnostics.run_trial(("/nowhere/python",))
    assert found.failure.startswith("the test could not be run: ")
    assert found.remedy.endswith(" libgl1 libegl1 libgl1-mesa-dri")


@pytest.mark.skipif(
    ctypes.util.find_library("OSMesa") is not None, reason="libosmesa6 is installed: no crash"
)
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="VTK uses OSMesa on Linux")
def test_vtk_without_its_library_really_crashes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(WINDOW, "vtkOSOpenGLRenderWindow")
    found = diagnostics.run_trial(diagnostics.TRIAL_COMMAND)
    assert not found.usable and "Segmentation fault ended" in found.failure
    assert "libosmesa6" in found.remedy
    assert found.remedy.endswith("or unset VTK_DEFAULT_OPENGL_WINDOW")


def test_require_opengl_names_failure_and_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = diagnostics.OpenGLReport(usable=False, failure="it crashed", remedy="install it")
    monkeypatch.setattr(diagnostics, "opengl_report", lambda: broken)
    expected = r"^VTK cannot draw here: it crashed\. To fix it:\n  install it$"
    with pytest.raises(diagnostics.OpenGLMissingError, match=expected):
        diagnostics.require_opengl()


def test_headless_prefers_egl_but_a_choice_or_a_display_stands(
    machine: pytest.MonkeyPatch,
) -> None:
    diagnostics.prefer_headless()
    assert os.environ[WINDOW] == "vtkEGLRenderWindow"
    machine.setenv(WINDOW, "vtkOSOpenGLRenderWindow")
    diagnostics.prefer_headless()
    assert os.environ[WINDOW] == "vtkOSOpenGLRenderWindow"
    machine.delenv(WINDOW)
    machine.setenv("WAYLAND_DISPLAY", "wayland-0")
    diagnostics.prefer_headless()
    assert WINDOW not in os.environ
