"""What stands beside the flow of a plotter: read from VTK's actors, drawn by a browser alike."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import pyvista as pv
from flows import gyre
from page_reader import Reader
from webgl_page import packed

import flowtex
from flowtex.host.view import browser_options, web_views
from flowtex.plotting import component as reading
from flowtex.rendering.webgl.bodies import Body

if TYPE_CHECKING:
    from webgl_page import ClientPage

#: A flow of one colour without grains, so that pictures can be compared.
FLAT: dict[str, Any] = {"scalars": False, "color": "white", "lighting": False, "strength": 0.0}
SIZE = (180, 120)
PHOTO = np.zeros((2, 2, 3), np.uint8)


def on_plotter(plotter: Any, **options: Any) -> Any:
    plotter.window_size = SIZE
    return plotter.flowtex.add(gyre(), **{**FLAT, **options})


def read(plotter: Any) -> list[Body]:
    """The meshes beside the flow, of which none is left out."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return list(plotter.flowtex.for_browser()[2].meshes)


def kinds(bodies: list[Body]) -> list[tuple[int, int]]:
    """Triangles and pieces of lines of all that have some."""
    counts = [(len(body.faces), len(body.pieces)) for body in bodies]
    return [count for count in counts if any(count)]


def test_faces_edges_lines_and_points(plotter: Any) -> None:
    on_plotter(plotter)
    plotter.add_mesh(pv.Cube(), show_edges=True)
    assert kinds(read(plotter)) == [(12, 0), (0, 12)]
    plotter.add_mesh(pv.Spline(np.eye(3), 5), line_width=3)
    plotter.add_points(np.eye(3), point_size=7)
    line, points = read(plotter)[-2:]
    assert kinds([line, points]) == [(0, 4), (0, 3)]
    assert (line.width, points.width) == (3, 7)
    np.testing.assert_array_equal(points.pieces[:, 0], points.pieces[:, 1])


def test_a_wireframe_has_the_edges_of_cells_and_no_faces(plotter: Any) -> None:
    on_plotter(plotter)
    plotter.add_mesh(pv.ImageData(dimensions=(2, 2, 2)), style="wireframe")
    assert kinds(read(plotter)) == [(0, 12)]


def test_colours_are_those_of_the_mapper(plotter: Any) -> None:
    on_plotter(plotter)
    line = pv.Line(resolution=1)
    line["n"] = [0.0, 1.0]
    plotter.add_mesh(line, scalars="n", cmap="gray", clim=(0, 1), show_scalar_bar=False)
    [body] = (b for b in read(plotter) if len(b.points))
    assert body.colours.tolist() == [[0, 0, 0, 255], [255, 255, 255, 255]]


def test_cells_have_vertices_of_their_own(plotter: Any) -> None:
    on_plotter(plotter)
    cube = pv.Cube()
    cube.cell_data["n"] = np.arange(6)
    plotter.add_mesh(cube, cmap="gray", show_scalar_bar=False)
    [body] = (b for b in read(plotter) if len(b.points))
    assert len(body.points) == 36
    greys = body.colours[body.faces][..., 0]
    assert (greys == greys[:, :1]).all()
    assert sorted(set(greys[:, 0].tolist())) == [0, 51, 102, 153, 204, 255]


def test_an_actor_is_where_it_was_put(plotter: Any) -> None:
    on_plotter(plotter)
    actor = plotter.add_mesh(pv.Cube(), smooth_shading=True, opacity=0.5)
    actor.position, actor.scale = (10, 0, 0), (1, 4, 1)
    [body] = (b for b in read(plotter) if len(b.points))
    np.testing.assert_allclose(body.points.mean(axis=0), (10, 0, 0), atol=1e-6)
    np.testing.assert_allclose(np.ptp(body.points, axis=0), (1, 4, 1), atol=1e-6)
    assert set(body.colours[:, 3].tolist()) == {128}
    assert body.normals is not None
    np.testing.assert_allclose(np.linalg.norm(body.normals, axis=1), 1, atol=1e-6)


def test_labels_tell_their_texts_and_places(plotter: Any) -> None:
    on_plotter(plotter)
    plotter.add_point_labels([[0.0, 0, 1], [1, 0, 0]], ["nose", "tail"], font_size=20)
    _, _, bodies = plotter.flowtex.for_browser()
    assert [label.text for label in bodies.labels] == ["nose", "tail"]
    assert bodies.labels[1].position == (1, 0, 0)
    assert bodies.labels[1].size == 20


def test_what_is_left_out_is_told_with_the_reason(
    plotter: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    on_plotter(plotter)
    monkeypatch.setattr(reading, "MOST_VERTICES", 100)
    plotter.add_mesh(pv.Cube(), name="box")
    plotter.add_mesh(pv.Sphere(), name="ball")
    plotter.add_volume(pv.ImageData(dimensions=(3, 3, 3)), scalars=np.arange(27.0), name="fog")
    plotter.add_mesh(pv.Plane(), texture=PHOTO, name="photo")
    hidden = plotter.add_mesh(pv.Cone(), name="cone")
    hidden.visibility = False
    told = r"'ball' \(842 vertices exceed .*'fog' \(vtk.*'photo' \(coloured by a texture\)"
    with pytest.warns(UserWarning, match=told) as heard:
        _, _, bodies = plotter.flowtex.for_browser()
    assert "cone" not in str(heard[0].message)
    assert "'box'" not in str(heard[0].message)
    assert kinds(list(bodies.meshes)) == [(12, 0)]


def test_a_page_of_a_plotter_has_what_stands_there(plotter: Any, tmp_path: Path) -> None:
    on_plotter(plotter, samples=9)
    plotter.add_mesh(pv.Sphere(), color="red")
    page = flowtex.export(plotter, tmp_path / "page.html", samples=5)
    text = page.path.read_text("utf-8")
    header = Reader(text).header()
    assert header["settings"]["samples"] == 5  # what is given comes before what the plotter has
    assert header["camera"]["parallel"]
    assert [run["faces"] for run in header["bodies"]["runs"] if run["faces"][1]] == [[0, 1680]]
    assert "bodyPoints" in text


#: A mesh beside the flow, its look, and that of the flow.
MESHES: dict[str, tuple[Any, dict[str, Any], dict[str, Any]]] = {
    "through it": (pv.Sphere(radius=0.4, center=(1, 0.5, 0.1)), {}, {}),
    "smooth": (pv.Sphere(radius=0.4, center=(1, 0.5, 0)), {"smooth_shading": True}, {}),
    # One layer: VTK blends several by weights.
    "clear": (pv.Plane(center=(1, 0.5, 0.1), direction=(1, 1, 1)), {"opacity": 0.5}, {}),
    "lines": (pv.Cube(center=(1, 0.5, 0.2)).extract_all_edges(), {"line_width": 5}, {}),
    "far away": (pv.Cube(center=(1, 0.5, -3), x_length=9, y_length=9), {}, {}),
    "behind a clear flow": (pv.Cube(center=(1, 0.5, -0.3)), {}, {"opacity": 0.6}),
}


@pytest.mark.parametrize(
    ("kind", "parallel"), [*((kind, True) for kind in MESHES), ("through it", False)]
)
def test_a_browser_draws_them_as_vtk_does(
    plotter: Any, client: ClientPage, kind: str, parallel: bool
) -> None:
    mesh, look, flow = MESHES[kind]
    on_plotter(plotter, **flow)
    plotter.add_mesh(mesh, color="dodgerblue", **look)
    plotter.set_background("red")
    plotter.camera_position = [(2.9, -2.4, 2.6), (1.0, 0.5, 0.0), (0, 0, 1)]
    plotter.camera.parallel_projection = parallel
    plotter.camera.parallel_scale = 1.2
    plotter.renderer.ResetCameraClippingRange()
    theirs = plotter.screenshot(return_img=True)
    field, options = browser_options(plotter)
    [view] = web_views(field, options)
    data = view.data()
    camera = options.view.first_camera(field.surface).to_dict()
    header = data.header(view.scene.settings, camera=camera)
    ours = client.picture(
        client.mount(packed(data, header), SIZE, controls=False, smooth=False, bare=True)
    )
    view.close()
    off = np.abs(theirs.astype(int) - ours).max(axis=-1)
    # Outlines may differ by a pixel.
    steps = [np.abs(np.diff(theirs.astype(int), axis=axis)).max(axis=-1) for axis in (0, 1)]
    edges = sum(int((step > 30).sum()) for step in steps)
    assert (off > 12).sum() < 0.25 * edges
    assert (theirs[..., 2] > theirs[..., 0] + 20).mean() > 0.02


def test_a_mesh_hides_the_flow_from_the_pointer(plotter: Any, client: ClientPage) -> None:
    on_plotter(plotter)
    plotter.add_mesh(pv.Sphere(radius=0.2, center=(1.0, 0.5, 0.5)))
    plotter.view_xy()
    field, options = browser_options(plotter)
    [view] = web_views(field, options)
    data = view.data()
    header = data.header(view.scene.settings)
    client.sharp(client.mount(packed(data, header), SIZE, controls=False))
    view.close()
    client.page.wait_for_function("() => viewers[0].canPick")
    points = client.page.evaluate("() => [viewers[0].point(0, 0), viewers[0].point(0.5, 0)]")
    assert points[0] is None
    assert points[1]["position"][1] == pytest.approx(0.5, abs=0.05)
