"""Elements of the page that trame does not have; ``static/flowtex.js`` makes them."""

from __future__ import annotations

from typing import Any

from trame_client.widgets.core import AbstractElement

__all__ = ["Client", "Keys", "PathInset", "PathLines"]


class Client(AbstractElement):
    """The browser's own client over the picture; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-client", **attributes)
        self._attr_names += ["source", "settings", "camera", "time", "playing"]
        self._event_names += [
            *((f"update_{name}", f"update:{name}") for name in ("camera", "time", "playing")),
            "setting",
            "sharp",
            "point",
            "hover",
        ]


class Keys(AbstractElement):
    """What listens to the keyboard, and knows the window; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-keys", **attributes)
        self._event_names += ["command", "toggle", "linked"]


class PathLines(AbstractElement):
    """The path through a point, over the picture; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-path", **attributes)
        self._attr_names += ["over"]


class PathInset(AbstractElement):
    """The samples of the path, enlarged; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-inset", **attributes)
        self._attr_names += ["over"]
