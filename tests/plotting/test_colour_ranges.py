"""Colour ranges: those of all data behind a view, shared by what has one scalar and one map."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import KDTree

import flowtex
from flowtex.scene.scene import Scene

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
#: Colours that are the scalar's alone.
PLAIN: dict[str, Any] = {"strength": 0.0, "lighting": False, "samples": 1}
SIZE = [320, 240]


def volume(**kind: Any) -> Any:
    """A box whose scalar p grows away from its middle."""
    grid: Any = pv.ImageData(dimensions=(21, 17, 11), spacing=(0.2,) * 3, origin=(-2, -1.6, -1))
    if kind:
        grid = grid.cast_to_structured_grid()
    x, y, z = np.asarray(grid.points).T
    grid["U"] = np.stack([1 - y / 2, x / 2 + 0.3 * np.sin(3 * z), 2 + 0.3 * np.cos(2 * x)], -1)
    grid["p"] = x * x + y * y + z * z
    return grid


@pytest.fixture
def window() -> Iterator[Any]:
    made: Any = pv.Plotter(off_screen=True, window_size=SIZE)
    made.disable_anti_aliasing()
    made.enable_parallel_projection()
    with closing(made):
        yield made


def shot(plotter: Any) -> Any:
    plotter.render()
    return np.asarray(plotter.screenshot(return_img=True), dtype=float)


def read_back(image: Any, table: Any, limits: tuple[float, float]) -> Any:
    """The values that a reader takes from colours with a bar."""
    nearest = KDTree(np.asarray(table, float)[:, :3]).query(image[..., :3], p=1)[1]
    share = (nearest + 0.5) / len(table)
    return limits[0] + share * (limits[1] - limits[0])


def true_p(plotter: Any, z: float) -> tuple[Any, Any]:
    """The values of p on a plane across z at the pixels of a plotter, and where they are inside."""
    camera, (width, height) = plotter.camera, SIZE
    pixel = 2 * camera.parallel_scale / height
    x = camera.focal_point[0] + (np.arange(width) - (width - 1) / 2) * pixel
    y = camera.focal_point[1] - (np.arange(height) - (height - 1) / 2)[:, None] * pixel
    inside = (np.abs(x) < 1.9) & (np.abs(y) < 1.5) & (x > -1.2)  # right of the bar
    return x * x + y * y + z * z, inside


CUTS = [{"slice": f"z={z}"} for z in (-0.79, 0.11)] + [{"plane": "k=1"}, {"plane": "k=5"}]


@pytest.mark.parametrize("structured", [{}, {"structured": True}], ids=str)
@pytest.mark.parametrize("cut", CUTS, ids=str)
def test_slice_has_range_of_volume(cut: dict[str, str], structured: dict[str, bool]) -> None:
    mesh = volume(**structured)
    scene = Scene.of(mesh, scalars="p", **cut)
    assert scene.scalar_limits == pytest.approx(mesh.get_data_range("p"))
    u = np.asarray(mesh["U"])
    across = np.hypot(u[:, 0], u[:, 1])
    assert scene.scalar_range("speed") == pytest.approx((across.min(), across.max()))
    robust = scene.scalar_range("p", robust=True)
    assert robust == pytest.approx(tuple(np.percentile(mesh["p"], (2, 98))))
    values = scene.field.volume_values
    lengths = np.linalg.norm(u, axis=1)
    assert (values["U"].min(), values["U"].max()) == pytest.approx((lengths.min(), lengths.max()))
    assert (values["U_z"].min(), values["U_z"].max()) == (u[:, 2].min(), u[:, 2].max())


def test_tilted_slice_has_range_of_speeds_in_its_planes() -> None:
    mesh = volume()
    scene = Scene.of(mesh, slice="1,1,0 through 0.2,0,0")
    u, normal = np.asarray(mesh["U"]), np.array([1, 1, 0]) / np.sqrt(2)
    speeds = np.linalg.norm(u - (u @ normal)[:, None] * normal, axis=1)
    assert scene.scalar_limits == pytest.approx((speeds.min(), speeds.max()))


def test_hidden_and_missing_values_have_no_part_in_the_range() -> None:
    mesh = volume()
    corner = np.argmax(mesh["p"])
    mesh["U"][corner] = np.nan
    hidden = np.zeros(mesh.n_points, np.uint8)
    hidden[np.argsort(mesh["p"])[-8:]] = 2
    mesh.point_data["vtkGhostType"] = hidden
    mesh["p"][hidden > 0] = 1e5
    mesh["p"][0], rest = np.inf, hidden == 0
    rest[0] = False
    high = Scene.of(mesh, slice="z=0.1", scalars="p").scalar_limits[1]
    assert high == pytest.approx(mesh["p"][rest].max())


def test_large_volume_has_exact_extremes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.sources.meshes.volume.MOST_VALUES", 2000)
    mesh = volume()
    scene = Scene.of(mesh, slice="z=0.1", scalars="p")
    assert scene.scalar_range("p") == pytest.approx(mesh.get_data_range("p"))
    exact = np.percentile(mesh["p"], (2, 98))
    robust = scene.scalar_range("p", robust=True)
    assert robust == pytest.approx(tuple(exact), abs=0.02 * np.ptp(exact))


def test_moving_slice_keeps_its_colours(window: Any) -> None:
    mesh = volume()
    handle = window.flowtex.add(mesh, slice="z=0", scalars="p", **PLAIN)
    for z in (0.0, 0.5, 0.9):
        handle.set_surface(mesh, slice=f"z={z}")
        image, (true, inside) = shot(window), true_p(window, z)
        bar = window.scalar_bars["p"].GetLookupTable()
        assert bar.GetRange() == pytest.approx(mesh.get_data_range("p"))
        values = read_back(image, bar.values, bar.GetRange())
        assert np.abs(values - true)[inside].max() < 0.02 * np.ptp(bar.GetRange())


def pair() -> tuple[Any, Any]:
    """Two slices of the box, whose ranges of p overlap."""
    return volume().slice("z", origin=(0, 0, -0.9)), volume().slice("z", origin=(0, 0, 0.1))


@pytest.mark.parametrize("kinds", ["ff", "fm", "mf", "mff"])
def test_flows_and_meshes_share_a_range_as_pyvista_meshes_do(window: Any, kinds: str) -> None:
    meshes = (*pair(), volume().slice("x"))[: len(kinds)]
    plain: Any = pv.Plotter(off_screen=True)
    actors, expected = [], [plain.add_mesh(mesh, scalars="p") for mesh in meshes]
    for kind, mesh in zip(kinds, meshes, strict=True):
        add = window.flowtex.add if kind == "f" else window.add_mesh
        actors.append(add(mesh.copy(), scalars="p", **(PLAIN if kind == "f" else {})))
    shot(window)
    assert list(window.scalar_bars.keys()) == ["p"]
    assert window.scalar_bars["p"].GetLookupTable().GetRange() == expected[0].mapper.scalar_range
    for actor, one in zip(actors, expected, strict=True):
        mapper = getattr(actor, "actor", actor).mapper
        assert mapper.scalar_range == one.mapper.scalar_range
    plain.close()


def test_another_colour_map_has_its_own_bar_and_range(window: Any) -> None:
    first, second = (window.flowtex.add(mesh, scalars="p", cmap="magma") for mesh in pair())
    own = [mesh.get_data_range("p") for mesh in pair()]
    common = first.actor.mapper.scalar_range
    assert common == (min(own)[0], max(own[0][1], own[1][1]))
    second.cmap = "viridis"
    shot(window)
    bars = window.scalar_bars
    assert [bar.GetTitle() for bar in bars.values()] == ["p", "p"]
    ranges = [bar.GetLookupTable().GetRange() for bar in bars.values()]
    assert ranges == own
    assert second.actor.mapper.scalar_range == own[1]
    second.cmap = "magma"
    assert second.actor.mapper.scalar_range == common and len(bars) == 1


def test_limits_of_one_flow_are_those_of_its_bar(window: Any) -> None:
    first, second = (window.flowtex.add(mesh, scalars="p") for mesh in pair())
    common = first.actor.mapper.scalar_range
    for clim, expected in ((2.0, (-2, 2)), ([1, 3], (1, 3)), (np.array([0, 2]), (0, 2))):
        second.clim = clim
        shot(window)
        assert second.clim == expected
        assert first.actor.mapper.scalar_range == second.actor.mapper.scalar_range == expected
        assert window.scalar_bars["p"].GetLookupTable().GetRange() == expected
    second.clim = None
    assert first.actor.mapper.scalar_range == common
    window.update_scalar_bar_range((0, 4), "p")
    shot(window)
    assert window.scalar_bars["p"].GetLookupTable().GetRange() == (0, 4)


def test_a_flow_that_leaves_its_bar_leaves_it_to_the_others(window: Any) -> None:
    first, second = (window.flowtex.add(mesh, scalars="p") for mesh in pair())
    first.scalars = "speed"
    assert list(window.scalar_bars.keys()) == ["p", "speed in the surface"]
    first.remove()
    shot(window)
    assert list(window.scalar_bars.keys()) == ["p"]
    own = pair()[1].get_data_range("p")
    assert window.scalar_bars["p"].GetLookupTable().GetRange() == own
    assert second.actor.mapper.scalar_range == own
    second.show_scalar_bar = False
    assert not window.scalar_bars


HEIGHTS = {"a": 0.1, "b": 0.9, "c": 0.5}


def cut_at(letter: str) -> Any:
    """A slice of the box with a range of p of its own."""
    return volume().slice("z", origin=(0, 0, HEIGHTS[letter.lower()]))


def show_in_turn(window: Any, changes: str, chosen: dict[str, Any]) -> dict[str, Any]:
    """Add flows (capital letters) and meshes, remove those that are shown; return the ranges."""
    shown: dict[str, Any] = {}
    for letter in changes:
        if letter in shown:
            window.remove_actor(shown.pop(letter))
        elif letter.isupper():
            handle = window.flowtex.add(cut_at(letter), scalars="p", clim=chosen.get(letter))
            shown[letter] = handle.actor
        else:
            shown[letter] = window.add_mesh(cut_at(letter), scalars="p")
        shot(window)
    return {letter: actor.mapper.scalar_range for letter, actor in shown.items()}


@pytest.mark.parametrize("changes", ["BA", "ACAB", "Abc", "bAc", "ABc", "AbB", "AbAC", "bACA"])
def test_range_of_a_bar_does_not_depend_on_the_order(window: Any, changes: str) -> None:
    """Those that were removed have no part in it."""
    ranges = show_in_turn(window, changes, {})
    lows, highs = zip(*(cut_at(letter).get_data_range("p") for letter in ranges), strict=True)
    assert list(ranges.values()) == [(min(lows), max(highs))] * len(ranges)


@pytest.mark.parametrize("changes", ["AB", "BA", "ACBC", "BcA", "CBAC"])
def test_chosen_limits_are_those_of_a_bar_in_any_order(window: Any, changes: str) -> None:
    ranges = show_in_turn(window, changes, {"B": (0.5, 2.0)})
    assert list(ranges.values()) == [(0.5, 2.0)] * len(ranges)


def test_range_that_is_set_by_pyvista_stays(window: Any) -> None:
    handles = [window.flowtex.add(mesh, scalars="p") for mesh in pair()]
    window.update_scalar_bar_range((0, 4), "p")
    shot(window)
    assert [handle.actor.mapper.scalar_range for handle in handles] == [(0, 4)] * 2


def test_another_surface_has_its_own_range(window: Any) -> None:
    meshes = [cut_at(letter) for letter in "ab"]
    handle = window.flowtex.add(meshes[0], scalars="p")
    handle.set_surface(meshes[1])
    shot(window)
    assert handle.actor.mapper.scalar_range == meshes[1].get_data_range("p")
    handle.clim = (0.5, 2.0)
    handle.set_surface(meshes[0])
    assert handle.actor.mapper.scalar_range == (0.5, 2.0)


def test_a_flow_joins_a_bar_of_the_same_colours_at_any_place(window: Any) -> None:
    first, second = (window.flowtex.add(mesh, scalars="p", cmap="magma") for mesh in pair())
    second.cmap = "viridis"
    first.cmap = "viridis"
    shot(window)
    assert len(window.scalar_bars) == 1
    assert first.actor.mapper.scalar_range == second.actor.mapper.scalar_range


def test_an_image_has_no_bar_by_default(window: Any) -> None:
    handle = window.flowtex.add(volume(), plane="k=5", scalars="p")
    handle.set_image(np.eye(8))
    assert not window.scalar_bars
    handle.settings.noise = "procedural"
    assert list(window.scalar_bars.keys()) == ["p"]
    handle.show_scalar_bar = True
    handle.settings.noise = "image"
    assert list(window.scalar_bars.keys()) == ["p"]


def test_subplots_have_their_own_bars_and_ranges() -> None:
    made: Any = pv.Plotter(off_screen=True, window_size=SIZE, shape=(1, 2))
    with closing(made):
        for column, mesh in enumerate(pair()):
            made.subplot(0, column)
            handle = made.flowtex.add(mesh, scalars="p")
            assert handle.actor.mapper.scalar_range == mesh.get_data_range("p")
        shot(made)
        for n, bar in enumerate(made.scalar_bars.values()):
            assert [bool(r.HasViewProp(bar)) for r in made.renderers] == [n == 0, n == 1]
            assert bar.GetLookupTable().GetRange() == pair()[n].get_data_range("p")


REMOVALS = {
    "name": lambda plotter, actor: plotter.remove_actor("wing"),
    "clear_actors": lambda plotter, actor: plotter.clear_actors(),
}


@pytest.mark.parametrize("how", REMOVALS)
def test_removed_actor_takes_bar_and_arrows_with_it(window: Any, how: str) -> None:
    handle = window.flowtex.add(volume(), slice="z", arrows=20, nullclines=True, name="wing")
    shot(window)
    assert window.renderer.GetViewProps().GetNumberOfItems() > 3
    REMOVALS[how](window, handle.actor)
    assert handle.closed and not len(window.flowtex) and not window.scalar_bars
    assert window.renderer.GetViewProps().GetNumberOfItems() == 0


def test_a_flow_of_the_same_name_is_replaced(window: Any) -> None:
    old = window.flowtex.add(volume(), slice="z", name="cut", label="below")
    new = window.flowtex.add(volume(), slice="x", name="cut", label="across", pickable=False)
    assert old.closed and list(window.flowtex) == [new]
    assert window.renderer.actors["cut"] is new.actor and not new.actor.pickable
    assert window.add_legend().GetNumberOfEntries() == 1
    edged = window.flowtex.add(volume(), slice="z", show_edges=True, edge_color="red", line_width=3)
    prop = edged.actor.prop
    assert (prop.show_edges, prop.edge_color, prop.line_width) == (True, "red", 3)


@pytest.mark.parametrize("what", ["U", "p", "points"])
def test_mesh_that_is_changed_in_place_is_drawn_again(window: Any, what: str) -> None:
    mesh = volume(structured=True)
    window.flowtex.add(mesh, slice="z=0.1", scalars="p")
    before = shot(window)
    changed = mesh.points if what == "points" else mesh[what]
    saved = np.array(changed)
    changed[:] = saved[:, [1, 0, 2]] if what == "U" else 0.7 * saved
    assert np.abs(shot(window) - before).mean() > 2
    changed[:] = saved
    np.testing.assert_array_equal(shot(window), before)
    changed[:] = 0.7 * saved
    np.testing.assert_array_equal(window.flowtex.for_browser()[0].volume_values["p"], mesh["p"])
    mesh["U"][:] = np.nan
    with pytest.warns(UserWarning, match="the mesh has changed and cannot be drawn, so the image"):
        window.render()


def test_another_surface_takes_the_place_of_a_mesh_that_was_changed_before(window: Any) -> None:
    old, new = (cut_at(letter) for letter in "ab")
    handle = window.flowtex.add(old, scalars="p")
    shot(window)
    old["p"][:] = -old["p"]
    handle.set_surface(new)
    shot(window)
    assert handle.actor.mapper.scalar_range == new.get_data_range("p")
    np.testing.assert_array_equal(handle.field.points.reshape(-1, 3), new.points)


def test_colours_follow_the_parameter_of_a_formula(window: Any) -> None:
    """They would all be the highest colour in the range of another parameter."""
    handle = window.flowtex.add(flowtex.formula("pendulum", b=0.2, resolution=65), **PLAIN)
    for b in (2.0, 0.0):
        field = flowtex.formula("pendulum", b=b, resolution=65)
        handle.set_surface(field)
        assert handle.scene.scalar_limits == Scene.of(field).scalar_limits
        bar = window.scalar_bars[next(iter(window.scalar_bars.keys()))].GetLookupTable()
        assert bar.GetRange() == pytest.approx(handle.scene.scalar_limits)
    handle.clim = (0.0, 3.0)
    handle.set_surface(flowtex.formula("pendulum", b=1.0, resolution=65))
    assert handle.scene.scalar_limits == (0.0, 3.0)
