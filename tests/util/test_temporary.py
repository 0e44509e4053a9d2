"""Temporary folders that go, however a process ends."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from flowtex._util.whole_file import TemporaryFolder

pytestmark = pytest.mark.skipif(os.name != "posix", reason="locks of POSIX")

HOLD = """
import os, signal, sys, tempfile
from flowtex._util.whole_file import TemporaryFolder
folder = TemporaryFolder()
(folder.new_folder() / "file").write_text("x")
print(folder.path, flush=True)
if sys.argv[1] == "killed":
    os.kill(os.getpid(), signal.SIGKILL)
if sys.argv[1] == "waits":
    sys.stdin.read()
if sys.argv[1] == "forks" and os.fork() == 0:
    sys.exit()
if sys.argv[1] == "forks":
    os.wait()
    assert folder.path.is_dir()
"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder for temporary files, of this process and of others."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path


def hold(how: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", HOLD, how], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )


def path_of(process: subprocess.Popen[str]) -> Path:
    assert process.stdout is not None
    return Path(process.stdout.readline().strip())


def test_a_folder_of_a_process_that_was_killed_is_removed_by_the_next(place: Path) -> None:
    with hold("waits") as waits:
        used = path_of(waits)
        # Begun after the other has its folder, which would remove that of a killed process.
        with hold("killed") as killed:
            left = path_of(killed)
        # Folders of other programs and of people are none of ours.
        others = [place / "flowtex-results.tmp.d", place / "flowtex-data", place / "flowtex-a.tmp"]
        for other in others:
            other.mkdir()
        assert left.is_dir()
        own = TemporaryFolder()
        assert sorted(place.iterdir()) == sorted([own.path, used, *others])
        assert (used.stat().st_mode, own.path.stat().st_mode) == (stat.S_IFDIR | 0o700,) * 2
        waits.communicate("")
    assert not used.exists()


def test_a_folder_goes_with_its_owner(place: Path) -> None:
    one, two = TemporaryFolder(), TemporaryFolder()
    one.close()
    one.close()
    del two
    assert not any(place.iterdir())
    with hold("forks") as forks:
        assert forks.wait(60) == 0
    assert not any(place.iterdir())
