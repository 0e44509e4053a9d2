"""Text files of particle image velocimetry and of solvers, as tables.

Numbers in columns follow lines of words, of which the last one may name the columns. Known are
OpenPIV, PIVlab, DaVis, COMSOL, ANSYS Fluent and CFX, CODAR's radars, sampled surfaces of OpenFOAM,
and columns x, y, u, v without any header.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import filterfalse, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.memory import check_memory
from flowtex.errors import FieldError, import_extra
from flowtex.sources.inspection.tecplot_files import is_tecplot_text
from flowtex.sources.notices import NOTE
from flowtex.sources.opening import tables

if TYPE_CHECKING:
    import xarray as xr

#: Fewest columns: two places and two components.
FEWEST = 4
#: Characters of a file that tell its kind.
HEAD_CHARACTERS = 200
#: Most lines of words above the numbers.
MOST_ABOVE = 200
#: A number with a decimal point.
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eEdD][-+]?\d+)?|[-+]?nan|[-+]?inf", re.IGNORECASE)
#: Exponents of double precision as Fortran writes them.
EXPONENTS = str.maketrans("dD", "ee")
#: Characters between columns; ``None`` for white space.
SEPARATORS = ("\t", ";", ",", None)
#: Beginnings of files whose columns are below other lines than their names alone.
PREAMBLES = re.compile(r"\s*(%|#\s*DaVis|PIVlab|\[(Name|Data)\])", re.IGNORECASE)
#: A line that is a comment.
COMMENT = re.compile(r"\s*[#%!]")
#: The line of CODAR that names the columns, and their names and units here.
CODAR = re.compile(r"%TableColumnTypes:\s*(.*)")
OF_CODAR = {"LOND": "lon", "LATD": "lat", "VELU": "u [cm/s]", "VELV": "v [cm/s]"}
#: Quoted words in the header of DaVis: a quantity, and its unit.
DAVIS = re.compile(r'"([^"]*)"\s+"([^"]*)"')
#: One of the times of COMSOL, in a column's name.
AT_TIME = re.compile(r"^(.*?)\s*@\s*t\s*=\s*([-+.\deE]+)\s*$")
#: The unit of places of COMSOL.
LENGTH_UNIT = re.compile(r"^\W*Length unit:\s*(\S+)", re.IGNORECASE)
#: A column's name with its unit and time, among others with white space between.
WORD = re.compile(r"[^\s(\[]+(?:\s*[\[(][^)\]]*[\])])?(?:\s*@\s*t=\S+)?")
#: The name of the column of flags of DaVis, and of columns without a header.
FLAG = "flag"
#: Values of flags that mark vectors to leave out, by the column and its program.
BAD_FLAGS = {FLAG: (1,), "flags": (1,), "mask": (1,), "Vector type": (0,)}
#: Columns of OpenPIV.
OPENPIV = ("x", "y", "u", "v", "flags", "mask")
#: Those of its earlier versions, whose mask marks vectors that the validation rejected.
OLD_OPENPIV = ("x", "y", "u", "v", "mask")


@dataclass(frozen=True)
class Layout:
    """Where the numbers of a text file are, and how they are written."""

    above: tuple[str, ...]  #: Lines above the numbers.
    separator: str | None
    decimal: str
    columns: int


def has_preamble(path: Path) -> bool:
    """Return whether lines other than the names of columns begin a text file."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        beginning = file.read(HEAD_CHARACTERS)
    return PREAMBLES.match(beginning) is not None


def read_text(path: Path) -> xr.Dataset:
    """Read a text file with columns of places and components.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    xarray.Dataset
        A grid if the rows are those of a lattice, else points along one dimension.

    Raises
    ------
    FieldError
        For a file without columns of numbers, or with a row that is too short.
    """
    layout = _layout(path)
    is_plain = len(layout.above) == 1 and not layout.above[0].startswith("#")
    if is_plain and not has_preamble(path):
        return tables.read_csv(path)
    frame = _numbers(path, layout)
    header = "".join(layout.above)
    note = ""
    flags: tuple[str, ...] = (FLAG,)
    if not layout.above:
        frame, note = _by_order(frame)
    elif header.startswith("#DaVis"):
        # DaVis writes zeros where it has no vector.
        still = (frame.iloc[:, 2:4] == 0).all(axis=1)
        frame.columns = _davis_names(header, layout.columns)
        frame[FLAG] = still.astype(int)
    else:
        frame.columns = _names(layout)
        flags = _flags(header, frame.columns)
    ds = tables.of_table(_by_time(frame))
    for name in set(flags) & set(ds.variables):
        ds[name].attrs.update(_flag_attributes(BAD_FLAGS[name]))
    if note:
        ds.encoding[NOTE] = note
    return ds


def read_columns(path: Path) -> xr.Dataset:
    """Read a file of separated values, which may begin with other lines than the header."""
    if has_preamble(path) or _begins_with_numbers(path):
        return read_text(path)
    return tables.read_csv(path)


def has_columns(path: Path) -> bool:
    """Return whether a file has rows of numbers, below one line of words at most and comments.

    Files with such an ending may have other content, such as zones of Tecplot, or a grid of PLOT3D,
    which begins with whole numbers.
    """
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        lines = islice(filter(str.strip, file), MOST_ABOVE)
        rows = list(islice(filterfalse(COMMENT.match, lines), 2))
    if not rows or is_tecplot_text(path):
        return False
    if _written(rows[0]) is not None:
        return "." in rows[0]
    return _written(rows[-1]) is not None


def _begins_with_numbers(path: Path) -> bool:
    """Return whether the first line of a file, below comments, has numbers in place of names."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        first = next(filterfalse(COMMENT.match, filter(str.strip, file)), "")
    return _written(first) is not None


def _flags(header: str, columns: Iterable[str]) -> tuple[str, ...]:
    """Return the columns of flags, by the program that wrote them."""
    if header.startswith("PIVlab"):
        return ("Vector type",)
    if tuple(columns) == OPENPIV:
        return ("flags", "mask")
    if tuple(columns) == OLD_OPENPIV:
        return ("mask",)
    return ()


def _flag_attributes(bad: tuple[int, ...]) -> dict[str, Any]:
    """Return the attributes of CF that give the meanings of flags."""
    meanings = ["valid", "checked", "interpolated"]
    for value in bad:
        meanings[value] = "invalid"
    attributes: dict[str, Any] = {"standard_name": "status_flag", "flag_values": [0, 1, 2]}
    return attributes | {"flag_meanings": " ".join(meanings)}


def _layout(path: Path) -> Layout:
    """Find the first row of numbers."""
    above: list[str] = []
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for line in islice(file, MOST_ABOVE):
            found = _written(line)
            if found is not None:
                return Layout(tuple(above), *found)
            if line.strip():
                above.append(line.strip())
    if above:
        first = above[0][:60]
    else:
        first = ""
    raise FieldError(
        f"no line has {FEWEST} numbers or more, and the first one is {first!r}; expected columns "
        "of places and components, such as x, y, u and v"
    )


def _written(line: str) -> tuple[str | None, str, int] | None:
    """Return the separator, the decimal sign and the number of values of a row of numbers."""
    for separator in SEPARATORS:
        parts = _parts(line, separator)
        if len(parts) < FEWEST:
            continue
        for decimal in ".,":
            written = "\t".join(parts).replace(decimal, ".").split("\t")
            if all(map(NUMBER.fullmatch, written)):
                return separator, decimal, len(parts)
    return None


def _parts(line: str, separator: str | None) -> list[str]:
    parts = list(map(str.strip, line.strip().split(separator)))
    while parts and not parts[-1]:
        parts.pop()
    return parts


def _numbers(path: Path, layout: Layout) -> Any:
    """Return the table of the numbers, without names of columns."""
    pandas = import_extra("pandas", "xarray")
    check_memory(tables.TEXT_GROWTH * path.stat().st_size, "the file")
    rows = list(_rows(path, layout))
    return pandas.DataFrame(np.array(rows, dtype=float))


def _rows(path: Path, layout: Layout) -> Iterator[list[str]]:
    """Yield the values of each row, up to a section of other words."""
    begun = False
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            parts = _parts(line, layout.separator)
            if layout.decimal != ".":
                parts = "\t".join(parts).replace(layout.decimal, ".").split("\t")
            is_row = bool(parts) and all(map(NUMBER.fullmatch, parts))
            if begun and parts and not is_row and parts[0].startswith(("[", "%")):
                return  # such as the faces below the nodes of CFX
            if not parts or (not begun and not is_row):
                continue
            if not is_row or len(parts) != layout.columns:
                raise tables.cut_row(number, parts, f"{len(parts)} of {layout.columns} numbers")
            begun = True
            yield [part.translate(EXPONENTS) for part in parts]


def _by_order(frame: Any) -> tuple[Any, str]:
    """Name columns without a header, as OpenPIV and others order them, and tell the names."""
    count = frame.shape[1]
    last = frame.iloc[:, 4:]
    are_flags = bool(last.isin([0, 1, 2]).all(axis=None))
    names = ["x", "y", "u", "v"]
    if count == 6 and not are_flags:
        names = ["x", "y", "z", "u", "v", "w"]
    elif count > 4:
        names.append(FLAG if are_flags else "signal_to_noise")
    frame.columns = _filled(names, count)
    note = f"columns without a header are taken as {', '.join(names)}, without units"
    if FLAG in names:
        marked = frame[FLAG] == 1
        if 2 * marked.sum() > len(frame):  # most are good
            frame[FLAG] = (~marked).astype(int)
        note += f"; {frame[FLAG].sum():.0f} vectors with another flag than most are left out"
    return frame, note


def _davis_names(header: str, count: int) -> list[str]:
    """Return names with units by the header of DaVis, such as ``"position" "mm"`` and others."""
    places: list[str] = []
    others: list[str] = []
    for word, unit in DAVIS.findall(header):
        (places if word == "position" else others).append(unit)
    if len(places) < 2 or not others:
        raise FieldError(
            f"its first line is {header[:60]!r}; expected two positions and a velocity with units"
        )
    names = []
    letters = "xyz"[: len(places)] + "uvw"
    for letter, unit in zip(letters, [*places, *others * 3], strict=False):
        names.append(f"{letter} [{unit}]")
    return _filled(names, count)


def _filled(names: list[str], count: int) -> list[str]:
    """Return this many names, of which the last ones are numbered."""
    names = names[:count]
    while len(names) < count:
        names.append(f"column_{len(names) + 1}")
    return names


def _names(layout: Layout) -> list[str]:
    """Return the names in the last line above the numbers; places get the declared unit."""
    codar = next(filter(None, map(CODAR.match, layout.above)), None)
    if codar is not None:
        return [OF_CODAR.get(name, name) for name in codar[1].split()]
    line = layout.above[-1].lstrip("%# ")
    for names in (_parts(line, layout.separator), re.split(r"\s{2,}|\t", line), WORD.findall(line)):
        if len(names) == layout.columns:
            break
    else:
        count = len(_parts(line, layout.separator))
        raise FieldError(
            f"{line[:60]!r} above the numbers names {count} columns, but each row has "
            f"{layout.columns} numbers; expected a name for each column"
        )
    for other in layout.above:
        match = LENGTH_UNIT.match(other)
        if match is not None:
            names = [re.sub("^[xyz]$", rf"\g<0> [{match[1]}]", name) for name in names]
    return list(map(str.strip, names))


def _by_time(frame: Any) -> Any:
    """Return a table with a column of times, of one with columns for each time, as of COMSOL."""
    pandas = import_extra("pandas", "xarray")
    steps: dict[float, dict[str, str]] = {}
    places: list[str] = []
    for column in frame.columns:
        match = AT_TIME.match(column)
        if match is None:
            places.append(column)
        else:
            steps.setdefault(float(match[2]), {})[column] = match[1]
    if not steps:
        return frame
    parts = []
    for time, names in sorted(steps.items()):
        step = frame[[*places, *names]].rename(columns=names)
        parts.append(step.assign(time=time))
    return pandas.concat(parts, ignore_index=True)
