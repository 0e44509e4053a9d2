"""NumPy, VTK and WebGL2 draw the same pictures, over the one list in matrix.py."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_views import drawn_by_vtk, drawn_by_webgl
from matrix import COLOUR, DEEP, GROUND, ROOT, SHARE, SMALL, VIEWS, difference, judged
from webgl_page import ClientPage

from flowtex._util.array_types import Bytes
from flowtex.rendering.cpu.render import render
from flowtex.scene.scene import Scene

#: Whether Chromium draws with its own software WebGL, which filters with fewer digits.
OWN = """(({ gl }) => gl.getExtension('WEBGL_debug_renderer_info') !== null
  && /SwiftShader/.test(gl.getParameter(37446)))(viewers[0].graphics)"""
#: Factors of the tolerances in such a browser, and with VTK, whose filters have the most digits.
COARSER, FINER = 4.5, 0.95


def agree(theirs: Bytes, name: str, more: float = 1.0) -> None:
    shown, ours = judged(name)
    # What enhances the texture enhances the differences.
    more *= max(shown.settings.contrast, 1.0)
    assert theirs.shape == ours.shape
    root, share, only_one = difference(theirs, ours)
    assert (ours != np.rint(255 * np.array(GROUND))).any(axis=-1).mean() > 0.1
    assert root < more * ROOT
    assert share < more * SHARE
    # Where an edge of the surface passes through the middle of a pixel, either may cover it;
    # a coarser mesh moves the outline by up to a quarter of a pixel.
    assert only_one <= 10


#: Views in which the shaders of VTK and WebGL only get another number or camera of a kind that
#: other views have as well: only WebGL draws them.
SHARED = {
    *("many samples", "levels", "one-sided", "by time"),
    *("streaklets, curved", "streaklets, near a source"),
    *("streaklets, near triangles", "between two steps, moving", "streamlines, near"),
    *("half still, streaming", "half still, between two steps", "centre, streaming"),
    *("triangles, centre", "triangles, holes"),
    *("uncertain, centre", "uncertain, between two steps", "image, mixed"),
}


def test_views_of_webgl_alone_exist() -> None:
    assert VIEWS.keys() > SHARED


@pytest.mark.parametrize("name", [name for name in VIEWS if name not in SHARED])
def test_vtk_agrees_with_numpy(plotter: Any, name: str) -> None:
    agree(drawn_by_vtk(plotter, VIEWS[name]), name, FINER)


@pytest.mark.parametrize("name", [name for name in VIEWS if "half still" in name])
def test_flow_at_rest_is_plain(plotter: Any, name: str) -> None:
    picture = drawn_by_vtk(plotter, VIEWS[name]).astype(int)
    ground = (picture == np.rint(255 * np.array(GROUND))).all(axis=-1)
    columns = np.flatnonzero(~ground.all(axis=0))
    middle = columns[0] + (columns[-1] - columns[0]) // 2  # x = 1, where the flow begins
    rows = np.flatnonzero(~ground.all(axis=1))[5:-5]
    still, moving = picture[rows, columns[3] : middle - 8], picture[rows, middle + 8 : columns[-5]]
    assert np.ptp(still, axis=(0, 1)).max() == 0
    # Also the slow flow has streaks, and the mean of the streaks is the plain grey.
    for part in np.array_split(moving, 2):
        assert part.std() > 15 and abs(part.mean() - still.mean()) < 12


@pytest.mark.parametrize("name", ["spacing", "grain", "contrast"])
def test_two_hundredths_more_would_be_noticed(name: str) -> None:
    view, (shown, ours) = VIEWS["many samples"], judged("many samples")
    settings = shown.settings.copy()
    setattr(settings, name, getattr(settings, name) * 1.02)
    other = render(Scene(view.field(), settings).textures, settings, view.camera, SMALL)
    assert difference(other.rgb(COLOUR, background=GROUND), ours)[0] > ROOT


@pytest.mark.browser
@pytest.mark.parametrize("name", VIEWS | DEEP)
def test_webgl_agrees_with_numpy(client: ClientPage, name: str) -> None:
    theirs = drawn_by_webgl(client, (VIEWS | DEEP)[name], judged(name)[0])
    agree(theirs, name, COARSER if client.page.evaluate(OWN) else 1.0)
    assert client.page.evaluate("viewers[0].graphics.context.getError()") == 0
