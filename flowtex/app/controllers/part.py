"""What the groups of controls of a page have in common."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flowtex.app.flow_app import FlowApp
    from flowtex.app.server.state import PageState
    from flowtex.app.streaming.area import FlowArea
    from flowtex.app.streaming.scene import Scene

__all__ = ["Part"]


class Part:
    """One group of controls: its values on the page, and what they do.

    Parameters
    ----------
    app
        The application.
    """

    def __init__(self, app: FlowApp) -> None:
        self.app = app
        self.state: PageState = app.state
        self.area: FlowArea = app.area

    @property
    def scene(self) -> Scene:
        """What is drawn."""
        return self.area.scene

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {}

    def watch(self) -> None:
        """Listen to the page."""

    def refresh(self) -> None:
        """Follow another flow that is shown."""

    def describe(self) -> dict[str, Any]:
        """Return what a link needs to know; :mod:`flowtex.app.controllers.links` has the names."""
        return {}

    def restore(self, said: Mapping[str, Any]) -> None:
        """Take over what a link says."""

    def close(self) -> None:
        """End what goes on."""
