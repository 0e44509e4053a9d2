"""The paper's noise texture."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.examples import cylinder_field
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.trace.store import SliceStore


def stretched(count: int = 41, power: float = 2.5) -> FlowField:
    x = np.sinh(np.linspace(0, power, count))
    points = np.stack(np.meshgrid(x, np.linspace(0, 1, count)), axis=-1)
    return FlowField.from_arrays(points, np.broadcast_to([1.0, 0.1], points.shape), periodic="")


def made(field: FlowField, *, corrected: bool, seed: int = 0) -> NoiseTextures:
    return NoiseTextures.of(SliceStore(field), 128, seed, corrected=corrected)


@pytest.mark.parametrize("corrected", [True, False])
def test_noise_has_zero_mean_and_unit_variance_and_a_seed(corrected: bool) -> None:
    one, same, other = (
        made(stretched(), corrected=corrected, seed=seed).texels for seed in (1, 1, 2)
    )
    assert one.mean() == pytest.approx(0, abs=1e-5)
    assert one.std() == pytest.approx(1, abs=1e-4)
    np.testing.assert_array_equal(one, same)
    assert np.corrcoef(one.ravel(), other.ravel())[0, 1] < 0.2


def test_correction_makes_the_grain_even_on_the_surface() -> None:
    """Figure 6: grains of the corrected noise have the same length where cells have not."""
    field = stretched()
    x = field.points[0, :, 0]
    plain, even = (made(field, corrected=c) for c in (False, True))
    np.testing.assert_allclose(plain.coordinate[0, :, 0], np.linspace(0, 1, 41), atol=1e-6)

    def spread(noise: NoiseTextures) -> float:
        """Ninth over first decile of the lengths of grains along a row."""
        row = noise.texels[noise.texels.shape[0] // 2, :, 0]
        edges = (np.flatnonzero(np.diff(row)) + 1) / len(row)
        grains = np.diff(np.interp(edges, noise.along_i, x))
        return float(np.quantile(grains, 0.9) / np.quantile(grains, 0.1))

    assert spread(plain) > 4
    assert spread(even) < 3


def test_noise_is_repeated_where_the_axis_is() -> None:
    assert made(cylinder_field().at_step(0), corrected=True).repeat == (False, True)
