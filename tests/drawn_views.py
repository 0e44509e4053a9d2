"""Pictures of views by the renderers: VTK, and WebGL2 in a browser."""

from __future__ import annotations

from typing import Any

import numpy as np
from matrix import COLOUR, GROUND, SMALL, View
from webgl_page import ClientPage, packed, state

from flowtex._util.array_types import Bytes
from flowtex.rendering.camera import apply_camera
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.scene import Scene

Size = tuple[int, int]


def drawn_by_vtk(plotter: Any, view: View, size: Size = SMALL) -> Bytes:
    """Draw a view in a plotter, and leave it as it was."""
    plotter.window_size = list(size)
    plotter.set_background(GROUND)
    shown: dict[str, Any] = {"scalars": False, "lighting": False, "color": COLOUR}
    settings = {"samples": 11, **view.settings}
    handle = plotter.flowtex.add(view.field(), image=view.image, **shown, **settings)
    if view.time is not None:
        handle.time = view.time
    handle.clock, handle.surface.view.still = view.clock, True
    apply_camera(view.camera, plotter.camera)
    plotter.camera_set = True
    plotter.renderer.reset_camera_clipping_range()
    plotter.render()
    picture = np.asarray(plotter.screenshot(return_img=True))[..., :3].copy()
    handle.remove()
    return picture


def drawn_by_webgl(client: ClientPage, view: View, shown: Scene, size: Size = SMALL) -> Bytes:
    """Draw a view with its scene in a browser."""
    before, after, _ = shown.moment
    whole = ClientData(shown.textures, Colours(plain=COLOUR, background=GROUND))
    header = whole.header(
        shown.settings, camera=state(view.camera), time=shown.time, clock=view.clock
    )
    given = packed(whole, header, (before, after))
    return client.picture(client.mount(given, size, controls=False, smooth=False))
