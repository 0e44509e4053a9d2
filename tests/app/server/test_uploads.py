"""Files that a page sends."""

from __future__ import annotations

import asyncio
import errno
from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import pytest

from flowtex.app.server import files
from flowtex.app.server.files import Routes, Uploads
from flowtex.errors import FieldError


@pytest.fixture
def taken() -> Iterator[tuple[Uploads, list[tuple[str, Path]]]]:
    arrived: list[tuple[str, Path]] = []
    made = Uploads(Routes(), lambda name, path: arrived.append((name, path)))
    yield made, arrived
    made.close()
    assert not made.folder.exists()


def send(to: Uploads, name: str, *parts: bytes) -> None:
    async def content() -> AsyncIterator[bytes]:
        for part in parts:
            yield part

    asyncio.run(to.receive(name, content()))


@pytest.mark.parametrize(
    "name",
    [
        "wake.vts",
        "../../etc/wake.vts",
        "/root/wake.vts",
        "C:\\runs\\wake.vts",
        ".wake.VTS",
        "a\0.vtk",
        *(f"{name}.vts" for name in ("风" * 300, "ä" * 90 + "\ud800", "x" * 255, "𝕏" * 100)),
    ],
    ids=ascii,
)
def test_a_name_is_never_a_path(taken: tuple[Uploads, list[tuple[str, Path]]], name: str) -> None:
    made, arrived = taken
    send(made, name, b"one ", b"two")
    ((shown, path),) = arrived
    assert path.resolve().is_relative_to(made.folder.resolve())
    assert path.name == shown and "/" not in shown and path.read_bytes() == b"one two"
    assert len(path.name.encode()) <= 200 and path.suffix == Path(name).suffix


@pytest.mark.parametrize(
    "name", ["series.pvd", "blocks.vtm", "a.foam", "a.pkl", "a.cgns", "", ".."]
)
def test_files_that_name_others_are_refused(
    taken: tuple[Uploads, list[tuple[str, Path]]], name: str
) -> None:
    with pytest.raises(FieldError, match="cannot be uploaded"):
        send(taken[0], name, b"x")
    assert not taken[1] and not list(taken[0].folder.iterdir())


def test_size_and_number_are_limited(
    taken: tuple[Uploads, list[tuple[str, Path]]], monkeypatch: pytest.MonkeyPatch
) -> None:
    made, arrived = taken
    monkeypatch.setattr(files, "UPLOAD_BYTES", 10)
    with pytest.raises(FieldError, match="MB at most"):
        send(made, "large.vts", b"12345678", b"9012")
    assert not list(made.folder.iterdir())
    for _ in range(files.MOST_UPLOADS):
        send(made, "small.vts", b"1")
    with pytest.raises(FieldError, match="uploaded already"):
        send(made, "small.vts", b"1")
    assert len({path for _, path in arrived}) == files.MOST_UPLOADS


def test_a_full_disk_is_told_and_leaves_nothing(
    taken: tuple[Uploads, list[tuple[str, Path]]], monkeypatch: pytest.MonkeyPatch
) -> None:
    made, arrived = taken
    full = OSError(errno.ENOSPC, "No space left on device", str(made.folder / "wake.vts"))

    async def content() -> AsyncIterator[bytes]:
        yield b"one"
        raise full

    for _ in range(files.MOST_UPLOADS + 1):
        with pytest.raises(FieldError, match="No space left on device") as refused:
            asyncio.run(made.receive("wake.vts", content()))
        assert str(made.folder) not in str(refused.value)
    assert not list(made.folder.iterdir())
    send(made, "wake.vts", b"two")
    assert len(arrived) == 1
