"""``flowtex.show`` outside of notebooks: arguments that a window or a page has no use for."""

from __future__ import annotations

from typing import Any

import pytest
from flows import gyre

import flowtex
from flowtex import FieldError
from flowtex.errors import Notice


def host(monkeypatch: pytest.MonkeyPatch, *, display: bool) -> list[Any]:
    """Let there be a display or none; return the fields of pages that are served."""
    served: list[Any] = []
    monkeypatch.setattr("flowtex.rendering.diagnostics.has_display", lambda: display)
    monkeypatch.setattr("flowtex.rendering.diagnostics.prefer_headless", lambda: None)
    monkeypatch.setattr("flowtex.rendering.diagnostics.require_opengl", lambda: None)
    monkeypatch.setattr("flowtex.app.serve", lambda field, **_: served.append(field))
    return served


def test_a_page_has_no_size_and_no_bar_of_vtk(monkeypatch: pytest.MonkeyPatch) -> None:
    served = host(monkeypatch, display=False)
    for size in (3, (300, 200)):
        with pytest.raises(FieldError, match=r"^size is .*; omit size, or draw with flowtex.rend"):
            flowtex.show(gyre(), size=size)  # type: ignore[arg-type]
    with pytest.raises(FieldError, match="scalar_bar_args"):
        flowtex.show(gyre(), scalar_bar_args={"title": "speed"})
    assert not served
    flowtex.show(gyre())
    assert len(served) == 1


def test_the_size_of_a_window_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    host(monkeypatch, display=True)
    with pytest.raises(FieldError, match="size is 3; expected width and height in pixels"):
        flowtex.show(gyre(), size=3)  # type: ignore[call-overload]


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"clock": 3.0}, "clock is 3.0, but motion is 'off'"),
        ({"coastlines": True}, "coastlines is True, but the field is not on the Earth"),
        ({"graticule": True}, "graticule is True, but the field is not on the Earth"),
    ],
)
def test_what_a_picture_has_no_use_for_is_told(options: Any, told: str, opengl: Any) -> None:
    del opengl
    with pytest.warns(Notice, match=told):
        flowtex.render(gyre(), size=(320, 240), samples=3, **options)
