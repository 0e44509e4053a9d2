"""Pictures of the same numbers, one after the other."""

from __future__ import annotations

import gc
import importlib
import os
import warnings
import weakref
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from flows import swinging

import flowtex
from flowtex import FlowField, TraceSlices, examples
from flowtex.plotting.offscreen.plotter import OffscreenPlotter
from flowtex.scene.fields import kept_flows
from flowtex.scene.options import Options
from flowtex.scene.scene import make_scenes
from flowtex.sources.notices import DatasetNotice
from flowtex.trace import store

SMALL: dict[str, Any] = {"size": (64, 48), "samples": 3}


@pytest.fixture(autouse=True)
def _nothing_kept() -> None:
    kept_flows.clear()
    gc.collect()


@pytest.fixture
def traced(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of nodes that were traced."""
    counts: list[int] = []
    trace = importlib.import_module("flowtex.trace.trace").trace

    def counted(field: FlowField, **options: Any) -> Any:
        counts.append(field.valid.size)
        return trace(field, **options)

    monkeypatch.setattr(store, "trace", counted)
    return counts


@pytest.mark.usefixtures("opengl")
def test_a_mesh_is_traced_once_until_it_changes(traced: list[int]) -> None:
    mesh = examples.double_gyre()
    mesh["velocity"] = 1.25 * np.asarray(mesh["velocity"])  # as no other test draws it
    first = flowtex.render(mesh, **SMALL)
    again = flowtex.render(mesh.copy(), **SMALL)
    flowtex.render(mesh, zoom=2, **SMALL)
    assert np.array_equal(first, again)
    assert len(traced) == 1
    np.asarray(mesh["velocity"])[:, 0] *= -1  # PyVista does not see it
    assert not np.array_equal(first, flowtex.render(mesh, **SMALL))
    assert len(traced) == 2


@pytest.mark.usefixtures("opengl")
def test_what_is_kept_fits_into_some_memory(
    traced: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    fields = [examples.double_gyre_field(shape=(21, 25 + n)) for n in range(3)]
    flowtex.render(fields[0], **SMALL)
    monkeypatch.setattr(kept_flows, "max_bytes", int(1.5 * kept_flows.nbytes))
    flowtex.render(fields[1], **SMALL)
    flowtex.render(fields[1], **SMALL)
    assert len(kept_flows) == 1 and len(traced) == 2
    gone = weakref.ref(fields.pop(0))
    gc.collect()
    assert gone() is None


def thinned(dataset: Any) -> Any:
    """Every sixth line of a dataset of the Earth, and two of its times."""
    lines = ("longitude", "latitude", "lon", "lat")
    few = {"time": slice(2), **{name: slice(None, None, 6) for name in lines}}
    return dataset.isel(few, missing_dims="ignore")


@pytest.mark.usefixtures("opengl")
def test_a_file_that_is_written_anew_is_drawn_anew(tmp_path: Path, traced: list[int]) -> None:
    pytest.importorskip("xarray")
    path, dataset = tmp_path / "winds.nc", thinned(examples.weather())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DatasetNotice)
        dataset.to_netcdf(path)
        state = path.stat()
        first = flowtex.render(path, **SMALL)
        gc.collect()
        assert np.array_equal(first, flowtex.render(path, **SMALL)) and len(traced) == 1
        gc.collect()  # nobody holds it open
        # Of the same size, at the same time, and no other file.
        (dataset * dataset["longitude"] / 180).assign_attrs(dataset.attrs).to_netcdf(path)
        os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))
        assert not np.array_equal(first, flowtex.render(path, **SMALL))
    assert len(traced) == 2


@pytest.mark.usefixtures("opengl")
def test_what_is_kept_of_a_file_does_not_hold_it_open(tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DatasetNotice)
        thinned(examples.weather()).to_netcdf(tmp_path / "winds.nc")
        flowtex.render(tmp_path / "winds.nc", **SMALL)
    assert len(kept_flows) and all(isinstance(kept, TraceSlices) for kept in kept_flows.values())


def test_a_picture_of_one_moment_is_that_of_a_steady_flow() -> None:
    field = swinging()
    look: dict[str, Any] = {"size": (160, 120), "clim": (0, 1.5), "fade": 0.0}
    shot = flowtex.render(field, time=0.4, lines="streamlines", **look).astype(int)
    alone = flowtex.render(field.at_step(1), **look).astype(int)
    assert np.abs(shot - alone).mean() < 0.5
    moving = flowtex.render(field, time=0.4, lines="streamlines", motion="speed", **look)
    assert np.abs(moving - alone).mean() > 5


def faded(picture: Any) -> int:
    """Return how many pixels are even and neither an arrow's ink nor the surface beneath."""
    grey = picture.astype(int)[..., 0]
    around = np.lib.stride_tricks.sliding_window_view(grey, (3, 3)).reshape(*grey[2:, 2:].shape, 9)
    inner = grey[1:-1, 1:-1]
    return int(((np.ptp(around, axis=-1) < 4) & (inner > 40) & (inner < 140)).sum())


def test_arrows_are_opaque_or_absent() -> None:
    field = examples.double_gyre_field(shape=(21, 41))
    doubtful = np.linspace(0, 1.2, field.points[..., 0].size).reshape(field.shape)
    look: dict[str, Any] = {"scalars": False, "strength": 0.0, "samples": 3, "arrows": 40}
    views: list[dict[str, Any]] = [{"zoom": zoom} for zoom in (1, 1.2, 1.5, 1.8)]
    for view in (*views, {"uncertainty": doubtful}):
        options = Options.split(**look, **view)
        scenes = make_scenes(field, options)
        with closing(OffscreenPlotter(scenes, options.view, size=(320, 200))) as plotter:
            moving = plotter.picture()  # the frame of a movie
        still = flowtex.render(field, size=(320, 200), **look, **view)
        assert faded(still) == faded(moving) == 0
        assert (still < 40).mean() > 0.005
