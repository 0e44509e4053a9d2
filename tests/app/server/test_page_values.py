"""What a page sends is of use, or made harmless."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from strategies import junk, property_test

pytest.importorskip("trame_rca")

from flowtex.app.server.page import (
    clipped,
    mapping,
    name_among,
    number,
    shortened,
)
from flowtex.rendering.camera import Camera, CameraError


@property_test(50, fuzz=100)
@given(junk())
@example(10**400)
@example(math.nan)
def test_anything_is_a_number_within_limits_or_none(value: Any) -> None:
    checked = number(value, -5, 5)
    assert checked is None or (type(checked) is float and -5 <= checked <= 5)
    assert -1 <= clipped(value, 0.5, -1, 1) <= 1
    assert name_among(value, ("a", "b")) is (value in ("a", "b"))
    assert isinstance(dict(mapping(value)), dict)
    assert len(shortened(str(value), 50)) <= 50


@property_test(50, fuzz=100)
@given(
    st.fixed_dictionaries(
        {},
        optional=dict.fromkeys(
            ("position", "focal_point", "up", "parallel", "parallel_scale", "view_angle"),
            junk() | st.lists(st.floats() | st.integers(), min_size=3, max_size=3),
        ),
    )
    | junk()
)
@example({"parallel_scale": 10**400})
@example({"position": [10**400, 0, 1]})
def test_anything_is_a_camera_or_is_refused(values: Any) -> None:
    try:
        camera = Camera.from_dict(values, Camera((0, 0, 1), (0, 0, 0), (0, 1, 0)))
    except CameraError as error:
        assert "; expected " in str(error)
    else:
        assert camera == Camera.from_dict(camera.to_dict())
