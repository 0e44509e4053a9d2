"""Files that are complete or not there, and every writer of the package."""

from __future__ import annotations

import errno
import io
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex._util.whole_file import WholeFile, whole_file
from flowtex.host.view import web_views
from flowtex.plotting.offscreen.encoders import MovieWriter

posix = pytest.mark.skipif(os.name != "posix", reason="modes, links and limits of POSIX")
OLD = b"the old file"


class Disk(io.FileIO):
    """A file on a disk that takes this many bytes in all."""

    free = 0

    def write(self, data: Any) -> int:
        count = min(memoryview(data).nbytes, Disk.free)
        if count == 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        Disk.free -= count
        return super().write(memoryview(data).cast("B")[:count]) or 0


def pictures(count: int = 6) -> list[Any]:
    """Noise, which nothing compresses."""
    noise = np.random.default_rng(0)
    return list(noise.integers(0, 255, (count, 64, 64, 3), dtype=np.uint8))


def export_page(path: Path) -> None:
    flowtex.export(flowtex.examples.double_gyre_field(shape=(11, 21)), path, samples=5)


def embed_scene(path: Path) -> None:
    from embed import write_scene  # of docs/, which a child does not know

    # With parts beside it.
    views = web_views(flowtex.examples.delta_wing_field(), flowtex.scene.options.Options.split())
    write_scene(path.parent, path.stem, views)


def save_movie(path: Path) -> None:
    with closing(MovieWriter(path, (64, 64), 10.0, 80)) as writer:
        for picture in pictures():
            writer.add(picture)
        writer.finish()


WRITERS: dict[str, Callable[[Path], None]] = {
    "page.html": export_page,
    "scene.js": embed_scene,
    "movie.gif": save_movie,
    "movie.webp": save_movie,
}


@pytest.mark.usefixtures("quick_export")
@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_leaves_the_old_file_alone(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / name
    WRITERS[name](path)
    size = sum(file.stat().st_size for file in tmp_path.iterdir())
    for file in tmp_path.iterdir():
        file.unlink()
    path.write_bytes(OLD)
    monkeypatch.setattr("flowtex._util.whole_file.io.FileIO", Disk)
    for share in (0.0, 0.5, 0.999):
        Disk.free = int(share * size)
        with pytest.raises(OSError, match=os.strerror(errno.ENOSPC)) as held:
            WRITERS[name](path)
        assert list(tmp_path.iterdir()) == [path] and path.read_bytes() == OLD
        assert held.value.__traceback__, "its frames hold what was being written"


LIMITED = """
import resource, signal, sys
from pathlib import Path
sys.path.insert(0, sys.argv[3])
from test_whole_file import OLD, save_movie
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
path = Path(sys.argv[1])
for limit in map(int, sys.argv[2].split(",")):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        save_movie(path)
    except OSError as error:
        assert error.strerror == "File too large", error
    else:
        raise AssertionError(limit)
    assert list(path.parent.iterdir()) == [path] and path.read_bytes() == OLD, limit
"""


@posix
@pytest.mark.parametrize("suffix", [".mp4", ".gif"])
def test_a_movie_that_libraries_cannot_write_leaves_the_old_file_alone(
    suffix: str, tmp_path: Path
) -> None:
    if suffix == ".mp4":
        pytest.importorskip("av")
    path = tmp_path / f"movie{suffix}"
    save_movie(path)
    size = path.stat().st_size
    path.write_bytes(OLD)
    # Frames wait in their own file before Pillow writes a GIF; both fall below the limits.
    limits = ",".join(map(str, (10, size // 2, size - 1)))
    command = [sys.executable, "-c", LIMITED, str(path), limits, str(Path(__file__).parent)]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr


@posix
def test_a_file_that_is_replaced_keeps_its_mode_and_a_new_one_has_the_usual(tmp_path: Path) -> None:
    old, new, usual = tmp_path / "old", tmp_path / "new", tmp_path / "usual"
    old.write_bytes(OLD)
    for mode in (0o600, 0o640, 0o666):
        old.chmod(mode)
        for_old = WholeFile(old)
        assert for_old.part.stat().st_mode & 0o777 == mode  # also while it is written
        for_old.keep()
        assert old.stat().st_mode & 0o777 == mode
    with whole_file(new):
        pass
    usual.touch()
    assert new.stat().st_mode == usual.stat().st_mode


@posix
def test_a_link_is_followed_and_stays(tmp_path: Path) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (folder / "target").write_bytes(OLD)
    links = [tmp_path / "link", tmp_path / "broken"]
    links[0].symlink_to("elsewhere/target")
    links[1].symlink_to("elsewhere/new")
    for link in links:
        with whole_file(link) as file:
            file.write(b"new")
        assert link.is_symlink() and link.read_bytes() == b"new"
    assert sorted(file.name for file in folder.iterdir()) == ["new", "target"]


@posix
def test_what_is_no_file_is_not_replaced(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (tmp_path, pipe, Path(os.devnull), tmp_path / "missing" / "file"):
        with pytest.raises(OSError, match=path.name):
            WholeFile(path)
    assert list(tmp_path.iterdir()) == [pipe]
