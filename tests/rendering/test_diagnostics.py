from __future__ import annotations

import ctypes.util
import os
import re
import signal
import sys

import pytest

from flowtex.rendering import diagnostics

CRASHES = (sys.executable, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")


@pytest.fixture
def headless(monkeypatch: pytest.MonkeyPatch) -> None:
    """Be on Linux without a display and without a choice of the user's."""
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", diagnostics.WINDOW_VARIABLE):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def apt(monkeypatch: pytest.MonkeyPatch) -> None:
    """Be a user, not root, on a machine that has apt-get."""
    monkeypatch.setattr("shutil.which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(os, "geteuid", lambda: 1000, raising=False)  # Windows has none


def test_the_trial_drew_a_picture(opengl: diagnostics.OpenGLReport) -> None:
    assert opengl.usable
    assert opengl.window_class.endswith("RenderWindow")
    assert opengl.vendor
    assert opengl.renderer
    assert re.match(r"\d\.\d", opengl.version)
    assert opengl.max_texture_size >= 4096
    assert opengl.texture_units >= 16
    assert opengl.failure == opengl.remedy == ""


def test_opengl_is_tried_once(monkeypatch: pytest.MonkeyPatch) -> None:
    diagnostics.opengl_report()
    monkeypatch.setattr(diagnostics, "run_trial", lambda _: pytest.fail("asked again"))
    assert diagnostics.opengl_report() is diagnostics.opengl_report()


@pytest.mark.usefixtures("headless", "apt")
def test_a_crash_becomes_a_report() -> None:
    found = diagnostics.run_trial(CRASHES)
    assert not found.usable
    assert found.failure == (
        "SIGSEGV ended the test process, which happens without an OpenGL library"
    )
    assert found.remedy == (
        "sudo apt-get update && "
        "sudo apt-get install --no-install-recommends libegl1 libgl1-mesa-dri"
    )


@pytest.mark.skipif(
    ctypes.util.find_library("OSMesa") is not None, reason="libosmesa6 is installed: no crash"
)
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="VTK uses OSMesa on Linux")
def test_vtk_without_its_library_really_crashes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(diagnostics.WINDOW_VARIABLE, "vtkOSOpenGLRenderWindow")
    found = diagnostics.run_trial(diagnostics.TRIAL_COMMAND)
    assert not found.usable
    assert f"{signal.SIGSEGV.name} ended" in found.failure
    assert "it said" not in found.failure  # VTK's advice names another library
    assert "\x1b" not in found.failure
    assert "libosmesa6" in found.remedy
    assert found.remedy.endswith("or unset VTK_DEFAULT_OPENGL_WINDOW")


@pytest.mark.parametrize(
    ("command", "limits", "failure"),
    [
        (
            (sys.executable, "-c", "import threading; threading.Event().wait()"),
            {"timeout": 0.2},
            "the test did not end within 0.2 s",
        ),
        (("/nowhere/python",), {}, "the test could not be started: "),
        (
            (sys.executable, "-c", "raise SystemExit('\\033[31mbad server\\033[0m')"),
            {},
            "the test process ended with code 1; its last message: bad server",
        ),
    ],
    ids=["hangs", "cannot start", "prints"],
)
def test_a_trial_that_fails_is_reported(
    command: tuple[str, ...], limits: dict[str, float], failure: str
) -> None:
    found = diagnostics.run_trial(command, **limits)
    assert found.failure.startswith(failure) and found.remedy


@pytest.mark.usefixtures("headless")
def test_a_wrong_picture_is_no_opengl() -> None:
    answer = '{"usable": false, "failure": "a red test picture has the colour (0, 0, 0)"}'
    found = diagnostics.run_trial((sys.executable, "-c", f"print({answer!r})"))
    assert not found.usable
    assert found.failure == "a red test picture has the colour (0, 0, 0)"
    assert "libgl1-mesa-dri" in found.remedy


@pytest.mark.usefixtures("apt")
def test_with_a_display_x_is_wanted_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.delenv(diagnostics.WINDOW_VARIABLE, raising=False)
    assert diagnostics.run_trial(CRASHES).remedy.endswith(" libgl1 libegl1 libgl1-mesa-dri")


@pytest.mark.usefixtures("apt")
def test_root_needs_no_sudo_and_other_systems_get_the_names(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 0, raising=False)
    assert diagnostics.install_command("libegl1") == (
        "apt-get update && apt-get install --no-install-recommends libegl1"
    )
    monkeypatch.setattr("shutil.which", lambda _: None)
    assert diagnostics.install_command("libegl1") == (
        "install Mesa's OpenGL (on Debian and Ubuntu: libegl1)"
    )


def test_require_opengl_returns_the_report_or_names_failure_and_remedy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    good = diagnostics.OpenGLReport(usable=True)
    monkeypatch.setattr(diagnostics, "opengl_report", lambda: good)
    assert diagnostics.require_opengl() is good
    broken = diagnostics.OpenGLReport(usable=False, failure="it crashed", remedy="install it")
    monkeypatch.setattr(diagnostics, "opengl_report", lambda: broken)
    expected = r"^VTK cannot draw here: it crashed\. To fix it:\n  install it$"
    with pytest.raises(diagnostics.OpenGLMissingError, match=expected):
        diagnostics.require_opengl()


@pytest.mark.usefixtures("headless")
def test_headless_prefers_egl_but_the_users_choice_stands(monkeypatch: pytest.MonkeyPatch) -> None:
    diagnostics.prefer_headless()
    assert os.environ[diagnostics.WINDOW_VARIABLE] == "vtkEGLRenderWindow"
    monkeypatch.setenv(diagnostics.WINDOW_VARIABLE, "vtkOSOpenGLRenderWindow")
    diagnostics.prefer_headless()
    assert os.environ[diagnostics.WINDOW_VARIABLE] == "vtkOSOpenGLRenderWindow"


@pytest.mark.usefixtures("headless")
@pytest.mark.parametrize(
    ("name", "value"), [("DISPLAY", ":0"), ("WAYLAND_DISPLAY", "wayland-0"), ("platform", "darwin")]
)
def test_a_display_is_left_alone(name: str, value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if name == "platform":
        monkeypatch.setattr(sys, "platform", value)
    else:
        monkeypatch.setenv(name, value)
    diagnostics.prefer_headless()
    assert diagnostics.WINDOW_VARIABLE not in os.environ
