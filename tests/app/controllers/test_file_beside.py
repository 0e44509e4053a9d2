"""Two files side by side: opened aside, followed, told, and linked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

pytest.importorskip("trame_rca")

from small_pages import playing, small, small_page
from waiting import until

from flowtex import FlowField
from flowtex.app import FlowApp, Library
from flowtex.app.controllers.library import Choice
from flowtex.app.controllers.serialization import from_link, to_link
from flowtex.sources.open_source import MeshSource

pytestmark = pytest.mark.usefixtures("opengl")

FILE = "File: "


def other(*, steps: int = 1, **options: Any) -> FlowField:
    """A patch that is as large as that of ``small``, and turned: everything moves along y."""
    x, y = np.meshgrid(np.linspace(0, 3, 20), np.linspace(0, 2, 14))
    velocity = np.stack([0 * x, 3 + x, 0 * x], axis=-1)
    if steps > 1:
        velocity = velocity * (1 + np.arange(steps))[:, None, None, None]
        options.setdefault("times", np.arange(steps) / 2)
    return FlowField.from_arrays(np.stack([x, y, 0 * x], axis=-1), velocity, **options)


def page(*flows: Any, **named: Any) -> FlowApp:
    openers = {name: (lambda flow=flow: MeshSource(flow)) for name, flow in named.items()}
    return small_page(Library(openers) if openers else Library.of(*flows), 5, 240, 80)


async def beside(app: FlowApp, name: str) -> None:
    """Choose another file beside the first, and wait until it is there."""
    app.state.send(compare=FILE + name)
    await until(lambda: app.beside.name == name)


async def test_another_file_has_the_settings_and_a_range_of_its_own() -> None:
    app = page(one=small(), two=other())
    async with playing(app):
        assert app.state.get("comparisons")[-1] == "File: two"
        app.area.cmap, app.area.settings.contrast = "magma", 2.0
        await beside(app, "two")
        first, second = app.viewport.panes
        assert second.field.shape == (14, 20)
        assert second.settings.contrast == 2.0 and second.cmap == "magma"
        assert second.scene.scalar_limits == pytest.approx((3, 6))
        assert first.scene.scalar_limits[1] < 2
        assert app.area.names == ("one", "two")
        app.area.clim = (0.0, 4.0)
        assert second.scene.scalar_limits == first.scene.scalar_limits == (0, 4)
        app.area.settings.contrast, app.area.opacity = 1.0, 0.5
        assert second.settings.contrast == 1.0 and second.opacity == 0.5
        # The second one has no such array.
        app.area.scalars, app.area.clim = "height", None
        assert second.scalars == "speed" and second.clim is None
        app.state.send(compare="nothing")
        assert len(app.viewport.panes) == 1 and not app.area.names


async def test_the_time_is_that_of_the_first_or_the_last() -> None:
    app = page(one=small(steps=4), two=other(steps=4), three=other())
    async with playing(app):
        await beside(app, "two")
        second = app.viewport.panes[1]
        app.area.take_time(0.25)
        assert second.time == 0.25
        app.area.take_time(3.0)
        assert second.time == 1.5
        assert app.area.names == ("one", "two")
        await beside(app, "three")
        app.state.send(file="three")
        # The file beside is the first one now.
        await until(lambda: app.state.get("compare") == "nothing")
        assert len(app.viewport.panes) == 1 and not app.area.names


def block(turn: float, nodes: int) -> pv.StructuredGrid:
    x, y, z = np.meshgrid(
        np.linspace(-2, 2, 9), np.linspace(-1, 1, 8), np.linspace(0, 1, nodes), indexing="ij"
    )
    mesh = pv.StructuredGrid(x, y, z)
    px, py, pz = mesh.points.T
    mesh["wind"] = np.stack([1 - turn * py * pz, turn * px, 0 * px], axis=-1)
    return mesh


@pytest.mark.vtk_log_allowed("one of the files is broken")
async def test_a_slider_moves_the_plane_of_both(tmp_path: Path) -> None:
    for name, turn, nodes in (("a", 1.0, 6), ("b", 2.0, 6), ("c", 1.0, 3)):
        block(turn, nodes).save(tmp_path / f"{name}.vts")
    (tmp_path / "torn.vts").write_text("<VTKFile")
    app = page(tmp_path)

    def height() -> float:
        return float(app.viewport.panes[1].field.points[0, 0, 2])

    async with playing(app):
        shown = app.beside
        app.state.send(index=4)
        await until(lambda: app.data.choice.plane == "k=4")
        await beside(app, "b.vts")
        assert shown.name == "b.vts" and height() == pytest.approx(0.8)
        app.state.send(index=1)
        await until(lambda: app.data.choice.plane == "k=1")
        await until(lambda: height() == pytest.approx(0.2))
        app.state.send(index=5)
        await until(lambda: app.data.choice.plane == "k=5")
        await beside(app, "c.vts")
        # It has no such plane, and says which one it is.
        assert app.area.names == ("a.vts", "c.vts · k=1")
        assert height() == pytest.approx(0.5)
        app.state.send(compare="File: torn.vts")
        await until(lambda: app.state.get("problem"))
        assert app.state.get("problem").startswith("torn.vts: ")
        assert str(tmp_path) not in app.state.get("problem")
        assert len(app.viewport.panes) == 1 and not app.area.names
        assert app.state.get("compare") == "nothing"
        app.state.send(index=2)  # nothing is beside it that would follow
        await until(lambda: app.data.choice.plane == "k=2")
        await beside(app, "b.vts")
        assert height() == pytest.approx(0.4)
        before = app.viewport.panes[1]
        for junk in ("File: ", "File: a.vts", "File: ../secret.vts"):
            app.state.send(compare=junk)
            assert app.state.get("compare") == "File: b.vts"
        assert app.viewport.panes[1] is before


async def test_files_in_different_length_units_raise() -> None:
    kilometres = other(length_unit="km")
    metres = FlowField.from_arrays(kilometres.points, kilometres.velocity[0], length_unit="m")
    app = page(one=metres, two=kilometres)
    async with playing(app):
        app.state.send(compare="File: two")
        await until(lambda: app.state.get("problem"))
        assert app.state.get("problem").startswith("two is in km and one in m; expected the same")
        assert len(app.viewport.panes) == 1


async def test_a_link_and_the_lines_of_python_name_both() -> None:
    app = page(one=small(steps=4), two=other(steps=4), three=other())
    async with playing(app):
        app.area.player.go_to(3.0)
        await beside(app, "two")
        app.area.scalars = "height"
        sharing = app.sharing
        state = sharing.present_state()
        link = to_link(state)
        assert "split=File:%20two" in link
        sharing.show_state()
        lines = app.state.get("python")
        assert "    field,\n" in lines and "    field_beside,\n" in lines
        assert lines.count("    time=3.0,\n") == 1
        app.area.scalars = "speed"
        app.state.send(compare="nothing")
        app.restore(from_link(link))
        await until(lambda: app.beside.name == "two")
        app.restore(from_link(link.replace("File:%20two", "File:%20three")))
        await until(lambda: app.beside.name == "three")
        app.restore(from_link(link.replace("File:%20two", "File:%20../four")))
        assert app.beside.name == "three"


def test_a_choice_is_taken_as_far_as_a_file_has_it() -> None:
    parts = pv.MultiBlock({"large": block(1.0, 6), "small": block(1.0, 3)})
    library = Library({"blocks": lambda: MeshSource(parts), "one": lambda: MeshSource(small())})
    wanted = Choice("wind", "k=2", "small")
    for choice, found in (
        (wanted, wanted),
        (Choice("wind", "k=5", "small"), Choice("wind", "k=1", "small")),
        (Choice("swirl", "k=5"), Choice("wind", "k=5", "large")),
    ):
        assert library.complete("blocks", choice, nearest=True) == found
    assert library.complete("one", wanted, nearest=True) == library.complete("one", Choice())
