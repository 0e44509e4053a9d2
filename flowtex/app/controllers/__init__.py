"""What the controls of a page do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from flowtex.app.controllers.appearance import Appearance
from flowtex.app.controllers.context import Context
from flowtex.app.controllers.data import Data
from flowtex.app.controllers.file_beside import FileBeside
from flowtex.app.controllers.library import Choice
from flowtex.app.controllers.sharing import Sharing
from flowtex.app.controllers.viewpoint import Viewpoint

__all__ = ["Controllers"]


class Controllers:
    """All controllers of a page that first shows a flow of the library.

    ``restore_state`` is called with the state that a link holds.
    """

    def __init__(
        self,
        context: Context,
        name: str,
        choice: Choice,
        restore_state: Callable[[Mapping[str, Any]], None],
    ) -> None:
        self.context = context
        self.data = Data(context, name, choice)
        self.beside = FileBeside(context, self.data)
        self.appearance = Appearance(context, self.beside)
        self.viewpoint = Viewpoint(context)
        self.sharing = Sharing(
            context,
            source=lambda: self.data.python,
            source_beside=lambda: self.beside.python,
            restore_state=restore_state,
        )

    def cancel_opening(self) -> None:
        """Stop what is being opened, in either pane."""
        self.data.cancel()
        self.beside.cancel()
