"""The order of the steps before a frame, and what they keep alive."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest
import pyvista as pv

from flowtex.rendering.vtk.frame import FrameSteps, Step


class Recorder:
    """Writes its name into a list before each frame."""

    def __init__(self, name: str, written: list[str]) -> None:
        self.name = name
        self.written = written

    def before(self, _renderer: pv.Renderer) -> None:
        self.written.append(self.name)


@pytest.fixture
def plotter() -> Iterator[pv.Plotter]:
    plotter = pv.Plotter(off_screen=True, window_size=[40, 30])
    plotter.add_mesh(pv.Sphere())
    plotter.show(auto_close=False)
    yield plotter
    plotter.close()


def test_steps_run_in_their_order_however_they_are_added(plotter: pv.Plotter) -> None:
    written: list[str] = []
    steps = FrameSteps.of(plotter.renderer)
    assert FrameSteps.of(plotter.renderer) is steps
    recorders = [Recorder(step.name, written) for step in Step]
    for recorder in reversed(recorders):
        steps.add(Step[recorder.name], recorder.before)
        steps.add(Step[recorder.name], recorder.before)  # a second time
    plotter.render()
    assert written == [step.name for step in Step]


def test_step_ends_when_it_is_removed_or_its_object_ends(plotter: pv.Plotter) -> None:
    written: list[str] = []
    steps = FrameSteps.of(plotter.renderer)
    kept = Recorder("kept", written)
    removed = Recorder("removed", written)
    lost = Recorder("lost", written)
    for recorder in (kept, removed, lost):
        steps.add(Step.SURFACES, recorder.before)
    steps.remove(removed.before)
    ended = weakref.ref(lost)
    del lost, recorder
    gc.collect()
    assert ended() is None
    plotter.render()
    assert written == ["kept"]


def test_error_of_a_step_lets_the_others_run(
    plotter: pv.Plotter, capfd: pytest.CaptureFixture[str]
) -> None:
    written: list[str] = []
    recorder = Recorder("after", written)

    def fail(_renderer: pv.Renderer) -> None:
        raise ValueError("no values for this frame")

    steps = FrameSteps.of(plotter.renderer)
    steps.add(Step.CHANGES, fail)
    steps.add(Step.PASSES, recorder.before)
    plotter.render()
    steps.remove(fail)
    assert written == ["after"]
    assert "no values for this frame" in capfd.readouterr().err
