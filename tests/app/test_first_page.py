"""What a page begins with, and small words on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
import pyvista as pv

from flowtex.errors import FieldError

if TYPE_CHECKING:
    from pathlib import Path

pytest.importorskip("trame_rca")


def write_flow(path: Path) -> None:
    mesh = pv.ImageData(dimensions=(6, 5, 1))
    mesh["velocity"] = np.ones((30, 3))
    mesh.save(path)


def test_a_file_that_cannot_be_drawn_does_not_hide_the_others(tmp_path: Path) -> None:
    from flowtex.app import Library
    from flowtex.app.flow_app import first_choice

    (tmp_path / "a.vts").touch()
    still = pv.ImageData(dimensions=(6, 5, 1))
    still["pressure"] = np.zeros(30)
    still.save(tmp_path / "b.vti")
    with pytest.raises(FieldError, match=r"a\.vts"):
        first_choice(Library.of(tmp_path), {})
    write_flow(tmp_path / "c.vti")
    assert first_choice(Library.of(tmp_path), {})[0] == "c.vti"


def test_lines_of_python_make_the_flow_that_is_shown(tmp_path: Path) -> None:
    from flowtex.app import Library
    from flowtex.field.source import FlowSource

    write_flow(tmp_path / "c.vti")
    assert Library.of(tmp_path).python("c.vti") is None
    made = Library({"one": lambda: FlowSource(None)}, python={"one": "make()"})
    assert made.python("one") == "make()"
    compile(f"field = {Library.of(pv.read(tmp_path / 'c.vti')).python('flow')}", "lines", "exec")


@pytest.mark.parametrize(
    ("unit", "one"),
    [("diameters", "diameter"), ("body lengths", "body length"), ("ms", "ms"), ("metre", "metre")],
)
def test_one_is_said_in_the_singular(unit: str, one: str) -> None:
    from flowtex.app.controllers.moves import singular

    assert singular(unit) == one


def test_every_slider_can_be_put_back_to_its_default() -> None:
    from flowtex.app.ui.controls import MOST_STOPS, _step
    from flowtex.settings import TABLE

    for setting in TABLE.values():
        low, high = setting.low or 0.0, setting.high or 0.0
        if setting.kind is float and high - low <= MOST_STOPS:
            steps = (setting.default - low) / _step(low, high, setting.default)
            assert steps == pytest.approx(round(steps), abs=1e-6), setting.name
