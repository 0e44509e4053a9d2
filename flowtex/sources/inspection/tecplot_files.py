"""Text files of Tecplot: how to tell them, and whether they have the numbers that zones declare.

VTK's reader trusts the header of a zone: where numbers are missing it continues with zeros, and
where their count is negative or huge it ends the process.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path

from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_files import Data, count_numbers
from flowtex.sources.reader_errors import check_count

#: Endings of text and of binary files.
SUFFIXES = (".dat", ".tec", ".tp", ".plt")
#: Words with which a text file begins, after comments.
BEGIN = re.compile(rb"\s*(?:#[^\n]*\n\s*)*(TITLE|VARIABLES|ZONE|FILETYPE|DATASETAUXDATA)\b", re.I)
HEAD_BYTES = 4096  #: Bytes that are read to tell text from others.
ZONE = re.compile(rb"^[ \t]*ZONE\b", re.I | re.M)
#: Beginnings of the lines of numbers, and of the records that end them.
NUMBERS = re.compile(rb"^[ \t]*[-+.\d]", re.M)
RECORD = re.compile(rb"^[ \t]*(?!nan\b|inf)[A-Z]", re.I | re.M)
VARIABLES = re.compile(rb"^[ \t]*VARIABLES\s*=\s*", re.I | re.M)
#: Names of variables, in quotes or between commas and blanks, up to the next record.
QUOTED = re.compile(r'"[^"]*"')
ALL_QUOTED = re.compile(r'(?:[\s,]*"[^"]*")+')
BARE = re.compile(r"[^\s,]+")
NEXT_RECORD = re.compile(r"^[^\n=]*=", re.M)
#: Numbers of nodes along the axes of a structured zone, and of nodes and cells of another.
COUNT = re.compile(r"\b(I|J|K|N|E|NODES|ELEMENTS)\s*=\s*(-?\d+)", re.I)
CELL_CENTERED = re.compile(r"\[([\d,\-\s]+)\]\s*=\s*CELLCENTERED", re.I)
TYPE = re.compile(r"\bZONETYPE\s*=\s*(\w+)|\bET\s*=\s*(\w+)|\bF\s*=\s*(\w+)", re.I)
#: What zones may have in common with others, which VTK does not read.
SHARED = re.compile(r"\b(VARSHARELIST|CONNECTIVITYSHAREZONE|PASSIVEVARLIST)\b", re.I)
#: Nodes of a cell by its type.
CORNERS = {
    "LINESEG": 2,
    "TRIANGLE": 3,
    "QUADRILATERAL": 4,
    "TETRAHEDRON": 4,
    "BRICK": 8,
}


def is_tecplot_text(path: Path) -> bool:
    """Return whether a file is text of Tecplot, by its ending and its first word."""
    if path.suffix.lower() not in SUFFIXES or not path.is_file():
        return False
    with path.open("rb") as file:
        return BEGIN.match(file.read(HEAD_BYTES)) is not None


def check_tecplot(data: Data) -> None:
    """Check that each zone of a text has as many numbers as it declares.

    Raises
    ------
    FieldError
        When a zone has fewer or more numbers, counts that no zone has, cells of a type that VTK
        does not read, or data that lie in another zone.
    """
    beginnings = [match.start() for match in ZONE.finditer(data)]
    if not beginnings:
        raise FieldError("the file has no zone; expected a line that begins with ZONE")
    names = _count_variables(bytes(data[: beginnings[0]]))
    ends = [*beginnings[1:], len(data)]
    for number, (begin, end) in enumerate(zip(beginnings, ends, strict=True), start=1):
        label = f"zone {number}"
        first = NUMBERS.search(data, begin, end)
        if first is None:
            raise FieldError(f"the file is damaged: {label} has no numbers; write or copy it again")
        header = QUOTED.sub("", bytes(data[begin : first.start()]).decode("latin-1"))
        declared = _declared(header, names, label)
        check_count((end - first.start() + 1) // 2, declared, label, "values")
        record = RECORD.search(data, first.start(), end)
        if record is not None:
            end = record.start()
        found, stop = count_numbers(data, None, first.start(), end)
        check_count(found, declared, label, "values")
        if found > declared or bytes(data[stop:end]).strip():
            raise FieldError(
                f"the file is damaged: {label} has more than the {declared:,} values that its "
                f"header and {names} variables declare; write or copy it again"
            )


def _count_variables(head: bytes) -> int:
    """Return the number of variables that the beginning of a file names."""
    match = VARIABLES.search(head)
    if match is None:
        raise FieldError("the file names no variables; expected a line that begins with VARIABLES")
    text = head[match.end() :].decode("latin-1")
    if quoted := ALL_QUOTED.match(text):
        return len(QUOTED.findall(quoted[0]))
    return len(BARE.findall(NEXT_RECORD.split(text)[0]))


def _declared(header: str, names: int, label: str) -> int:
    """Return how many numbers a zone has by its header, those of nodes, cells and corners."""
    if shared := SHARED.search(header):
        raise FieldError(
            f"{label} has data that lie in another zone ({shared[0].upper()}), which VTK does not "
            "read; write each zone with all of its data"
        )
    counts = {match[1].upper()[0]: int(match[2]) for match in COUNT.finditer(header)}
    for name, count in counts.items():
        if count < 1:
            raise FieldError(
                f"the file is damaged: {label} declares {name} = {count}; expected 1 or more"
            )
    at_cells = len(set(_cell_centered(header)))
    if "E" in counts:
        corners = _corners(header, label)
        nodes = counts.get("N", 0)
        cells = counts["E"]
        return (names - at_cells) * nodes + at_cells * cells + corners * cells
    shape = [counts.get(axis, 1) for axis in "IJK"]
    nodes = math.prod(shape)
    cells = math.prod(max(count - 1, 1) for count in shape)
    return (names - at_cells) * nodes + at_cells * cells


def _cell_centered(header: str) -> Iterator[int]:
    """Yield the numbers of the variables that have a value for each cell."""
    for match in CELL_CENTERED.finditer(header):
        for part in match[1].split(","):
            first, _, last = part.partition("-")
            yield from range(int(first), int(last or first) + 1)


def _corners(header: str, label: str) -> int:
    """Return the number of nodes of each cell."""
    types = []
    for match in TYPE.finditer(header):
        name = match[1] or match[2] or match[3]
        types.append(name.upper().removeprefix("FE"))
    for name in types:
        if name in CORNERS:
            return CORNERS[name]
    raise FieldError(
        f"{label} has cells of the type {' '.join(types)}, which VTK does not read; expected "
        f"{', '.join(CORNERS)}"
    )
