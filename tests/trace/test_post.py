"""The liquid-oxygen post, the paper's data: real nodes, a seam, cells of very different sizes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measures import grey, streaks

import flowtex
from flowtex._util.array_types import AnyArray

SIZE = (400, 300)
# Zoom, and a point near the wall of the post at which the view looks.
VIEWS = [(1, (0.0, 0.0)), (8, (0.0, 0.7)), (64, (0.0, 0.58)), (64, (0.58, 0.0))]


@pytest.fixture(scope="module")
def post(data_dir: Path) -> flowtex.FlowField:
    return flowtex.FlowField.from_file(data_dir / "postxyz.bin", plane="k=20")


def cut_elsewhere(field: flowtex.FlowField, by: int) -> flowtex.FlowField:
    """Join the same surface at another line of nodes."""

    def turned(a: AnyArray, axis: int) -> AnyArray:
        open_ = np.take(a, range(a.shape[axis] - 1), axis=axis)
        moved = np.roll(open_, by, axis=axis)
        return np.concatenate([moved, np.take(moved, [0], axis=axis)], axis=axis)

    return flowtex.FlowField.from_arrays(
        turned(field.points, 0), turned(field.velocity[0], 0), valid=turned(field.valid, 0)
    )


def test_it_is_what_the_paper_used(post: flowtex.FlowField) -> None:
    assert sorted(post.shape) == [38, 76]
    assert sum(post.periodic) == 1
    size = post.surface.cell_size
    assert size.max() / size.min() > 300


@pytest.mark.parametrize(("zoom", "focus"), VIEWS)
def test_streaks_are_clear_from_afar_and_at_the_wall(
    post: flowtex.FlowField, opengl: Any, zoom: float, focus: tuple[float, float]
) -> None:
    options: dict[str, Any] = {"size": SIZE, "zoom": zoom, "focus": focus, "scalars": False}
    picture = flowtex.render(post, background="red", **options)
    drawn = ~(picture == [255, 0, 0]).all(axis=-1)
    mask = drawn.copy()
    for axis in (0, 1):
        for shift in range(-12, 13, 4):
            mask &= np.roll(drawn, shift, axis=axis)
    mask[:12] = mask[-12:] = mask[:, :12] = mask[:, -12:] = False
    assert mask.sum() > 5000
    ones = np.ones(mask.shape)
    assert streaks(picture, ones, 0 * ones, mask)["coherence"] > 0.85


@pytest.mark.parametrize(("zoom", "focus"), [(1, (0.0, 0.0)), (8, (0.5, 0.0)), (8, (-0.7, 0.0))])
def test_the_joined_column_is_not_seen(
    post: flowtex.FlowField, opengl: Any, zoom: float, focus: tuple[float, float]
) -> None:
    options: dict[str, Any] = {"size": SIZE, "zoom": zoom, "focus": focus, "scalars": False}
    here = grey(flowtex.render(post, **options))
    there = grey(flowtex.render(cut_elsewhere(post, 20), **options))
    difference = np.abs(here - there)
    # Where the two cuts differ would stand out against how little they differ elsewhere.
    assert difference.mean() < 6
    assert np.corrcoef(here.ravel(), there.ravel())[0, 1] > 0.97
