"""Check of binary STL: VTK ignores the number of triangles and reads what the file has."""

from __future__ import annotations

from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_files import Data
from flowtex.sources.reader_errors import check_count

#: Bytes of any text, after which the number of triangles follows.
HEADER = 80
#: Bytes of the number of triangles.
COUNT = 4
#: Bytes of a triangle: its normal and corners, and an attribute.
TRIANGLE = 50
#: First word of a text.
TEXT = b"solid"
#: Bytes in which a text has no zero, which binary numbers have.
TEXT_BYTES = 256


def check_stl(data: Data) -> None:
    """Check the number of triangles of a binary file; text is not checked.

    Raises
    ------
    FieldError
        When the file has more or fewer triangles than its header declares.
    """
    beginning = data[:TEXT_BYTES]
    if beginning.lstrip().lower().startswith(TEXT) and b"\0" not in beginning:
        return
    start = HEADER + COUNT
    check_count(len(data), start, "the header")
    declared = int.from_bytes(data[HEADER:start], "little")
    check_count(len(data) - start, TRIANGLE * declared, f"the header of {declared:,} triangles")
    found = (len(data) - start) // TRIANGLE
    if found > declared:
        raise FieldError(
            f"the file is damaged: its header declares {declared:,} triangles, but it has "
            f"{found:,}; write or copy it again"
        )
