"""Files and planes that a page opens."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("trame_rca")

from cfd_files import box, write_ensight
from small_pages import played
from waiting import until

from flowtex import examples
from flowtex.app import FlowApp, Library
from flowtex.app.controllers.loading import without_folder

pytestmark = pytest.mark.usefixtures("opengl")


def test_a_complaint_does_not_tell_where_a_file_lies() -> None:
    said = "/srv/private/runs/torn.vts: the file is broken. VTK says: no"
    assert without_folder(said, "runs/torn.vts") == "torn.vts: the file is broken. VTK says: no"
    assert (
        without_folder("block is 'x'; there are a, b", "torn.vts") == "block is 'x'; there are a, b"
    )


def mean_speed(app: FlowApp) -> float:
    return float(np.linalg.norm(app.field.velocity[-1], axis=-1).mean())


def test_a_file_is_read_again_when_the_page_asks_for_it(tmp_path: Path) -> None:
    path = tmp_path / "latest.vts"
    examples.double_gyre(0.0).save(path)
    app = FlowApp(Library.of(path), samples=5)
    app.stream.update_size("test", {"w": 120, "h": 80, "p": 1})

    async def story() -> None:
        data, source = app.controllers.data, app.controllers.data._current.source
        assert app.state.get("is_file")
        data.reload()
        await until(lambda: data._opening is not None and data._opening.done())
        shown = app.field
        assert data._current.source is source, "what has not changed is not opened again"
        before, limits = mean_speed(app), app.area.scene.scalar_limits
        mesh = examples.double_gyre(2.5)
        mesh["velocity"] *= 3.0
        mesh.save(path)
        app.viewport.home(zoom=3.0)
        data.reload()
        await until(lambda: app.field is not shown)
        assert mean_speed(app) > 2 * before and app.viewport.zoom == pytest.approx(3.0)
        assert app.area.scalars is None or app.area.scene.scalar_limits != limits

    played(app, story)


def test_a_file_that_crashes_its_reader_is_a_problem_of_one_page(tmp_path: Path) -> None:
    examples.double_gyre(0.0).save(tmp_path / "flow.vts")
    write_ensight(tmp_path / "torn.case", [("tip", box(4, 3, 2)), ("body", box(6, 5, 4, 3.0))])
    geometry = tmp_path / "torn.geo"
    geometry.write_bytes(geometry.read_bytes()[:343])
    library = Library.of(tmp_path)
    app = FlowApp(library, samples=5)
    app.stream.update_size("test", {"w": 120, "h": 80, "p": 1})

    async def story() -> None:
        shown = app.field
        app.state.send(file="torn.case")
        await until(lambda: app.state.get("problem") != "")
        assert app.state.get("problem").startswith("torn.case: ")
        assert app.field is shown and app.state.get("file") == "flow.vts"
        assert library.source("flow.vts").alive

    played(app, story)
