"""The notebooks of data of the Earth run too, in a process beside the others, with less of it."""

from __future__ import annotations

from typing import Any

import pytest
from test_notebooks import FOLDER, run, started

#: Every third point and time of the examples.
LESS = """import flowtex
import flowtex.tiles.pyramid
for name in ("ocean", "weather"):
    data = getattr(flowtex.examples, name)()
    few = {dim: slice(None, None, 3) for dim in data.dims if dim != "level"}
    setattr(flowtex.examples, name, lambda data=data.isel(few): data)
flowtex.tiles.pyramid.ROOT_NODES = 20_000
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("ocean", {"seconds=3": "seconds=1"}),
        ("weather", {}),
        ("pyramid", {"760": "190", "500": "125"}),
    ],
)
def test_a_notebook_runs(name: str, changes: dict[str, str], opengl: Any) -> None:
    pytest.importorskip("cf_xarray")
    with started() as kernel:
        run(FOLDER / f"{name}.ipynb", kernel, LESS, changes)
