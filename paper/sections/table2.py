"""Table 2: preprocessing, texture creation and loading, and frames a second."""

from __future__ import annotations

import time
from typing import Any

from flowtex.field import FlowField
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import trace
from paper.bench import PAPER, Bench
from paper.findings import Block, Claim, Finding, Section, Table, Text

#: Seconds of preprocessing, and of texture creation and loading, as the paper has them.
PUBLISHED = {"post": (2.312, 0.08), "shuttle": (3.172, 0.077), "vortex": (8.875, 0.24)}
#: Seconds that count as a few, and as slightly more; frames a second that count as several hundred.
FEW_S, MORE_S, HUNDREDS_PER_S = 5.0, 15.0, 200.0
#: Width and height of the picture whose frames are timed.
PICTURE_SIZE = (512, 512)


def _clock(do: Any) -> tuple[float, Any]:
    start = time.perf_counter()
    result = do()
    return time.perf_counter() - start, result


def _timed(bench: Bench, name: str, field: FlowField) -> dict[str, float]:
    """Time tracing, textures, and drawing where VTK can draw."""
    seconds, slices = _clock(lambda: trace(field, two_sided=False, progress=False))
    figures = {"preprocessing": seconds, "slices_mb": slices.displacement.nbytes / 1024**2}
    store = SliceStore(field, slices=slices)

    def textures() -> None:
        NoiseTextures.of(store, 512, bench.seed)
        TextureSet.build(store).layers(store.steps - 1)

    figures["textures"], _ = _clock(textures)
    # Drawing without a graphics card is slow: the quick form draws one of the data sets.
    with_frames = bench.pick(True, name == "shuttle")  # noqa: FBT003 - either of two values
    return figures | (_frame_times(bench, field, slices) if with_frames else {})


def _frame_times(bench: Bench, field: FlowField, slices: Any) -> dict[str, float]:
    """Time the first frame, which loads the textures, and the next; nothing without OpenGL."""
    from flowtex.rendering.diagnostics import opengl_report, prefer_headless

    prefer_headless()
    if not opengl_report().usable:
        return {}
    import pyvista as pv

    from flowtex.plotting.component import point_camera
    from flowtex.plotting.handle import FlowHandle
    from flowtex.scene.options import Appearance
    from flowtex.scene.scene import Scene

    plotter: Any = pv.Plotter(off_screen=True, window_size=list(PICTURE_SIZE))
    try:
        plotter.disable_anti_aliasing()
        grey = Appearance.of(scalars=False, color="grey")
        scene = Scene(field, bench.settings(**PAPER), grey, slices=slices)
        point_camera(plotter, field.surface)
        plotter.render()
        handle = FlowHandle(plotter, scene, lambda _: None)
        point_camera(plotter, field.surface)
        first, _ = _clock(plotter.screenshot)
        frames = bench.pick(12, 4)

        def turn() -> None:
            for _ in range(frames):
                plotter.camera.zoom(1.01)
                plotter.render()

        seconds, _ = _clock(turn)
        handle.remove(render=False)
    finally:
        plotter.close()
    return {"first_frame": first, "frames_a_second": frames / seconds}


def _table2(bench: Bench) -> Finding:
    from flowtex.rendering.diagnostics import opengl_report

    flows = {"post": bench.post, "shuttle": bench.shuttle}
    # All steps of the whole vortex field take ten seconds; the quick form takes every fourth node.
    flows["vortex"] = bench.pick(bench.vortex, bench.vortex.downsample(4))
    timings = {name: _timed(bench, name, f) for name, f in flows.items() if f is not None}
    rows = [
        (
            name,
            *PUBLISHED[name],
            row["preprocessing"],
            row["textures"],
            row.get("first_frame"),
            row.get("frames_a_second"),
        )
        for name, row in timings.items()
    ]
    head = (
        "data",
        "preprocessing, paper, s",
        "textures, paper, s",
        "preprocessing, s",
        "textures, s",
        "first frame, s",
        "frames a second",
    )
    renderer = opengl_report().renderer if opengl_report().usable else ""
    drawing = (
        f"Drawn at 512 × 512 pixels by: {renderer}."
        if renderer
        else "Nothing could be drawn: no OpenGL."
    )
    caption = f"Times of this run. {drawing} The paper's: Pentium 4 at 2 GHz, GeForce 6800 GT."
    size = "The quick form takes every fourth node of the vortex field." if bench.quick else ""
    blocks: list[Block] = [Table(head, rows, caption), *([Text(size)] if size else [])]
    return Finding(
        blocks, {"published": PUBLISHED}, _claims(timings), {**timings, "renderer": renderer}
    )


def _claims(timings: dict[str, dict[str, float]]) -> list[Claim]:
    claims = [
        Claim(
            f"table2_{name}_preprocessing",
            f"Table 2, {name}: preprocessing takes "
            f"{'slightly more than ' if name == 'vortex' else ''}a few seconds.",
            row["preprocessing"],
            MORE_S if name == "vortex" else FEW_S,
            "at most",
            "s",
            timed=True,
        )
        for name, row in timings.items()
    ]
    rates = [row["frames_a_second"] for row in timings.values() if "frames_a_second" in row]
    if rates:
        claims.append(
            Claim(
                "frame_rate",
                "Section 5: advecting and drawing exceeds several hundred frames a second (the "
                "paper's on a graphics card; the slowest of the data sets, on this machine).",
                min(rates),
                HUNDREDS_PER_S,
                "at least",
                "frames a second",
                timed=True,
            )
        )
    return claims


SECTIONS = [
    Section(
        "table2",
        "Table 2: preprocessing, textures, frames",
        "Section 5, table 2",
        "Preprocessing takes 2.3 s for the post, 3.2 s for the shuttle and 8.9 s for the vortex; "
        "creating and loading textures 0.08 to 0.24 s. After that several hundred frames are "
        "drawn in a second.",
        "Backward traces of every node and all time steps, in NumPy; the paper's noise of 512 "
        "texels with its mip levels, and the slices laid into texels; the first frame, which "
        "builds the shader and loads the textures; frames of a slow zoom, with ten contributions "
        "of noise in space. All of it depends on the machine.",
        _table2,
    )
]
