"""The client's files, which are built into this folder, in a checkout and in a wheel alike."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).resolve().parent


def asset(name: str) -> Path:
    """Return the path of one of the client's files, such as ``"client.js"``."""
    path = _FOLDER / name
    if not path.is_file():
        msg = (
            f"{path} is missing. Install flowtex again: "
            "python -m pip install --force-reinstall --no-deps flowtex"
        )
        raise FileNotFoundError(msg)
    return path
