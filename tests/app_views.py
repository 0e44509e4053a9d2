"""Pictures of a page's view, for the tests of the page."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["difference", "picture"]


def picture(app: Any) -> Any:
    width, height = app.viewport.size
    return app.viewport.draw(width, height).astype(int)


def difference(one: Any, other: Any) -> float:
    return float(np.abs(np.asarray(one, int) - np.asarray(other, int)).mean())
