"""The delta wing: a curved surface with a flow along it, in the shuttle's place."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex.examples import delta_wing, delta_wing_field
from flowtex.field import FlowField


@pytest.fixture(scope="module")
def wing() -> FlowField:
    return delta_wing_field()


def test_it_has_the_nodes_of_the_papers_shuttle(wing: FlowField) -> None:
    assert wing.shape == (52, 62)
    assert wing.steady and wing.periodic == (False, False)
    assert wing.surface.frame is None  # curved
    assert delta_wing().dimensions == (62, 52, 1)


def test_both_sides_mirror_each_other(wing: FlowField) -> None:
    mirror = np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(wing.points[::-1], wing.points * mirror, atol=1e-12)
    np.testing.assert_allclose(wing.velocity[0, ::-1], wing.velocity[0] * mirror, atol=1e-9)


def test_the_flow_lies_along_the_surface(wing: FlowField) -> None:
    assert wing.normal_share < 0.02
    fine = delta_wing_field((206, 246))
    assert fine.normal_share < wing.normal_share / 3


def test_cells_differ_and_none_is_turned_over(wing: FlowField) -> None:
    normal = np.cross(*wing.surface.tangents)
    area = np.linalg.norm(normal, axis=-1)
    assert area.max() / area.min() > 100
    assert (normal[..., 2] > 0).all()


def test_streams_part_and_meet_on_each_wing(wing: FlowField) -> None:
    across = wing.velocity[0, wing.shape[0] // 2 :, -5, 1]
    # From the body outwards, and from the edge inwards: they meet in between.
    assert across.max() > 0.1
    assert across[-4] < -0.1
