"""Parts of PyVista without a public place: a new version that moves or changes them fails here."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pv = pytest.importorskip("pyvista")

from flowtex._util.pyvista_internals import (  # noqa: E402
    abandon,
    mappers_of_bar,
    named_backend,
    open_plotters,
    set_range_of_bar,
)

PACKAGE = Path(__file__).parents[2] / "flowtex"


def test_meshes_with_one_title_share_a_bar_and_its_range() -> None:
    plotter = pv.Plotter(off_screen=True)
    first = plotter.add_mesh(pv.Sphere().elevation(), scalars="Elevation")
    second = plotter.add_mesh(pv.Cube().elevation(), scalars="Elevation")
    bars = plotter.scalar_bars
    assert mappers_of_bar(bars, "Elevation") == [first.mapper, second.mapper]
    assert mappers_of_bar(bars, "pressure") == []
    set_range_of_bar(bars, "Elevation", (-7.0, 9.0))
    third = plotter.add_mesh(pv.Cone().elevation(), scalars="Elevation")
    assert third.mapper.scalar_range == (-7.0, 9.0)
    plotter.close()


def test_open_plotters_are_known_until_they_are_closed() -> None:
    plotter = pv.Plotter(off_screen=True)
    assert plotter in open_plotters()
    plotter.close()
    assert plotter not in open_plotters()


def test_an_abandoned_plotter_has_no_window() -> None:
    plotter = pv.Plotter(off_screen=True)
    window = plotter.render_window
    abandon(plotter)
    assert plotter.render_window is None
    plotter.close()  # frees nothing
    window.Finalize()


@pytest.mark.parametrize(("given", "expected"), [("TRAME", "trame"), (None, None)])
def test_callers_of_show_name_the_backend(given: str | None, expected: str | None) -> None:
    def show(jupyter_backend: str | None) -> str | None:
        assert jupyter_backend == given
        return handler()

    def handler() -> str | None:
        return named_backend("flowtex")

    assert show(given) == expected
    assert handler() == "flowtex"


def test_show_of_pyvista_has_the_backend_as_an_argument() -> None:
    code = pv.Plotter.show.__code__
    names = code.co_varnames
    if hasattr(pv.Plotter.show, "__wrapped__"):
        names = pv.Plotter.show.__wrapped__.__code__.co_varnames
    assert "jupyter_backend" in names


def test_no_other_module_uses_private_parts() -> None:
    private = re.compile(r"_scalar_bar_(mappers|ranges)\b|_ALL_PLOTTERS|plotter\._|f_locals")
    found = []
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        if path.name != "pyvista_internals.py" and private.search(text):
            found.append(path.name)
    assert not found
