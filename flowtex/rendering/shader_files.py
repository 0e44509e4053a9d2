"""Where the GLSL text lies, and how it is read.

The shaders are files in a folder of their own, which has two places: an installed wheel carries
them as ``flowtex/_shaders``, a checkout (also one installed as editable) has them as ``shaders``
beside the package. The folder is found from where this module lies and never from the working
folder, so that a stray ``shaders`` folder of the user's is not taken for ours.
"""

from __future__ import annotations

from pathlib import Path, PurePosixPath

__all__ = ["shader_folder", "shader_names", "shader_source"]

_PACKAGE = Path(__file__).resolve().parents[1]


def shader_folder(package: Path = _PACKAGE) -> Path:
    """Return the folder that holds the shaders.

    Parameters
    ----------
    package : Path
        The folder of the package ``flowtex``.

    Raises
    ------
    FileNotFoundError
        When neither an installed nor a checkout's folder is there.
    """
    installed = package / "_shaders"
    if installed.is_dir():
        return installed
    checkout = package.parent
    # Beside an installed package lies site-packages, where "shaders" would be someone else's.
    if (checkout / "pyproject.toml").is_file() and (checkout / "shaders").is_dir():
        return checkout / "shaders"
    msg = (
        f"flowtex's shaders are missing: there is neither {installed} nor {checkout / 'shaders'}. "
        "Install flowtex again: python -m pip install --force-reinstall --no-deps flowtex"
    )
    raise FileNotFoundError(msg)


def shader_names(folder: Path | None = None) -> tuple[str, ...]:
    """Return the name of every shader, sorted, such as ``"common/noise.glsl"``.

    Parameters
    ----------
    folder : Path, optional
        Where to look; flowtex's own folder when left out.
    """
    folder = shader_folder() if folder is None else folder
    found = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return tuple(
        sorted(path.as_posix() for path in found if not any(p.startswith(".") for p in path.parts))
    )


def shader_source(name: str, folder: Path | None = None) -> str:
    """Return the text of one shader.

    Parameters
    ----------
    name : str
        Its path inside the folder, with forward slashes: ``"common/noise.glsl"``.
    folder : Path, optional
        Where to look; flowtex's own folder when left out.

    Raises
    ------
    ValueError
        When the name is empty or leads out of the folder.
    FileNotFoundError
        When there is no such shader; the text lists those that there are.
    """
    folder = shader_folder() if folder is None else folder
    if not _stays_inside(name, folder):
        msg = (
            f"shader name {name!r} leaves the shader folder: expected a path inside it, "
            "with forward slashes, such as 'common/noise.glsl'"
        )
        raise ValueError(msg)
    names = shader_names(folder)
    if name not in names:
        known = ", ".join(names) or "none"
        msg = f"no shader is called {name!r}; there are: {known}"
        raise FileNotFoundError(msg)
    return (folder / name).read_text(encoding="utf-8")


def _stays_inside(name: str, folder: Path) -> bool:
    """Tell whether a name is a plain relative path that no link leads elsewhere."""
    parts = PurePosixPath(name).parts
    if not parts or name.startswith("/") or "\\" in name or ".." in parts or ":" in parts[0]:
        return False
    return (folder / name).resolve().is_relative_to(folder.resolve())
