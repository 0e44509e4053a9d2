"""Check of Wavefront OBJ: VTK trusts each number of a corner, texture coordinate and normal."""

from __future__ import annotations

import re

from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_files import Data

#: Keywords of the lists to which the parts of a corner such as ``5/3/1`` refer, in their order.
LISTS = (b"v", b"vt", b"vn")
#: A line of a face, a line or points, with its corners; a backslash continues it.
_CELL = re.compile(rb"^[ \t]*[flp][ \t]+((?:\\\r?\n|[^\r\n])*)", re.MULTILINE)


def check_obj(data: Data) -> None:
    """Raise a FieldError for a corner that refers to a point, or other entry, that does not exist.

    Negative numbers count from the end of the list.
    """
    counts = []
    for keyword in LISTS:
        entries = re.compile(rb"^[ \t]*" + keyword + rb"[ \t]", re.MULTILINE)
        counts.append(sum(1 for _ in entries.finditer(data)))
    for cell in _CELL.finditer(data):
        for corner in cell[1].replace(b"\\", b" ").split():
            if corner.startswith(b"#"):
                break
            _check_corner(corner, counts)


def _check_corner(corner: bytes, counts: list[int]) -> None:
    parts = corner.split(b"/")
    for part, count in zip(parts, counts, strict=False):
        if not part and part is not parts[0]:
            continue
        number = _number(part)
        if number is None or number == 0 or abs(number) > count or len(parts) > len(counts):
            text = corner[:40].decode(errors="replace")
            raise FieldError(
                f"the file is damaged: a cell has the corner {text!r}, but there are {counts[0]:,} "
                f"points, {counts[1]:,} texture coordinates and {counts[2]:,} normals; write or "
                "copy it again"
            )


def _number(word: bytes) -> int | None:
    try:
        return int(word)
    except ValueError:
        return None
