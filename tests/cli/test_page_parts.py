"""Parts of a file that the command ``show`` opens, from which its page can go to others."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

pytest.importorskip("trame_rca")

from earth_data import winds
from small_pages import small_page

from flowtex.app import FlowApp
from flowtex.cli import show as command
from flowtex.errors import FieldError

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]


@pytest.fixture
def box(tmp_path: Path) -> Path:
    mesh: Any = pv.ImageData(dimensions=(9, 8, 7), spacing=(0.2, 0.2, 0.2))
    x, y, z = np.asarray(mesh.points).T
    mesh["v"] = np.stack([1 + z, x, 0 * y], axis=-1)
    mesh.save(tmp_path / "box.vti")
    return tmp_path / "box.vti"


def shown(monkeypatch: pytest.MonkeyPatch, path: Path, **choice: Any) -> FlowApp:
    """Return the page that the command shows."""
    apps: list[FlowApp] = []

    def serve(library: Any, _page: Any, options: dict[str, Any]) -> int:
        apps.append(small_page(library, 3, **options))
        return 0

    monkeypatch.setattr(command, "serve_library", serve)
    monkeypatch.setattr(command, "serve_processes", lambda _page: False)
    command._show_page((path,), choice, None, {})
    return apps[0]


@pytest.mark.parametrize(
    ("cut", "axis", "height"), [("z=0.5", "z", 0.5), ("z", "z", 0.6), (" x = 1.3", "x", 1.3)]
)
def test_slice_across_an_axis_can_be_moved(
    monkeypatch: pytest.MonkeyPatch, box: Path, cut: str, axis: str, height: float
) -> None:
    app = shown(monkeypatch, box, slice=cut)
    assert app.state.get("axis") == axis
    assert app.state.get("planes") == 100
    across = app.field.surface.points[..., "xyz".index(axis)]
    assert across == pytest.approx(height)
    assert app.data._part.plane_number(app.data.choice.plane) == app.state.get("index")
    app.close()


def test_other_cuts_are_shown_as_they_are(monkeypatch: pytest.MonkeyPatch, box: Path) -> None:
    app = shown(monkeypatch, box, slice="1,1,0 through 0.8,0.7,0.6")
    points = app.field.surface.points
    assert points[..., :2].sum(axis=-1) == pytest.approx(1.5)
    assert app.state.get("axes") == []
    app.close()


def test_map_can_be_changed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    ds = winds(np.arange(-180.0, 180.0, 30.0), np.arange(-60.0, 61.0, 30.0))
    ds.to_netcdf(tmp_path / "winds.nc")
    for choice, block in (({"projection": "robinson"}, "robinson"), ({"globe": True}, "globe")):
        app = shown(monkeypatch, tmp_path / "winds.nc", **choice)
        assert app.state.get("block") == block
        assert "mercator" in app.state.get("blocks")
        app.close()


def test_slice_that_does_not_exist_raises(monkeypatch: pytest.MonkeyPatch, box: Path) -> None:
    with pytest.raises(FieldError, match="slice"):
        shown(monkeypatch, box, slice="w=0.5")
    with pytest.raises(FieldError, match="does not cut"):
        shown(monkeypatch, box, slice="z=9")
