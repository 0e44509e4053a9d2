"""Where the camera of a plotter stands, and what it cuts off."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv

from flowtex import examples


def test_what_is_added_later_is_seen(plotter: Any) -> None:
    plotter.flowtex.add(examples.double_gyre_field(), samples=9, show_scalar_bar=False)
    plotter.render()
    # Nearer than the clipping range of the flat surface alone.
    plotter.add_mesh(pv.Sphere(radius=0.2, center=(1.0, 0.5, 0.5)), color="red", lighting=False)
    plotter.render()
    assert (plotter.screenshot()[120, 160] == [255, 0, 0]).all()
    # A range that somebody has set stays.
    plotter.camera.clipping_range = near, far = 0.01, 77.0
    plotter.render()
    np.testing.assert_allclose(plotter.camera.clipping_range, (near, far))
