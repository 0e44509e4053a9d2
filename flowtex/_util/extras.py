"""The command that installs an optional part of flowtex."""

from __future__ import annotations

from pathlib import Path

__all__ = ["install_extra"]

_CHECKOUT = Path(__file__).resolve().parents[2]


def install_extra(extra: str) -> str:
    """Return the command that installs an extra such as ``"app"``.

    In a checkout that is an editable install of it, to be typed in its folder.
    """
    if (_CHECKOUT / "pyproject.toml").is_file():
        return f'python -m pip install -e ".[{extra}]"'
    return f'python -m pip install "flowtex[{extra}]"'
