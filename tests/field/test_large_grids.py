"""Large grids are checked, and their planes found, at some of their nodes where these suffice."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from flowtex import FieldError, FlowField
from flowtex._util.array_types import Bools, Floats
from flowtex.field import node_surface, validation


def holed_plane(height: float = 0.0) -> tuple[Floats, Floats, Bools]:
    """Positions and velocity (J, I, 3) of a plane with a hole, and its nodes with data."""
    x, y = np.meshgrid(np.linspace(0, 2, 300), np.linspace(0, 1, 200))
    points = np.stack([x, y, height * x * y], axis=-1)
    valid = np.hypot(x - 1, y - 0.5) > 0.2
    return points, np.stack([-y, x, 0 * x], axis=-1), valid


@pytest.fixture
def sizes(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of nodes that are compared with a line, or with a plane, by call."""
    found: list[int] = []
    compared = {validation: "_line_faults", node_surface: "_principal_axes"}

    def counted(name: str, original: Any) -> Any:
        def call(nodes: Floats) -> Any:
            found.append(len(nodes))
            return original(nodes)

        return call

    for module, name in compared.items():
        monkeypatch.setattr(module, name, counted(name, getattr(module, name)))
    return found


def test_some_nodes_show_that_a_surface_is_no_line(sizes: list[int]) -> None:
    points, velocity, valid = holed_plane()
    field = FlowField.from_arrays(points, velocity, valid=valid)
    assert field.surface.frame is not None
    assert np.abs(field.surface.frame - np.eye(3)[:2]).max() == 0
    assert field.normal_share == 0
    assert len(sizes) == 1
    assert max(sizes) <= validation.MOST_COMPARED


def test_a_surface_that_is_a_line_for_some_nodes_is_compared_as_a_whole(sizes: list[int]) -> None:
    x = np.linspace(0, 1, 2 * validation.MOST_COMPARED)
    points = np.zeros((2, len(x), 3))
    points[..., 0] = x
    # Every second node is compared first; the surface leaves the line between them.
    points[1, 1::2, 1] = 1e-3
    FlowField.from_arrays(points, np.ones_like(points))
    assert sizes[:2] == [validation.MOST_COMPARED, 2 * len(x)]
    points[..., 1] = 0
    with pytest.raises(FieldError, match="all usable nodes lie on one line"):
        FlowField.from_arrays(points, np.ones_like(points))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_plane_of_a_constant_coordinate_has_the_other_axes(axis: int) -> None:
    points, velocity, valid = holed_plane()
    field = FlowField.from_arrays(
        np.roll(points, axis, axis=-1), np.roll(velocity, axis, axis=-1), valid=valid
    )
    frame = field.surface.frame
    assert frame is not None
    assert frame.tolist() == np.delete(np.eye(3), (2 + axis) % 3, axis=0).tolist()


def test_the_normal_share_is_that_of_nodes_with_data() -> None:
    points, velocity, valid = holed_plane()
    velocity[..., 2] = 0.5
    velocity[~valid] = 1e3
    field = FlowField.from_arrays(points, velocity, valid=valid)
    shown = velocity[valid]
    expected = np.sqrt((shown[:, 2] ** 2).sum() / (shown**2).sum())
    assert field.normal_share == pytest.approx(expected)


@pytest.mark.parametrize("steps", [1, 3])
@pytest.mark.parametrize("rows", [8, 500])
def test_the_normal_share_of_a_large_surface_is_that_of_some_rows(
    rows: int, steps: int, rng: np.random.Generator
) -> None:
    longitude, latitude = np.meshgrid(np.linspace(0, 3, 250_000 // rows), np.linspace(-1, 1, rows))
    across = np.cos(latitude)
    points = np.stack(
        [across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1
    )
    along = np.cross([0.0, 0.0, 1.0], points)
    out = rng.normal(0, 0.2, (steps, *longitude.shape, 1))
    velocity = along + out * points
    times = np.arange(float(steps))
    field = FlowField.from_arrays(points, velocity, times=times)
    assert "index_velocity" not in field.__dict__
    assert field.normal_share == pytest.approx(field.index_velocity.normal_share, rel=0.02)


def test_a_large_surface_whose_rows_alternate_has_the_normal_share_of_all() -> None:
    x, y = np.meshgrid(np.linspace(0, 2, 1000), np.linspace(0, 1, 250))
    points = np.stack([x, y, 0.1 * np.sin(4 * x * y)], axis=-1)
    velocity = np.ones_like(points)
    valid = np.arange(250)[:, None] % 5 > 0
    valid = np.broadcast_to(valid, x.shape)
    field = FlowField.from_arrays(points, velocity, valid=valid)
    assert field.normal_share == field.index_velocity.normal_share > 0.1
