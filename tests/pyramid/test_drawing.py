"""Pictures of a pyramid in a store are those of the field; what is broken is told."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex import FlowField
from flowtex.cli import main
from flowtex.pyramid import build
from flowtex.scene.fields import share_field
from flowtex.scene.scene import Scene
from flowtex.textures.tiles.shared import has_pyramid

zarr = pytest.importorskip("zarr")

VIEW: dict[str, Any] = {"size": (200, 120), "focus": (3.2, 1.4), "samples": 9}


@pytest.fixture(autouse=True, scope="module")
def _small_roots(small_tiles: None) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1250)
        yield


@pytest.fixture(scope="module")
def flow() -> FlowField:
    y, x = np.mgrid[0:74, 0:134].astype(float) / 25
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1),
        velocity,
        valid=np.hypot(x - 1.3, y - 1.2) > 0.5,
        periodic="",
        scalars={"depth": x * y},
        units={"depth": "m"},
        length_unit="m",
    )


@pytest.fixture(scope="module")
def store(flow: FlowField, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("store") / "flow.zarr"
    build(flow, place, progress=False)
    return place


@pytest.mark.parametrize(
    ("zoom", "options"), [(1.0, {}), (12.0, {"scalars": "depth", "clim": "robust"})]
)
def test_pictures_are_those_of_the_field(
    opengl: Any, flow: FlowField, store: Path, zoom: float, options: dict[str, Any]
) -> None:
    pictures = [flowtex.render(one, zoom=zoom, **VIEW, **options) for one in (flow, str(store))]
    # Velocities are float32 in a store: single pixels may be rounded another way.
    away = pictures[0].astype(float) - pictures[1]
    assert np.sqrt(np.mean(away**2)) < 0.2
    assert pictures[0].std() > 10


def test_colours_are_those_of_the_whole_field(flow: FlowField, store: Path) -> None:
    scenes = [Scene.of(flow), Scene.of(store)]
    for name in ("speed", "depth"):
        for robust in (False, True):
            ends = [scene.scalar_range(name, robust=robust) for scene in scenes]
            assert ends[0] == ends[1]
    assert scenes[1].title_of("depth") == "depth (m)"
    assert share_field(scenes[1].field) is scenes[1].field


def test_a_broken_tile_leaves_the_coarser_one_and_is_told_once(
    opengl: Any, store: Path, tmp_path: Path
) -> None:
    store = Path(shutil.copytree(store, tmp_path / "flow.zarr"))
    for file in (store / "0" / "velocity" / "c").rglob("*"):
        if file.is_file():
            file.write_bytes(file.read_bytes()[:-100])
    with pytest.warns(
        UserWarning, match=r"coarse, because tile \(0, 0, 1\) .* 0/velocity of"
    ) as told:
        picture = flowtex.render(store, zoom=12, **VIEW)
    assert len({str(warning.message) for warning in told}) == len(told)
    assert picture.std() > 10


def test_the_shell_builds_tells_and_draws(
    opengl: Any, flow: FlowField, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import xarray as xr

    data = xr.Dataset(
        {
            name: (("y", "x"), flow.velocity[0, ..., axis], {"standard_name": f"sea_water_{long}"})
            for axis, (name, long) in enumerate(
                zip("uv", ("x_velocity", "y_velocity"), strict=True)
            )
        },
        {"x": flow.points[0, :, 0], "y": flow.points[:, 0, 1]},
    )
    data.to_netcdf(tmp_path / "flow.nc")
    store = tmp_path / "flow.zarr"
    assert main(["pyramid", str(tmp_path / "flow.nc"), "-o", str(store)]) == 0
    assert "3 levels" in capsys.readouterr().out
    again = ["--memory", "4GB", "--vectors", "u,v"]
    assert main(["pyramid", str(tmp_path / "flow.nc"), "-o", str(store), *again]) == 0
    assert "kept" in capsys.readouterr().out
    assert main(["info", str(store)]) == 0
    told = capsys.readouterr().out
    assert "134 × 74 nodes" in told and "complete" in told
    assert main(["render", str(store), "-o", str(tmp_path / "a.png"), "--size", "100x80"]) == 0
    assert (tmp_path / "a.png").exists()
    assert main(["render", str(store), "-o", str(tmp_path / "b.png"), "--plane", "k=0"]) == 2
    assert "plane applies to the source of a pyramid" in capsys.readouterr().err


def test_the_shell_shows_a_store_on_a_page(
    opengl: Any, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("trame")
    shown: list[Any] = []

    def serve(library: Any, *_: Any) -> int:
        shown.append(library)
        return 0

    monkeypatch.setattr("flowtex.cli.commands.FORKS", False)
    monkeypatch.setattr("flowtex.cli.show.serve_library", serve)
    monkeypatch.setattr("flowtex.rendering.diagnostics.has_display", lambda: False)
    assert main(["show", str(store)]) == 0
    (library,) = shown
    assert has_pyramid(library.source(library.names[0]).field())
