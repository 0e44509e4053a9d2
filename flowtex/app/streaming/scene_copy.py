"""A second scene that shows the same as the one on view."""

from __future__ import annotations

from typing import Any

from flowtex.app.streaming.scene import Scene
from flowtex.textures.images import as_image

__all__ = ["copy_of", "trace_moment"]


def copy_of(scene: Scene) -> Scene:
    """Return a scene of its own that shows the same."""
    handle = scene.handle
    settings = dict(handle.settings)
    image = handle.scene.image
    given: dict[str, Any] = dict(settings)
    if image is not None and settings["noise"] == "image":
        given["image"] = as_image(image)
    made = Scene(
        scene.field,
        scalars=scene.colour or False,
        cmap=scene.cmap,
        clim=scene.chosen_range,
        color=scene.plain,
        lighting=handle.actor.prop.lighting,
        **given,
    )
    if scene.beside:
        made.compare(scene.beside)
    made.canvas.set_camera(scene.canvas.camera())
    made.canvas.set_background(scene.canvas.plotter.background_color)
    made.set_time(handle.time)
    made.clock = scene.clock
    return made


def trace_moment(scene: Scene) -> None:
    """Trace what the time that is shown needs, so that drawing need not wait for it."""
    for pane in scene.panes:
        view = pane.handle.scene
        before, after, _ = view.moment
        for step in {before, after}:
            view.store.at(step)
