"""Trace slices as a Zarr group.

::

    zarr.json              attributes: what the slices are, "flowtex"
    unit                   (j, i)
    nodes                  (j, i, component)
    displacement, forward  (time, lag, j, i, component)
    rate                   (time, j, i, tangent)
    reach, forward_reach   (time, j, i)

The arrays have the type that they had in memory. A reader takes only the attributes and the chunks
from a store: what the arrays are follows from the attributes, which it checks.
"""

from __future__ import annotations

import math
import secrets
import shutil
from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import checked_path
from flowtex._util.array_types import AnyArray
from flowtex._util.json_checks import (
    Check,
    by_name,
    either,
    is_number,
    is_text,
    list_of,
    or_none,
    whole,
)
from flowtex._util.memory import check_memory
from flowtex.errors import FieldError, import_extra

if TYPE_CHECKING:
    from zarr import Group
    from zarr.abc.store import Store

FORMAT = "flowtex-slices-1"  #: Format of every group; a reader refuses any other.
MOST_LAGS = 1000  #: Most lags.
MOST_STEPS = 10**6  #: Most destination times.
MOST_NODES = 10**8  #: Most nodes along an axis.
ZSTD_LEVEL = 3  #: Level of the compression.
#: Axes of the arrays by their names.
AXES = {
    "unit": ("j", "i"),
    "nodes": ("j", "i", "component"),
    "rate": ("time", "j", "i", "tangent"),
    "reach": ("time", "j", "i"),
    "forward_reach": ("time", "j", "i"),
    "displacement": ("time", "lag", "j", "i", "component"),
    "forward": ("time", "lag", "j", "i", "component"),
}
ON_BOTH_SIDES = ("forward", "forward_reach")  #: Arrays that one-sided slices lack.
_REQUIRED = set(AXES) - set(ON_BOTH_SIDES)
#: Required entries of the attributes; more are allowed.
_ABOUT: dict[str, Check] = {
    "format": either(FORMAT),
    "parameter": either("arclength", "time"),
    "shape": list_of(whole(1, MOST_NODES), 2),
    "components": either(2, 3),
    "times": list_of(is_number, 1, MOST_STEPS),
    "lags": list_of(is_number, 1, MOST_LAGS),
    "arrays": by_name(either("float32", "float64")),
    "surface": or_none(is_text),
    "velocities": or_none(list_of(is_text, 1, MOST_STEPS)),
    "length_unit": or_none(is_text),
    "time_unit": or_none(is_text),
    "tolerance": or_none(is_number),
}


def write_group(path: str | Path, arrays: Mapping[str, AnyArray], about: Mapping[str, Any]) -> None:
    """Write slices to a folder, which replaces slices of that name once it is complete.

    Parameters
    ----------
    path
        The folder.
    arrays
        Arrays by name, see ``AXES``.
    about
        Attributes, without the format and the types of the arrays, which are added.

    Raises
    ------
    FieldError
        When something else than slices has the name.
    OSError
        When the folder cannot be written.
    ModuleNotFoundError
        When Zarr is not installed.
    """
    zarr = import_extra("zarr", "store")
    target = checked_path("path", path)
    if target.exists() and not _has_slices(target):
        raise FieldError(f"{path} exists and contains no trace slices; choose another name")
    types = {name: array.dtype.name for name, array in arrays.items()}
    attributes = {**about, "format": FORMAT, "arrays": types}
    part = target.with_name(f".{target.name}.{secrets.token_hex(4)}.part")
    try:
        group = _new_group(zarr.storage.LocalStore(part), attributes)
        for name, array in arrays.items():
            stored: Any = group[name]
            stored[...] = array
        _replace(target, part)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def read_group(path: str | Path) -> tuple[dict[str, AnyArray], dict[str, Any]]:
    """Return the arrays of slices by name, and the attributes.

    Parameters
    ----------
    path
        Folder that :func:`write_group` wrote.

    Raises
    ------
    FieldError
        When the folder contains no slices, or they are damaged or do not fit into memory.
    FileNotFoundError
        When there is no such folder.
    ModuleNotFoundError
        When Zarr is not installed.
    """
    zarr = import_extra("zarr", "store")
    from flowtex._util.zarr_stores import checked_folder

    place = checked_path("path", path)
    if not place.exists():
        raise FileNotFoundError(f"{path} does not exist; expected slices from TraceSlices.save")
    about = _checked_about(_attributes(place), str(path))
    described = _new_group(zarr.storage.MemoryStore(), about)
    size = sum(array.nbytes for _, array in described.arrays())
    check_memory(size, f"the attributes of {path}")
    store = checked_folder(place)
    arrays = {}
    for name, array in described.arrays():
        try:
            arrays[name] = _read(store, name, array)
        except (OSError, ValueError, RuntimeError, KeyError, TypeError) as error:
            raise FieldError(
                f"the array {name} of {path} is damaged ({error}); trace the field and save again"
            ) from error
    return arrays, about


def _read(store: Store, name: str, described: Any) -> AnyArray:
    """Return the values of an array; an error names a chunk that is missing."""
    from zarr import Array

    from flowtex._util.zarr_codecs import bounded

    array = Array(bounded(described.metadata, store, name))
    # Zarr takes a missing chunk for zeros.
    missing = array.nchunks - array.nchunks_initialized
    if missing:
        raise ValueError(f"{missing} of {array.nchunks} chunks are missing")
    return np.asarray(array[...])


def _new_group(store: Store, about: Mapping[str, Any]) -> Group:
    """Return a new group in a store, with these attributes and empty arrays."""
    zarr = import_extra("zarr", "store")
    from zarr.codecs import BloscCodec, Crc32cCodec

    sizes = {
        "time": len(about["times"]),
        "lag": len(about["lags"]),
        "j": about["shape"][0],
        "i": about["shape"][1],
        "component": about["components"],
        "tangent": 2,
    }
    group: Group = zarr.group(store, attributes={"flowtex": dict(about)}, zarr_format=3)
    for name, dtype in about["arrays"].items():
        packer = BloscCodec(cname="zstd", clevel=ZSTD_LEVEL, shuffle="bitshuffle")
        group.create_array(
            name,
            shape=tuple(sizes[axis] for axis in AXES[name]),
            dtype=dtype,
            compressors=[packer, Crc32cCodec()],
            dimension_names=AXES[name],
            config={"write_empty_chunks": True},
        )
    return group


def _attributes(place: Path) -> Any:
    """Return the attributes that describe slices, ``None`` where there are none."""
    zarr = import_extra("zarr", "store")
    from flowtex._util.zarr_stores import checked_folder

    opened = partial(zarr.open_group, mode="r", zarr_format=3, use_consolidated=False)
    try:
        return opened(checked_folder(place)).attrs.get("flowtex")
    except FieldError:  # of a codec that is refused
        raise
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _has_slices(place: Path) -> bool:
    """Return whether a folder contains slices, of any version."""
    about = _attributes(place)
    if not isinstance(about, dict):
        return False
    return str(about.get("format")).startswith("flowtex-slices-")


def _checked_about(about: Any, place: str) -> dict[str, Any]:
    """Return attributes that are valid; an error says what is wrong."""
    if not isinstance(about, dict) or "format" not in about:
        raise FieldError(
            f"{place} contains no trace slices; expected a folder from TraceSlices.save"
        )
    if about["format"] != FORMAT:
        raise FieldError(
            f"{place} has format {str(about['format'])[:40]!r}; expected {FORMAT!r}: trace the "
            "field and save again"
        )
    wrong = []
    for name, check in _ABOUT.items():
        if not check(about.get(name)):
            wrong.append(name)
    if not wrong:
        wrong = _contradictions(about)
    if wrong:
        raise FieldError(
            f"the attributes of {place} are damaged ({', '.join(wrong)}); trace the field and "
            "save again"
        )
    return about


def _contradictions(about: Mapping[str, Any]) -> list[str]:
    """Return the names of valid attributes that cannot be those of slices."""
    wrong = []
    lags = np.array(about["lags"])
    if not np.all(np.diff(lags, prepend=0.0) > 0):
        wrong.append("lags")
    names = set(about["arrays"])
    two_sided = names == set(AXES)
    if names != _REQUIRED and not two_sided:
        wrong.append("arrays")
    velocities = about["velocities"]
    if velocities is not None and len(velocities) != len(about["times"]):
        wrong.append("velocities")
    if math.prod(about["shape"]) > MOST_NODES:
        wrong.append("shape")
    return wrong


def _replace(target: Path, part: Path) -> None:
    """Move a complete folder to its name; the one that has it is removed."""
    if not target.exists():
        part.rename(target)
        return
    old = target.with_name(f"{part.name}.old")
    target.rename(old)
    try:
        part.rename(target)
    except OSError:
        with suppress(OSError):
            old.rename(target)
        raise
    shutil.rmtree(old, ignore_errors=True)
