"""A whole page: its state, its controls, and what it begins with."""

from __future__ import annotations

import gc
from collections import Counter
from pathlib import Path
from types import FunctionType, MethodType

import numpy as np
import pytest
import pyvista as pv

pytest.importorskip("trame_rca")

from camera_moves import pan
from small_pages import playing, small, small_page, zoom_of

from flowtex import examples
from flowtex.app import FlowApp, Library
from flowtex.app.flow_app import first_choice
from flowtex.errors import FieldError

pytestmark = pytest.mark.usefixtures("opengl")

#: What holds arrays, windows and listeners.
KINDS = ("flowtex", "vtkmodules", "pyvista")


def test_examples_make_an_app() -> None:
    app = FlowApp(examples.cylinder_field(), zoom=3.0, focus=(4.0, 0.0), scalars=False)
    app.stream.update_size("test", {"w": 64, "h": 48})
    assert zoom_of(app) == pytest.approx(3.0)
    assert (
        not app.area.scalars
        and app.state.get("about") == "161 × 65 nodes · 31 times · periodic along i"
    )
    app.close()


def objects() -> Counter[str]:
    """Objects that are alive, by their class, and functions by their name."""
    gc.collect()
    functions = (FunctionType, MethodType)
    kinds = (one if isinstance(one, functions) else type(one) for one in gc.get_objects())
    return Counter(kind.__qualname__ for kind in kinds if str(kind.__module__).startswith(KINDS))


async def test_use_leaves_no_object_behind() -> None:
    app = small_page(small(), 3, 96, 64)
    app.area.settings.resolution = 32

    def use() -> None:
        element, whole = app.area, app.viewport.camera
        element.begin("browser")
        element.take_camera(pan(whole, 0.1, 0.1, 1.5).to_dict())
        element.take_camera(whole.to_dict())
        element.take_colours({"cmap": "magma"})
        element.take_colours({"cmap": "viridis"})
        for name, values in (("texture", ("streaklets", "dense")), ("lod", (False, True))):
            for value in values:
                setattr(app.area.settings, name, value)
                app.viewport.draw(96, 64)
        element.take_playing(True)
        element.take_clock(0.1)
        element.take_playing(False)
        list(app.stream.painter.full(app.stream.painter.quick()))

    # A second move of the pointer soon after the first waits in the loop.
    async with playing(app):
        use()  # every variant has been shown once
        use()  # and what the page shows is not what a new one does
        before = objects()
        use()
        assert objects() - before == Counter()


def write_flow(path: Path) -> None:
    mesh = pv.ImageData(dimensions=(6, 5, 1))
    mesh["velocity"] = np.ones((30, 3))
    mesh.save(path)


def test_a_file_that_cannot_be_drawn_does_not_hide_the_others(tmp_path: Path) -> None:
    (tmp_path / "a.vts").touch()
    still = pv.ImageData(dimensions=(6, 5, 1))
    still["pressure"] = np.zeros(30)
    still.save(tmp_path / "b.vti")
    with pytest.raises(FieldError, match=r"a\.vts"):
        first_choice(Library.of(tmp_path), {})
    write_flow(tmp_path / "c.vti")
    assert first_choice(Library.of(tmp_path), {})[0] == "c.vti"


def test_page_reports_choices_beyond_its_controls(tmp_path: Path) -> None:
    """The controls show array and plane; fill values have a flag of the command line."""
    box = pv.ImageData(dimensions=(6, 5, 4))
    values = np.tile([1.0, 2.0, 0.0], (box.n_points, 1))
    values[:40] = -999.0
    box["wind"] = values
    box["force"] = values * 2
    box.save(tmp_path / "box.vti")
    app = small_page(tmp_path / "box.vti")
    texts = app.state.get("choices")
    app.close()
    assert len(texts) == 1
    assert texts[0].endswith("; to draw these values too, --mask none")


def test_page_of_arrays_reports_nothing() -> None:
    app = small_page(small())
    assert app.state.get("choices") == []
    app.close()


def test_time_of_drifters_is_chosen_by_the_slider(tmp_path: Path) -> None:
    """Points move along x by one per hour; at hour 0 there are too few of them."""
    rows = ["id,time,x,y"]
    places = np.random.default_rng(2).uniform(0, 5, (40, 2))
    for number, (x, y) in enumerate(places):
        for hour in range(number % 3 // 2, 6):
            rows.append(f"{number},2024-01-01T0{hour}:00:00,{x + hour:.6f},{y:.6f}")
    path = tmp_path / "drifters.csv"
    path.write_text("\n".join(rows))
    app = small_page(path)
    try:
        assert app.state.get("axes") == ["time"] and app.state.get("planes") == 4
        assert app.state.get("plane_text") == "2024-01-01 01:00"
        source = app.data._current.source
        for number in (1, 3):
            field = source.field(plane=f"time={number}")
            found = np.sort(field.points[0, :, 0])
            assert found == pytest.approx(np.sort(places[:, 0] + number + 1), abs=1e-5)
    finally:
        app.close()
