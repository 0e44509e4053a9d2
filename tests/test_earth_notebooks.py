"""The notebooks of data of the Earth run too, in a process beside the others."""

from __future__ import annotations

from typing import Any

import pytest
from test_notebooks import FOLDER, OF_EARTH, run


@pytest.mark.slow
@pytest.mark.parametrize("name", OF_EARTH)
def test_a_notebook_runs(name: str, opengl: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("cf_xarray")
    run(FOLDER / f"{name}.ipynb", monkeypatch)
