"""Pages of large triangle surfaces, whose tiles are traced here."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from triangle_meshes import sphere

from flowtex import FlowField
from flowtex.host.view import TileSource, WebView
from flowtex.scene.scene import Scene
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.textures.tiles.triangle_pyramid import TrianglePyramid

EXPORTED = """
import sys
import numpy as np
import pyvista
import flowtex

mesh = pyvista.Plane(i_resolution=4, j_resolution=4).triangulate()
mesh["velocity"] = np.ones((mesh.n_points, 3)) * (1, 0.5, 0)
flowtex.export(mesh, sys.argv[1])
assert "pyvista.plotting" not in sys.modules
"""


def test_a_page_is_written_without_the_plotters_of_pyvista(tmp_path: Any) -> None:
    path = str(tmp_path / "flow.html")
    subprocess.run([sys.executable, "-c", EXPORTED, path], check=True)


def test_tiles_of_a_page_are_traced_in_one_window_where_theirs_overlap(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 500)
    points, triangles = sphere(3)
    velocity = np.cross((0.2, 0.1, 1.0), points)
    field = FlowField.from_triangles(points, triangles, velocity)
    scene = WebView(Scene(field)).data()
    assert isinstance(scene.pyramid, TrianglePyramid)
    alone = [dict(TileSource(scene).parts(key, [0])) for key in scene.pyramid.children(None)]
    traced: list[list[TileKey]] = []
    region = TrianglePyramid.region

    def recorded(self: Any, keys: Sequence[TileKey], widening: int = 1) -> Any:
        traced.append(list(keys))
        return region(self, keys, widening)

    monkeypatch.setattr(TrianglePyramid, "region", recorded)
    together = list(TileSource(scene).tiles())
    assert [len(keys) for keys in traced if keys[0].level == scene.pyramid.depth - 1] == [4]
    for one, other in zip(alone, together, strict=False):
        assert one.keys() == other.keys()
        for name, part in one.items():
            assert part.dtype == other[name].dtype
            if name.endswith(("position", "normal", "faces")):
                assert np.array_equal(part, other[name])
