"""Signals end a program as Ctrl-C does."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from served import signals_of_a_terminal
from waiting import PATIENCE_S, wait_until

from flowtex import examples
from flowtex._util.terminal import Ended, ended_by_signals
from flowtex.cli import commands, main


@pytest.fixture(autouse=True)
def _signals() -> Iterator[None]:
    with signals_of_a_terminal():
        yield


pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_what_goes_on_once(number: int) -> None:
    before = signal.getsignal(number)
    cleaned = []
    other = signal.SIGHUP if number == signal.SIGTERM else signal.SIGTERM
    with pytest.raises(Ended) as ended, ended_by_signals():
        try:
            signal.raise_signal(number)
        finally:
            signal.raise_signal(other)  # as a terminal that closes sends both
            cleaned.append(True)
            raise OSError  # nor can anything be written to it
    assert ended.value.code == 128 + number and cleaned == [True]
    assert signal.getsignal(number) is before


def test_next_signal_ends_program_that_swallowed_first() -> None:
    with pytest.raises(Ended) as ended, ended_by_signals():
        with suppress(Ended):  # as in a callback of C
            signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGHUP)
    assert ended.value.code == 128 + signal.SIGTERM


def test_the_end_is_not_interrupted() -> None:
    calls = []
    with pytest.raises(Ended), ended_by_signals():
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            with pytest.raises(OSError), suppress(ValueError):
                raise OSError  # what is handled here came of the end
            for _ in range(3):
                signal.raise_signal(signal.SIGTERM)
                calls.append(1)
    assert len(calls) == 3


def test_the_shell_says_what_has_ended_it(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        monkeypatch.setattr(
            commands, "app", lambda *_, number=number, **__: signal.raise_signal(number)
        )
        assert main(["info"]) == 128 + number
        name = "" if number == signal.SIGINT else f"ended by {number.name}"
        assert name in capfd.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_movie_that_is_ended_leaves_nothing(
    tmp_path: Path, opengl: object, number: signal.Signals
) -> None:
    mesh, path, temporary = tmp_path / "gyre.vts", tmp_path / "gyre.gif", tmp_path / "tmp"
    examples.double_gyre().save(mesh)
    path.write_bytes(b"old")
    temporary.mkdir()
    command = ["movie", str(mesh), "-o", str(path), "--seconds", "600", "--size", "64x64"]
    process = subprocess.Popen(
        [sys.executable, "-m", "flowtex", *command],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(temporary)},
    )
    wait_until(lambda: list(tmp_path.glob(".gyre.*.part.gif")) or process.poll() is not None)
    assert process.poll() is None
    process.send_signal(number)
    said = process.communicate(timeout=PATIENCE_S)[1]
    assert process.returncode == 128 + number, said
    assert (f"ended by {number.name}" in said) == (number != signal.SIGINT)
    assert "Traceback" not in said
    assert path.read_bytes() == b"old" and sorted(tmp_path.iterdir()) == [path, mesh, temporary]
    assert list(temporary.iterdir()) == []


@pytest.mark.parametrize("module", ["numpy", "cyclopts", "pyvista"])
def test_an_interrupt_during_an_import_ends_quietly(tmp_path: Path, module: str) -> None:
    """Of the package, of the command line, and of a command."""
    mesh = tmp_path / "gyre.vts"
    examples.double_gyre().save(mesh)
    imitation = tmp_path / "modules" / f"{module}.py"
    imitation.parent.mkdir()
    imitation.write_text("import signal\nsignal.raise_signal(signal.SIGINT)\n")
    done = subprocess.run(
        [sys.executable, "-m", "flowtex", "info", str(mesh)],
        env={**os.environ, "PYTHONPATH": str(imitation.parent)},
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE_S,
    )
    assert (done.returncode, done.stdout, done.stderr) == (128 + signal.SIGINT, "", "")


def test_an_interrupt_in_a_callback_of_vtk_ends_with_its_code() -> None:
    pytest.importorskip("vtkmodules")
    code = """
import signal
from vtkmodules.vtkCommonCore import vtkObject
from flowtex._util.terminal import ended_by_signals
with ended_by_signals():
    observed = vtkObject()
    observed.AddObserver("ModifiedEvent", lambda *_: signal.raise_signal(signal.SIGINT))
    observed.Modified()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 128 + signal.SIGINT


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no signal to a process itself")
def test_ctrl_c_after_a_command_is_complete_changes_nothing() -> None:
    """Python gives SIGINT its default effect late in its end, after the result was printed."""
    code = (
        "import os, signal; from flowtex._util import command; print('done', flush=True); "
        "command._leave(); os.kill(os.getpid(), signal.SIGINT)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "done\n", "")
