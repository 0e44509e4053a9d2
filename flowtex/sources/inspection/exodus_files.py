"""Files of Exodus that meshio wrote."""

from __future__ import annotations

from pathlib import Path

#: The beginning of their title.
OWN_TITLE = b"Created by meshio"


def is_of_meshio(path: Path) -> bool:
    """Return whether meshio wrote a file of Exodus.

    Its dimensions differ from those of others, so VTK reads zeros, and single letters as names.
    """
    import h5py

    try:
        with h5py.File(path, "r", locking=False) as file:
            title = file.attrs.get("title", b"")
    except (OSError, RuntimeError, KeyError, ValueError):
        return False  # another format; the check of the file has the error of a damaged one
    if isinstance(title, bytes):
        return title.startswith(OWN_TITLE)
    return str(title).startswith(OWN_TITLE.decode())
