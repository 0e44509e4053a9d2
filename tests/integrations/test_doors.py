"""Results of other libraries, drawn as the docs say: `make integrations`.

Each section of the page ``docs/howto/doors.md`` runs, and its flow is compared with what is known
of it without flowtex.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flowtex

PAGE = Path(__file__).resolve().parents[2] / "docs" / "howto" / "doors.md"
EXAMPLE = re.compile(r"^## (.+?)$.*?^```py$\n(.*?)^```$", re.DOTALL | re.MULTILINE)

pytestmark = [
    # Those of other packages, which nobody here can mend.
    pytest.mark.filterwarnings("default::DeprecationWarning"),
    pytest.mark.filterwarnings("default::PendingDeprecationWarning"),
    pytest.mark.filterwarnings("default::FutureWarning"),
    # Eigenvectors of NumPy 2.5 are always complex, and python-control 0.10.2 makes them real.
    pytest.mark.filterwarnings("default:Casting complex values:numpy.exceptions.ComplexWarning"),
]


def angles(u: Any, v: Any, x: Any, y: Any) -> Any:
    """Angles between vectors (u, v) and (x, y), in degrees."""
    return np.degrees(np.abs(np.angle((u + 1j * v) * (x - 1j * y))))


def optical_flow(page: dict[str, Any]) -> None:
    field = page["field"]
    x, y = np.moveaxis(field.points[..., :2] - (230, 120), -1, 0)
    ring = (np.hypot(x, y) > 20) & (np.hypot(x, y) < 50)
    u, v = np.moveaxis(np.asarray(field.velocity[0])[..., :2], -1, 0)
    # A swirl turns anticlockwise on the screen, where y is downward.
    assert np.median(angles(u, v, y, -x)[ring]) < 5


def particle_images(page: dict[str, Any]) -> None:
    first, second = (page[name].astype(float) for name in ("first", "second"))
    inner = slice(30, -30)

    def likeness(rows: int) -> float:
        moved = np.roll(second, -rows, axis=0)[inner, inner]
        return float(np.corrcoef(first[inner, inner].ravel(), moved.ravel())[0, 1])

    down = max(range(-12, 13), key=likeness) / 0.02
    field = page["field"]
    velocity = np.asarray(field.velocity[0])[field.surface.valid]
    assert np.median(velocity[:, 1]) == pytest.approx(-down, rel=0.15)
    assert field.points[..., 1].max() == pytest.approx(page["y"].max())


def phase_plane(page: dict[str, Any]) -> None:
    field, system = page["field"], page["system"]
    for j, i in ((7, 33), (30, 100), (55, 2)):
        rate = system.dynamics(0.0, field.points[j, i, :2], [])
        assert field.velocity[0][j, i, :2] == pytest.approx(rate)


def mesh_of_xugrid(page: dict[str, Any]) -> None:
    field = page["image"].flow
    assert field.size_text == f"{page['mesh'].n_node} nodes, {page['mesh'].n_face} triangles"
    x, y = field.points.reshape(-1, 3)[:, :2].T - 5
    u, v = np.asarray(field.velocity[0]).reshape(-1, 3)[:, :2].T
    inside = (np.hypot(x, y) > 1) & (np.hypot(x, y) < 4)
    assert angles(u, v, -y, x - 0.3 * y)[inside].max() < 10


def grid_of_uxarray(page: dict[str, Any]) -> None:
    field = flowtex.FlowField.from_xarray(page["merged"], globe=True)
    assert field.projection is not None
    points, velocity = (np.reshape(each, (-1, 3)) for each in (field.points, field.velocity[0]))
    lon, lat = field.projection.lonlat(points)
    a, b = np.radians(lon), np.radians(lat)
    east, north = field.projection.components(lon, lat, velocity)
    assert east == pytest.approx((30 + 10 * np.sin(4 * a)) * np.cos(b), abs=0.01)
    assert north == pytest.approx(20 * np.cos(4 * a) * np.cos(b), abs=0.01)


def slice_of_yt(page: dict[str, Any]) -> None:
    field = page["field"]
    x, y = np.moveaxis(field.points[..., :2], -1, 0)
    swirl = np.exp(-4 * (x**2 + y**2))
    known = np.stack([0.1 - y * swirl, x * swirl, 0 * x], axis=-1)
    # The buffer has the values of cells, of which there are 48 along a side.
    assert np.abs(field.velocity[0] - known).max() < 0.03


def particles_of_parcels(page: dict[str, Any]) -> None:
    (x, y), (later_x, later_y) = page["path"][:2]
    now = page["ocean"].isel(time=0)
    places = {"longitude": ("n", (x + later_x) / 2), "latitude": ("n", (y + later_y) / 2)}
    u, v = (now[name].interp(places).values for name in ("uo", "vo"))
    fast = np.hypot(u, v) > 0.3
    assert fast.sum() > 5
    along = (later_x - x) * np.cos(np.radians(y))
    assert angles(along, later_y - y, u, v)[fast].max() < 5


def velocities_of_cells(page: dict[str, Any]) -> None:
    field = page["field"]
    x, y = np.moveaxis(field.points[..., :2], -1, 0)
    u, v = np.moveaxis(np.asarray(field.velocity[0])[..., :2], -1, 0)
    valid = field.surface.valid
    assert 0.3 < valid.mean() < 0.9
    assert np.median(angles(u, v, -y, x)[valid]) < 10


#: What is known of each example, by the package that it needs, in the order of the page.
KNOWN: dict[str, Callable[[dict[str, Any]], None]] = {
    "skimage": optical_flow,
    "openpiv": particle_images,
    "control": phase_plane,
    "xugrid": mesh_of_xugrid,
    "uxarray": grid_of_uxarray,
    "yt": slice_of_yt,
    "parcels": particles_of_parcels,
    "anndata": velocities_of_cells,
}


def test_each_example_of_the_page_is_known() -> None:
    blocks = [block for _, block in EXAMPLE.findall(PAGE.read_text())]
    assert len(blocks) == len(KNOWN)
    for package, block in zip(KNOWN, blocks, strict=True):
        assert re.search(rf"^(import|from) {package}\b", block, re.MULTILINE), package
        assert len(block.splitlines()) <= 26


@pytest.mark.parametrize("package", KNOWN)
def test_an_example_draws_what_a_library_computed(
    package: str, opengl: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if find_spec(package) is None:
        pytest.skip(f"{package} is not installed: make integrations")
    if package in ("xugrid", "uxarray", "parcels"):
        pytest.importorskip("pyproj", reason="make integrations")
    import matplotlib.pyplot as plt

    plt.switch_backend("agg")
    monkeypatch.chdir(tmp_path)
    _, block = EXAMPLE.findall(PAGE.read_text())[list(KNOWN).index(package)]
    page: dict[str, Any] = {}
    try:
        exec(compile(block, f"{PAGE.name}, {package}", "exec"), page)
        page["figure"].canvas.draw()
        shot = np.asarray(page["figure"].canvas.buffer_rgba())[..., :3]
        KNOWN[package](page)
    finally:
        plt.close("all")
    assert len(np.unique(shot.reshape(-1, 3), axis=0)) > 500, "there is a texture in the figure"
