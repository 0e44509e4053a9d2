"""The client's files, which are built into this folder, in a checkout and in a wheel alike."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).resolve().parent


def asset(name: str) -> Path:
    """Return the path of one of the client's files, such as ``"core.js"``."""
    path = _FOLDER / name
    if not path.is_file():
        msg = (
            f"{path} is missing. Install flowtex again: "
            "python -m pip install --force-reinstall --no-deps flowtex"
        )
        raise FileNotFoundError(msg)
    return path


def client_module() -> str:
    """Return the client as the text of a module, for widgets and pages."""
    return _joined("core.js", "exports.mjs")


def client_script(*, with_store: bool = False) -> str:
    """Return the client as a script that defines ``flowtex``, and ``flowtexStore`` to read one."""
    return _joined("core.js", *(("store.js",) if with_store else ()))


def _joined(*names: str) -> str:
    return "".join(asset(name).read_text("utf-8") for name in names)
