"""Where the two files of the liquid-oxygen post lie: a folder of the user's, or PyVista's cache."""

from __future__ import annotations

from pathlib import Path

__all__ = ["find_post"]

GRID, SOLUTION = "postxyz.bin", "postq.bin"


def find_post(folder: str | Path | None = None) -> Path:
    """Path of the grid, with the solution beside it.

    Parameters
    ----------
    folder : str or Path, optional
        Folder with both files. By default PyVista fetches them into its cache.

    Raises
    ------
    FileNotFoundError
        When a file is missing and, without a folder, cannot be downloaded.
    """
    if folder is None:
        return _downloaded()
    place = Path(folder).expanduser()
    missing = [name for name in (GRID, SOLUTION) if not (place / name).is_file()]
    if missing:
        message = (
            f"{place} has no {' and no '.join(missing)}; give the folder that holds {GRID} and "
            f"{SOLUTION}, or none to download them with PyVista"
        )
        raise FileNotFoundError(message)
    return place / GRID


def _downloaded() -> Path:
    """Both files from PyVista's collection, which follows VTK's own test data in their names."""
    from pyvista.examples import downloads

    try:
        paths = [Path(str(downloads.download_file(name))) for name in (GRID, SOLUTION)]
    # What the network raises (requests) derives from OSError.
    except OSError as error:
        message = (
            f"PyVista could not download {GRID} and {SOLUTION} ({type(error).__name__}); check the "
            "network, or give the folder that holds them, as in liquid_oxygen_post(folder=...)"
        )
        raise FileNotFoundError(message) from error
    return paths[0]
