"""Files and planes that a page opens."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")


from flowtex.app.controllers.loading import without_folder

pytestmark = pytest.mark.usefixtures("opengl")


def test_a_complaint_does_not_tell_where_a_file_lies() -> None:
    said = "/srv/private/runs/torn.vts: the file is broken. VTK says: no"
    assert without_folder(said, "runs/torn.vts") == "torn.vts: the file is broken. VTK says: no"
    assert (
        without_folder("block is 'x'; there are a, b", "torn.vts") == "block is 'x'; there are a, b"
    )
