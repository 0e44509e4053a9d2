"""What the picture shows, in figures: ``python benchmarks/quality.py [SECTION ...]``.

Sections are ``zoom`` (streaks and grain from the whole surface to a thousandth of it, beside
rlic on the image's own grid), ``aliasing`` (against 16 samples a pixel), ``camera`` (texture that
sticks to the surface, beside VTK's Surface LIC), ``cloud`` (evenness on a globe and the surfaces
of surfaces.py, beside Surface LIC), ``colours`` (of a map under the texture, beside Surface LIC),
``popping`` (a slow zoom), ``motion`` and ``vortices`` (frames carried by the flow), and ``seam``
(joined lines of nodes; needs ``FLOWTEX_DATA``). All with the settings' defaults. ``--json FILE``
keeps the figures.

``--judge FILE`` takes another judge of streaks, grain, aliasing and motion instead of
:mod:`flowtex.quality`: a module with the functions alignment, grain, aliasing and carried.
"""

from __future__ import annotations

import argparse
import json
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from scenes import (
    Stage,
    colour_lic,
    grid_of,
    gyre_field,
    gyre_view,
    lic_actor,
    stuart_field,
    stuart_view,
    vortex_view,
)
from scipy.ndimage import gaussian_filter
from seams import across_lines, seams

import flowtex
from flowtex import quality
from flowtex.rendering.diagnostics import require_opengl
from paper.blocks import block_means

Figures = dict[str, dict[str, float]]

SIZE = (1024, 768)
ZOOMS = (1, 1.41, 2, 4, 8, 16, 45, 64, 256, 512, 1024)
#: What measures the pictures; ``--judge`` puts another in its place.
JUDGE = SimpleNamespace(
    streaks=lambda *given: quality.alignment(*given)._asdict(),
    grain=lambda *given: quality.grain(*given)._asdict(),
    aliasing=quality.aliasing,
    carried=quality.sticking,
)
CLOUD_NODES = 20_000  #: Nodes of the surfaces of which clouds are measured.
CLOUD_SIZE = (640, 480)  #: Pixels of their pictures.
CLOUD_NOISES = 8  #: Pictures of each.
CLOUD_MOVE = 5.0  #: Pixels from one to the next.
COLOUR_MAPS = ("viridis", "RdBu_r", "turbo", "magma", "cividis")
NEAR_WHITE = 230  #: Least value of the channels of a pixel that looks white.
#: Seconds from one frame of an animation to the next.
FRAME = 1 / 30


def zoom() -> Figures:
    """Streaks and grain over a thousandfold zoom; rlic with two passes at some of the views."""
    import rlic

    field, found = gyre_field(), {}
    for z in ZOOMS:
        view = gyre_view(field, z, SIZE)
        picture = flowtex.render(field, scalars=False, **view.options)
        found[f"flowtex, zoom {z:g}"] = _all(picture, view)
        if z in (1, 4, 64, 1024):
            noise = np.random.default_rng(0).random(view.u.shape)
            passes = rlic.convolve(noise, view.u, -view.v, kernel=np.ones(25), iterations=2)
            found[f"rlic 2 x 25, zoom {z:g}"] = _all(255 * passes / 625, view)
    return found


def stuart() -> Figures:
    """Streaks and grain around a vortex of Stuart's row over a thousandfold zoom."""
    field = stuart_field(SIZE)
    found = {}
    for z in ZOOMS:
        view = stuart_view(z, SIZE)
        picture = flowtex.render(field, scalars=False, **view.options)
        found[f"flowtex, zoom {z:g}"] = _all(picture, view)
    return found


def _all(picture: Any, view: Any) -> dict[str, float]:
    figures = JUDGE.streaks(picture, view.u, view.v, view.mask)
    return {
        **figures,
        **JUDGE.grain(picture, view.u, view.v, view.mask),
        "cloud": quality.cloud(picture, view.mask),
        "deviation": float(np.asarray(picture, float).mean(axis=-1)[view.mask].std())
        if np.ndim(picture) == 3
        else float(picture[view.mask].std()),
    }


def clouds() -> Figures:
    """Evenness on planes, bodies and a globe, without light; Surface LIC at the same views.

    Each figure is a mean over some noises, as a small surface has few grains: those of flowtex
    have other seeds, and the view moves a little, because Surface LIC's stay on the screen.
    """
    from peers import LIC, OURS
    from surfaces import GRIDS, TRIANGLES

    found: Figures = {}
    for name, make in (GRIDS | TRIANGLES).items():
        mesh = make(CLOUD_NODES)
        field = flowtex.FlowField.from_pyvista(mesh)
        found[f"{name}, {OURS}"] = _evenness(field)
        found[f"{name}, {LIC}"] = _evenness(field, mesh)
    globe = flowtex.FlowField.from_xarray(flowtex.examples.weather(), level=250, globe=True)
    found[f"globe, {OURS}"] = _evenness(globe)
    found[f"globe, {LIC}"] = _evenness(globe, grid_of(globe))
    return found


def _evenness(field: flowtex.FlowField, mesh: Any = None) -> dict[str, float]:
    """Measure pictures of a field, or of its mesh by Surface LIC."""
    import pyvista as pv
    from camera_moves import pan
    from surfaces import surface_view

    from flowtex.rendering.camera import apply_camera, read_camera

    plotter: Any = pv.Plotter(off_screen=True, window_size=list(CLOUD_SIZE))
    plotter.set_background("white")
    if mesh is None:
        options: dict[str, Any] = {}
        if field.projection is not None:
            options = {"coastlines": False, "graticule": False}
        settings = plotter.flowtex.add(field, scalars=False, **options).settings
    else:
        settings = SimpleNamespace()
        plotter.add_actor(lic_actor(mesh.extract_surface(algorithm="dataset_surface")))
    for actor in plotter.renderer.GetActors():  # shadows are no clouds
        actor.GetProperty().SetAmbient(1.0)
        actor.GetProperty().SetDiffuse(0.0)
    flat = np.ptp(field.points[..., 2]) == 0
    plotter.camera_position = "xy" if flat else "iso"
    plotter.reset_camera(render=False)
    middle = read_camera(plotter.camera)
    rows = []
    for seed in range(CLOUD_NOISES):
        settings.seed = seed
        aside = (seed - CLOUD_NOISES // 2) * CLOUD_MOVE / CLOUD_SIZE[1]
        camera = pan(middle, aside, 0.0, 1.0)
        apply_camera(camera, plotter.camera)
        plotter.renderer.ResetCameraClippingRange()
        plotter.render()
        picture = np.asarray(plotter.screenshot(return_img=True))
        view = surface_view(field, camera, CLOUD_SIZE)
        streaks = JUDGE.streaks(picture, view.u, view.v, view.mask)
        rows.append({**streaks, "cloud": quality.cloud(picture, view.mask)})
    plotter.close()
    return {name: float(np.mean([row[name] for row in rows])) for name in rows[0]}


def colours() -> Figures:
    """Colours of five maps under the texture, over the plain ones; and by Surface LIC."""
    field = gyre_field()
    found: Figures = {}
    for name in COLOUR_MAPS:
        plain = flowtex.render(field, cmap=name, size=CLOUD_SIZE, zoom=2.0, strength=0.0)
        drawn = flowtex.render(field, cmap=name, size=CLOUD_SIZE, zoom=2.0)
        found[f"{name}, flowtex"] = _kept(drawn, plain)
        stage = Stage(field, CLOUD_SIZE, surface_lic=True)
        for way, mode in (("blended", 0), ("multiplied", 1)):
            colour_lic(stage.plotter, name, mode)
            found[f"{name}, Surface LIC {way}"] = _kept(stage.picture(zoom=2.0), plain)
        stage.close()
    return found


def _kept(picture: Any, plain: Any) -> dict[str, float]:
    """Return how colours differ from plain ones, by CIELAB, in the middle of a picture."""
    inner = (slice(60, -60), slice(60, -60))
    drawn = _cielab(np.asarray(picture)[inner])
    expected = _cielab(np.asarray(plain)[inner])
    chroma = np.hypot(drawn[..., 1], drawn[..., 2])
    expected_chroma = np.hypot(expected[..., 1], expected[..., 2])
    blurred = gaussian_filter(drawn - expected, (quality.CLOUD_PIXELS, quality.CLOUD_PIXELS, 0))
    white = (np.asarray(picture)[inner].min(axis=-1) > NEAR_WHITE).mean()
    return {
        "chroma kept": float(chroma.sum() / expected_chroma.sum()),
        "difference of means": float(np.linalg.norm(blurred, axis=-1).mean()),
        "near white, %": 100 * float(white),
        "deviation of lightness": float((drawn - expected)[..., 0].std()),
    }


def _cielab(picture: Any) -> Any:
    """Return L*, a* and b* of a picture, (H, W, 3), by the standard's formulas."""
    colour = picture / 255.0
    linear = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    xyz = linear @ to_xyz.T / to_xyz.sum(axis=1)
    x, y, z = np.moveaxis(np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116), -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def aliased() -> Figures:
    """Error against 16 samples a pixel, 16 and 64 times out from where a grain is one pixel."""
    field, size, found = gyre_field(), (640, 480), {}
    for out, z in ((16, 1.0), (64, 0.25)):
        view = gyre_view(field, z, size)
        extent = field.surface.extent / view.pixel * z
        for lod in (True, False):
            options = {**view.options, "lod": lod, "resolution": int(extent * 16 / 1.5)}
            grains = flowtex.Settings().grain
            picture = flowtex.render(field, scalars=False, **options)
            options["size"] = (4 * size[0], 4 * size[1])
            large = flowtex.render(field, scalars=False, grain=4 * grains, **options)
            error = JUDGE.aliasing(
                picture, block_means(np.asarray(large, float).mean(axis=-1), 4), view.mask
            )
            found[f"zoomed out {out} times, lod={lod}"] = {"error": error}
    return found


def camera() -> Figures:
    """Texture carried by the camera's motion; Surface LIC at the same views."""
    field = gyre_field()
    found: Figures = {}
    for who, settings in (("flowtex", {}), ("VTK Surface LIC", {"surface_lic": True})):
        stage = Stage(field, SIZE, **settings)
        for z in (1.5, 8.0, 64.0):
            view = gyre_view(field, z, SIZE)
            here = {"zoom": z, "focus": view.options["focus"]}
            mask = _away_from_border(view.mask, 40)
            first = stage.picture(**here)
            found[f"{who}, zoom {z:g}"] = {
                name: JUDGE.carried(first, stage.picture(**{**here, **there}), dx, dy, mask)
                for name, (dx, dy, there) in _moves(view).items()
            }
        stage.close()
    return found


def popping() -> Figures:
    """Correlation from frame to frame of a zoom by 2 % a frame, over more than an octave."""
    field, size = gyre_field(), (400, 300)
    stage = Stage(field, size)
    rows, columns = np.indices(size[::-1])
    right, down = columns + 0.5 - size[0] / 2, rows + 0.5 - size[1] / 2
    scores, before = [], None
    for frame in range(40):
        view = gyre_view(field, 4 * 1.02**frame, size)
        here = {"zoom": view.options["zoom"], "focus": view.options["focus"]}
        picture = stage.picture(**here)
        if before is not None:
            mask = _away_from_border(view.mask, 20)
            moved = 1 - 1 / 1.02
            scores.append(JUDGE.carried(before, picture, right * moved, down * moved, mask))
        before = picture
    stage.close()
    return {"zoom 4 to 8.7": {"least": min(scores), "mean": float(np.mean(scores))}}


def _away_from_border(mask: Any, pixels: int) -> Any:
    inner = np.zeros_like(mask)
    inner[pixels:-pixels, pixels:-pixels] = mask[pixels:-pixels, pixels:-pixels]
    return inner


def streaming() -> Figures:
    """Follow the streaming of a steady flow, thirty frames a second."""
    found: Figures = {}
    field = gyre_field()
    for motion in ("uniform", "speed"):
        stage = Stage(field, SIZE, motion=motion)
        pixels = stage.handle.settings.speed * FRAME
        for z in (1.0, 8.0):
            view = gyre_view(field, z, SIZE)
            speed = np.hypot(view.u, view.v)
            typical = np.sqrt(np.mean(field.speed**2)) if motion == "speed" else speed
            dx, dy = pixels * view.u / typical, -pixels * view.v / typical
            here = {"zoom": z, "focus": view.options["focus"]}
            found[f"{motion}, zoom {z:g}"] = _frames(
                stage, here, dx, dy, view, "clock", (1.3, FRAME)
            )
        stage.close()
    return found


def vortices() -> Figures:
    """Follow the vortices, which vary in time, at thirty frames for each step of the data."""
    field = flowtex.examples.vortex_field()
    size = (768, 768)
    found: Figures = {}
    stage = Stage(field, size)
    step = float(field.times[11] - field.times[10])
    frame, moment = step * FRAME, float(field.times[10]) + 0.4 * step
    for z in (1.0, 6.0):
        view = vortex_view(field, z, size, step=10, late=0.4)
        dx, dy = view.u * frame / view.pixel, -view.v * frame / view.pixel
        found[f"vortices, zoom {z:g}"] = _frames(
            stage, view.options, dx, dy, view, "time", (moment, frame)
        )
    stage.close()
    return found


def seam() -> Figures:
    """Change across a joined line of nodes over that across the lines beside it."""
    found: Figures = {}
    for name, (field, looks) in seams().items():
        for look_name, options in looks.items():
            picture = flowtex.render(field, size=SIZE, scalars=False, lighting=False, **options)
            found[f"{name}, {look_name}"] = across_lines(field, picture, options, SIZE)
    return found


def _frames(
    stage: Any, here: Any, dx: Any, dy: Any, view: Any, name: str, moment: tuple[float, float]
) -> dict[str, float]:
    first = stage.picture(**here, **{name: moment[0]})
    second = stage.picture(**here, **{name: moment[0] + moment[1]})
    still = np.zeros_like(dx)
    return {
        "carried": JUDGE.carried(first, second, dx, dy, view.mask),
        "not carried": JUDGE.carried(first, second, still, still, view.mask),
        **_all(second, view),
        "pixels a frame": float(np.hypot(dx, dy)[view.mask].mean()),
    }


def _moves(view: Any) -> dict[str, tuple[Any, Any, dict[str, Any]]]:
    """Displacement of each pixel since the frame before, and the view after, by kind of motion."""
    rows, columns = np.indices(view.x.shape)
    right, down = columns + 0.5 - SIZE[0] / 2, rows + 0.5 - SIZE[1] / 2
    turn, z, focus = np.radians(1.0), view.options["zoom"], view.options["focus"]
    still = np.zeros(view.x.shape)
    return {
        "pan 3 px": (still + 3.0, still, {"focus": (focus[0] - 3 * view.pixel, focus[1])}),
        "zoom 1 %": (right * (1 - 1 / 1.01), down * (1 - 1 / 1.01), {"zoom": z * 1.01}),
        "turn 1 deg": (
            right - (np.cos(turn) * right + np.sin(turn) * down),
            down - (-np.sin(turn) * right + np.cos(turn) * down),
            {"roll": -1.0},
        ),
    }


SECTIONS = {
    "zoom": zoom,
    "stuart": stuart,
    "aliasing": aliased,
    "camera": camera,
    "cloud": clouds,
    "colours": colours,
    "popping": popping,
    "motion": streaming,
    "vortices": vortices,
    "seam": seam,
}


def use_judge(path: Path) -> None:
    """Measure with the functions of a module from now on."""
    spec = spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        msg = f"{path} is no Python module"
        raise SystemExit(msg)
    judge = module_from_spec(spec)
    spec.loader.exec_module(judge)

    def streaks(*given: Any) -> dict[str, float]:
        found = judge.alignment(*given)
        return {"angle": found["mean_deg"], "coherence": found["coherence"]}

    def grain(*given: Any) -> dict[str, float]:
        found = judge.grain(*given)
        return {"along": found["along_px"], "across": found["across_px"]}

    JUDGE.streaks, JUDGE.grain = streaks, grain
    JUDGE.aliasing, JUDGE.carried = judge.aliasing, judge.carried


def main() -> None:
    """Measure the sections that were requested and print a table of each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sections", nargs="*", choices=[*SECTIONS, []], default=[])
    parser.add_argument("--json", type=Path, help="file to keep the figures in")
    parser.add_argument("--judge", type=Path, help="module that measures instead of our own")
    arguments = parser.parse_args()
    if arguments.judge:
        use_judge(arguments.judge)
    console, kept = Console(), {}
    console.print(f"[bold]{require_opengl().renderer}[/]")
    for name in arguments.sections or SECTIONS:
        kept[name] = SECTIONS[name]()
        columns = list(dict.fromkeys(c for row in kept[name].values() for c in row))
        table = Table(name, *columns)
        for label, row in kept[name].items():
            table.add_row(label, *(f"{row[c]:.3f}" if c in row else "" for c in columns))
        console.print(table)
    if arguments.json:
        arguments.json.write_text(json.dumps(kept, indent=1))


if __name__ == "__main__":
    main()
