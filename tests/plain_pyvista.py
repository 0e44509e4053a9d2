"""What PyVista alone draws, to compare with."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv

from flowtex import FlowField
from flowtex.plotting.component import point_camera


def off_colours(picture: Any, mesh: Any, field: FlowField, **options: Any) -> float:
    """Return how far colours in the middle of a picture of a field are from PyVista's, on average.

    ``mesh`` is coloured with the ``options`` of ``add_mesh``, from 0 to 255.
    """
    height, width = picture.shape[:2]
    reference: Any = pv.Plotter(off_screen=True, window_size=[width, height])
    reference.disable_anti_aliasing()
    reference.add_mesh(mesh, lighting=False, **options)
    point_camera(reference, field.surface)
    expected = reference.screenshot(return_img=True)
    reference.close()
    inner = (slice(height // 3, height // 2), slice(width // 4, 3 * width // 4))
    return float(np.abs(picture[inner].astype(float) - expected[inner]).mean())
