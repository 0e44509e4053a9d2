"""Words on the camera's controls."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")

from flowtex.offscreen.annotations import round_length, singular


@pytest.mark.parametrize(
    ("unit", "one"),
    [("diameters", "diameter"), ("body lengths", "body length"), ("ms", "ms"), ("metre", "metre")],
)
def test_one_is_said_in_the_singular(unit: str, one: str) -> None:
    assert singular(unit) == one


@pytest.mark.parametrize(
    ("greatest", "length"),
    [(7.3, 5), (0.019, 0.01), (20, 20), (999, 500), (0, 0), (float("inf"), 0)],
)
def test_a_scale_bar_has_a_round_length(greatest: float, length: float) -> None:
    assert round_length(greatest) == pytest.approx(length)
