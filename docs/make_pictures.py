"""Draw the pictures of the README and of ``docs/gallery.md``: ``make gallery``."""

from __future__ import annotations

import contextlib
import io
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from PIL import Image, ImageOps

import flowtex
from flowtex.plotting.component import point_camera
from flowtex.scene.options import ViewOptions

#: Address of a page as it is announced.
ADDRESS = re.compile(r"http://\S+")
FOLDER = Path(__file__).parent / "pictures"
Picture = NDArray[np.uint8]
DARK = "#10131a"
#: Frames of a moving picture, and how long each is shown, in milliseconds.
FRAMES, SHOWN = 40, 50


def wake() -> Picture:
    """Draw vortex shedding behind a cylinder, the README's picture."""
    return flowtex.render(
        flowtex.examples.cylinder_field(), size=(1200, 420), zoom=4.4, focus=(4.0, 0.0)
    )


def zooms() -> Picture:
    """Draw the nose of an airfoil from afar and from near, and nearer than a cell is long."""
    field = flowtex.examples.airfoil_field()
    nose = field.points[np.unravel_index(np.argmax(field.speed[0]), field.shape)][:2]
    middle = tuple(field.surface.center[:2])
    views = [(1.0, middle), (16.0, nose), (256.0, nose), (4096.0, nose)]
    return _row([flowtex.render(field, size=(300, 400), zoom=z, focus=tuple(p)) for z, p in views])


def critical() -> Picture:
    """Draw four critical points, between the nodes of 40 by 40, from ever nearer."""
    points = np.stack(np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 40)), axis=-1)
    place = np.array([19.87, 19.29]) / 39
    saddle, centre = [[1, 0.3], [0.2, -1]], [[0.1, -1], [1.3, -0.1]]
    node, focus = [[-1, 0.3], [0.1, -0.6]], [[-0.4, -1], [1, -0.3]]
    common: dict[str, Any] = {"size": (194, 194), "scalars": False, "focus": tuple(place)}
    rows = []
    for flow in (saddle, centre, node, focus):
        field = flowtex.FlowField.from_arrays(points, (points - place) @ np.transpose(flow))
        rows.append(_row([flowtex.render(field, zoom=4.0**n, **common) for n in range(6)]))
    return np.swapaxes(_row([np.swapaxes(row, 0, 1) for row in rows]), 0, 1)


def vortices() -> Picture:
    """Draw decaying turbulence at two moments."""
    field = flowtex.examples.vortex_field()
    times = [field.times[10], field.times[-1]]
    return _row(
        [flowtex.render(field, size=(600, 600), time=float(t), cmap="magma") for t in times]
    )


def torus() -> Picture:
    """Draw a flow on a torus, from outside and along its inner side."""
    turn, around = np.meshgrid(np.linspace(0, 2 * np.pi, 161), np.linspace(0, 2 * np.pi, 81))
    out = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
    up = np.array([0.0, 0.0, 1.0])
    ring = 1 + 0.42 * np.cos(around)[..., None]
    points = ring * out + 0.42 * np.sin(around)[..., None] * up
    along = np.stack([-np.sin(turn), np.cos(turn), 0 * turn], axis=-1)
    across = -np.sin(around)[..., None] * out + np.cos(around)[..., None] * up
    flow = (1 + 0.5 * np.sin(3 * around + turn))[..., None] * along
    flow += (0.6 * np.cos(2 * turn))[..., None] * across
    field = flowtex.FlowField.from_arrays(points, flow)
    near = [(1.9, 0.0, 0.75), (0.9, 0.0, 0.3), (0.0, 0.0, 1.0)]
    return _row(
        [
            flowtex.render(field, size=(640, 460), background=DARK),
            flowtex.render(field, size=(550, 460), camera=near),
        ]
    )


def sphere() -> Picture:
    """Draw a wind on a sphere across the seam and, from above, across a pole."""
    longitude, latitude = np.meshgrid(np.linspace(0, 360, 181), np.linspace(-90, 90, 91))
    a, b = np.radians(longitude), np.radians(latitude)
    east = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
    north = np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
    points = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)
    u = 0.8 * np.cos(b) + 0.8 * np.sin(3 * b) * np.cos(2 * a) * np.cos(b)
    v = 0.7 * np.cos(b) * np.sin(4 * a + 2 * b)
    # A wind across the pole: a turn of the whole sphere about an axis in its equator.
    turn = np.cross([0.0, 0.9, 0.0], points)
    wind = u[..., None] * east + v[..., None] * north + turn
    field = flowtex.FlowField.from_arrays(points, wind)
    above = [(0.4, 0.25, 4.2), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    common: dict[str, Any] = {"size": (596, 560), "cmap": "turbo", "background": DARK}
    return _row(
        [
            flowtex.render(field, **common),
            flowtex.render(field, **common, camera=above),
        ]
    )


def globe() -> Picture:
    """Draw the jets on the globe, over the Atlantic and over the Pacific."""
    winds = flowtex.FlowField.from_xarray(flowtex.examples.weather(), level=250, globe=True)
    common: dict[str, Any] = {"size": (596, 560), "zoom": 1.3, "background": DARK}
    positions = winds.projection.positions(np.array([-40.0, 150.0]), np.array([35.0, 50.0]))
    return _row([flowtex.render(winds, **common, cmap="turbo", focus=tuple(p)) for p in positions])


def cartopy() -> Picture:
    """Draw winds on four projections of cartopy."""
    import cartopy.crs as ccrs
    import matplotlib.pyplot as plt

    winds = flowtex.examples.weather().sel(level=250)
    maps = (
        ccrs.Robinson(150),
        ccrs.Orthographic(10, 50),
        ccrs.LambertConformal(),
        ccrs.InterruptedGoodeHomolosine(),
    )
    figure = plt.figure(figsize=(12, 7), layout="constrained", dpi=100)
    for number, projection in enumerate(maps, 1):
        ax: Any = figure.add_subplot(2, 2, number, projection=projection)
        image = flowtex.axes(ax, winds, clim=(0, 70), samples=25)
        ax.gridlines(linewidth=0.3, color="k")
        ax.set_title(type(projection).__name__)
    figure.colorbar(image, ax=figure.axes, label=image.colour_label, shrink=0.6)
    return _drawn(figure)


def polar() -> Picture:
    """Draw a stream past a cylinder on polar axes, with the arrows of quiver."""
    import matplotlib.pyplot as plt

    angle, radius = np.linspace(0, 2 * np.pi, 97), np.linspace(0.5, 2, 41)
    a, r = np.meshgrid(angle, radius)
    u, v = -(1 + 0.25 / r**2) * np.sin(a), (1 - 0.25 / r**2) * np.cos(a)
    field = flowtex.FlowField.from_arrays((angle, radius), np.stack([u, v], axis=-1))
    figure, both = plt.subplots(1, 2, figsize=(9, 4), subplot_kw={"projection": "polar"})
    both[1].set(theta_zero_location="N", theta_direction=-1, rorigin=-0.5)
    few = slice(2, None, 6), slice(None, -1, 8)
    for ax in both:
        flowtex.axes(ax, field)
        ax.quiver(a[few], r[few], (u / r)[few], v[few], angles="xy", color="w")
        ax.set_rticks([1, 2])
    return _drawn(figure)


def ocean() -> Picture:
    """Draw the Gulf Stream and its rings, with the land and the scale."""
    currents = flowtex.FlowField.from_xarray(flowtex.examples.ocean())
    middle = tuple(currents.projection.positions(-64.0, 37.2)[:2])
    return flowtex.render(
        currents, size=(1200, 600), zoom=1.4, focus=middle, cmap="magma", annotations=True, time=0.0
    )


def level_of_detail() -> Picture:
    """Draw the airfoil with level of detail, and without it."""
    return flowtex.render(
        flowtex.examples.airfoil_field(),
        size=(1200, 480),
        zoom=0.8,
        scalars=False,
        resolution=4096,
        beside={"lod": False},
    )


def grain() -> Picture:
    """Draw the double gyre with grain fixed on the screen, and fixed on the surface."""
    return flowtex.render(
        flowtex.examples.double_gyre_field(),
        size=(1200, 480),
        zoom=5,
        focus=(0.62, 0.4),
        resolution=512,
        beside={"fixed_grain": True},
    )


def levels() -> Picture:
    """Draw a plane seen at a grazing angle, and which level of detail each pixel has."""
    return flowtex.render(
        flowtex.examples.double_gyre_field(),
        size=(1200, 330),
        camera=[(1.0, -0.16, 0.14), (1.0, 0.22, 0.0), (0.0, 0.0, 1.0)],
        beside={"show_level": True},
    )


def kernels() -> Picture:
    """Draw the three kernels; the ramp shows the direction in a still."""
    field = flowtex.examples.double_gyre_field()
    common: dict[str, Any] = {"size": (395, 395), "zoom": 2.2, "focus": (0.5, 0.5)}
    kinds: list[dict[str, Any]] = [
        {"kernel": "hann"},
        {"kernel": "box"},
        {"kernel": "ramp", "grain": 4.0, "contrast": 1.4},
    ]
    return _row([flowtex.render(field, **common, **kind) for kind in kinds])


def arrows() -> Picture:
    """Draw arrows along the paths of a wake, of winds, and by the speed of vortices."""
    common: dict[str, Any] = {"size": (395, 300)}
    winds = {"level": 250, "globe": True, "cmap": "turbo"}
    return _row(
        [
            flowtex.render(
                flowtex.examples.cylinder(), zoom=9, focus=(2.0, 0.0), arrows=34, **common
            ),
            flowtex.render(flowtex.examples.weather(), arrows=34, **winds, **common),
            flowtex.render(
                flowtex.examples.vortex(), arrows=34, arrow_length="speed", zoom=2, **common
            ),
        ]
    )


def structure() -> Picture:
    """Mark critical points and separatrices of a pendulum, of currents and of winds."""
    common: dict[str, Any] = {"size": (395, 300), "supersampling": 2, "show_scalar_bar": False}
    common |= {"critical_points": True, "separatrices": True, "strength": 0.6}
    pendulum = flowtex.formula("y", "-sin(x) - b*y", x=(-5, 5), y=(-3.6, 3.6), b=0.2)
    ocean = flowtex.examples.ocean().isel(time=-1)
    ocean = ocean.sel(latitude=slice(33, 43), longitude=slice(-70, -57))
    winds = {"level": 250, "globe": True, "cmap": "turbo"}
    return _row(
        [
            flowtex.render(pendulum, **common),
            flowtex.render(ocean, **{**common, "separatrices": 12}, coastlines=False),
            flowtex.render(flowtex.examples.weather(), **winds, **common),
        ]
    )


def patterns() -> Picture:
    """Draw what the flow makes of a checkerboard and of a picture with dye."""
    field = flowtex.examples.double_gyre_field()
    common: dict[str, Any] = {"size": (595, 315)}
    plain: dict[str, Any] = {"scalars": False, "color": "#f4f4f4"}
    rows, columns = np.mgrid[0:200, 0:400]
    dye = np.zeros((200, 400, 4))
    for centre, colour in ((60, (0.85, 0.1, 0.2)), (200, (0.1, 0.45, 0.9)), (330, (1.0, 0.7, 0.1))):
        inside = np.hypot(rows - 100, columns - centre) < 34
        dye[inside] = (*colour, 1.0)
    board = np.indices((8, 16)).sum(axis=0) % 2 * 1.0
    return _row(
        [
            flowtex.render(field, **common, image=board, samples=25),
            flowtex.render(field, **common, image=dye, kernel="ramp", samples=120, **plain),
        ]
    )


def half_turns() -> Picture:
    """Draw a field without a sign around singularities of half a turn, as such and as vectors."""
    y, x = np.mgrid[-1:1:81j, -2:2:161j]
    angle = np.zeros(x.shape)
    for a, b, turn in ((-1.1, 0.1, 0.5), (0.2, -0.3, -0.5), (1.2, 0.3, 0.5)):
        angle += turn * np.arctan2(y - b, x - a)
    points = np.stack([x, y], -1)
    axes = np.stack([np.cos(angle), np.sin(angle)], -1)
    common: dict[str, Any] = {"size": (596, 320), "color": "#b0a080", "scalars": False}
    fields = [flowtex.FlowField.from_arrays(points, axes, sign_free=free) for free in (True, False)]
    return _row([flowtex.render(field, **common) for field in fields])


def gyre() -> Picture:
    """Draw the double gyre in grey, for print."""
    return flowtex.render(
        flowtex.examples.double_gyre_field(), size=(1200, 620), scalars=False, color="#909090"
    )


def streaming() -> list[Picture]:
    """Draw one period of the streaming of a steady flow, which closes into a loop."""
    plotter: Any = pv.Plotter(off_screen=True, window_size=[480, 260])
    plotter.set_background("white")
    field = flowtex.examples.airfoil_field()
    handle = plotter.flowtex.add(
        field, motion="speed", speed=26.0, period=2.0, show_scalar_bar=False
    )
    point_camera(plotter, field.surface, ViewOptions(zoom=9.0, focus=(0.5, 0.0)))
    frames = []
    for frame in range(FRAMES):
        handle.clock = 2.0 * frame / FRAMES
        frames.append(np.asarray(plotter.screenshot(return_img=True)))
    plotter.close()
    return frames


#: Pictures of docs/paper.md: sections of ``make paper``, and the files that each is made of.
PAPER = {
    "figure5": ("pictures/figure5-1-1", "pictures/figure5-1-2", "pictures/figure5-1-3"),
    "figure6": ("pictures/figure6-3-1", "pictures/figure6-4-1", "pictures/figure6-4-2"),
    "figure3": ("plots/figure3-1",),
    "zooms": ("plots/zooms-1",),
    "moving": ("plots/moving-2",),
}


def paper() -> None:
    """Draw the pictures of docs/paper.md, which `make paper` has on its page."""
    from paper import reproduce

    with TemporaryDirectory() as made:
        reproduce(made, only=tuple(PAPER), progress=False)
        for name, files in PAPER.items():
            if files[0].startswith("plots"):
                text = Path(made, f"{files[0]}.svg").read_text(encoding="utf-8")
                (FOLDER / f"paper_{name}.svg").write_text(text, encoding="utf-8")
                continue
            parts = [np.asarray(Image.open(Path(made, f"{file}.jpg"))) for file in files]
            Image.fromarray(_row(parts)).save(
                FOLDER / f"paper_{name}.jpg", quality=82, optimize=True
            )


def app() -> None:
    """Take the pictures of docs/app.md: the page in a browser, as people see it."""
    from playwright.sync_api import Page, sync_playwright

    def settle(page: Page) -> None:
        page.wait_for_timeout(900)  # hints fade
        page.wait_for_function(
            "() => document.querySelector('.flowtex[data-sharp]') &&"
            " !document.querySelector('.flowtex[data-sharp=false]')"
        )
        page.wait_for_timeout(900)

    def opened(size: tuple[int, int], name: str, address: str) -> Page:
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.set_default_timeout(180_000)
        page.goto(address)
        settle(page)
        if name != "cylinder":
            page.get_by_label("Open another file").click()
            page.locator(".v-overlay--active .v-list-item", has_text=name).click()
            page.get_by_text("161 × 65 nodes").wait_for(state="hidden")
            settle(page)
        return page

    command = [sys.executable, "-m", "flowtex", "demo", "--no-browser", "--port", "0"]
    with (
        subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as served,
        contextlib.ExitStack() as ends,
        sync_playwright() as playwright,
    ):
        ends.callback(served.terminate)
        address = next(m.group() for line in served.stdout or () if (m := ADDRESS.search(line)))
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
        dark = opened((1200, 700), "cylinder", address)
        _page_picture(dark, "app_dark")
        compared = opened((1200, 700), "double gyre", address)
        compared.get_by_role("button", name="Compare, save, share").click()
        compared.locator("[data-setting=compare] .v-field").click()
        compared.get_by_text("Kernel: box").last.click()
        settle(compared)
        compared.keyboard.press("Escape")
        compared.mouse.move(700, 690)
        settle(compared)
        _page_picture(compared, "app_compare")
        path = opened((1200, 700), "double gyre", address)
        path.mouse.move(310, 350)
        for _ in range(4):
            path.mouse.wheel(0, -200)
        path.mouse.move(310, 350)
        path.mouse.down()
        path.mouse.move(640, 360, steps=4)
        path.mouse.up()
        settle(path)
        path.mouse.click(590, 340)
        path.mouse.move(800, 470)
        path.get_by_text("Path through this point").wait_for()
        settle(path)
        _page_picture(path, "app_path")
        narrow = opened((400, 760), "airfoil", address)
        narrow.get_by_label("Light or dark").click()
        narrow.mouse.move(380, 60)
        narrow.get_by_text("speed (free-stream speed)").wait_for()
        settle(narrow)
        _page_picture(narrow, "app_narrow")
        browser.close()


def _page_picture(page: Any, name: str) -> None:
    """Save what a page shows."""
    with Image.open(io.BytesIO(page.screenshot())) as picture:
        picture.convert("RGB").save(
            FOLDER / f"{name}.jpg", quality=86, subsampling=0, optimize=True
        )


def nine() -> Picture:
    """Draw the figures of ``docs/howto/nine.md``, three in a row."""
    return _figures("nine.md", "python", 3, (480, 360), film="wake.gif")


def doors() -> Picture:
    """Draw those of ``docs/howto/doors.md``, four in a row; their libraries must be here."""
    return _figures("doors.md", "py", 4, (300, 225))


def _figures(page: str, kind: str, columns: int, cell: tuple[int, int], film: str = "") -> Picture:
    """Run the blocks of a page, and put the figures, or the film, that they leave into rows."""
    import matplotlib.pyplot as plt

    text = (FOLDER.parent / "howto" / page).read_text(encoding="utf-8")
    names: dict[str, Any] = {}
    cells = []
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        for block in re.findall(rf"```{kind}\n(.*?)```", text, re.DOTALL):
            exec(block, names)  # the lines of the page, as they are
            path = Path(film)
            if plt.get_fignums():
                path = Path("figure.png")
                plt.savefig(path, dpi=150)
                plt.close("all")
            if path.is_file():
                with Image.open(path) as figure:
                    size = cell[0] - 10, cell[1] - 10
                    cells.append(ImageOps.contain(figure.convert("RGB"), size))
    width, height = cell
    whole = Image.new("RGB", (columns * width, -(-len(cells) // columns) * height), "white")
    for n, figure in enumerate(cells):
        whole.paste(figure, (n % columns * width + 5, n // columns * height + 5))
    return np.asarray(whole)


def webmap() -> Picture:
    """Take pictures of a page with a web map: currents on the flat map, winds on the globe."""
    from playwright.sync_api import Route, sync_playwright

    from flowtex.host.export import MAPLIBRE

    modules = FOLDER.parents[1] / "client" / "node_modules" / "maplibre-gl" / "dist"
    kinds = {".css": "text/css", ".html": "text/html", ".mjs": "text/javascript"}

    def answer(route: Route) -> None:
        name = route.request.url.split("?")[0].rsplit("/", 1)[-1]
        path = (modules if MAPLIBRE in route.request.url else Path()) / name
        kind = kinds.get(path.suffix, "application/json")
        route.fulfill(path=path, headers={"Access-Control-Allow-Origin": "*", "Content-Type": kind})

    currents, winds = flowtex.examples.ocean().isel(time=0), flowtex.examples.weather()
    look: dict[str, Any] = {"projection": "mercator", "samples": 25}
    views = {"mercator": ([-66.0, 38.0], 4.6), "globe": ([-40.0, 35.0], 1.35)}
    shots = []
    with (
        TemporaryDirectory() as folder,
        contextlib.chdir(folder),
        sync_playwright() as playwright,
        playwright.chromium.launch(executable_path=shutil.which("chromium")) as browser,
    ):
        flowtex.export(currents, "mercator.html", basemap=_coasts("#222"), cmap="viridis", **look)
        flowtex.export(
            winds, "globe.html", basemap=_coasts("#eee"), level=250, cmap="magma", **look
        )
        for name, (center, zoom) in views.items():
            page = browser.new_page(viewport={"width": 596, "height": 440})
            page.set_default_timeout(120_000)
            page.context.route("**", answer)
            page.goto(f"https://flowtex.example/{name}.html")
            page.wait_for_function("() => window.flow?.isComplete")
            page.evaluate(
                "([type, center, zoom]) => { map.setProjection({ type }); map.moveLayer('coasts');"
                " map.jumpTo({ center, zoom }); return new Promise((f) => map.once('idle', f)); }",
                [name, center, zoom],
            )
            page.wait_for_function("() => flow.isComplete && map.loaded()")
            with Image.open(io.BytesIO(page.screenshot())) as picture:
                shots.append(np.asarray(picture.convert("RGB")))
    return _row(shots)


def _coasts(color: str) -> dict[str, Any]:
    """Return a style of MapLibre's with coasts, which asks for nothing from the network."""
    from flowtex.field.earth.map_lines import coastlines
    from flowtex.field.earth.projection import Projection

    lines = coastlines(Projection("globe"))
    x, y, z = lines.points.T
    places = np.degrees(np.stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))], axis=-1))
    pieces = np.split(places.round(2), lines.starts[1:-1])
    coasts = {"type": "MultiLineString", "coordinates": [piece.tolist() for piece in pieces]}
    line = {"line-color": color, "line-width": 0.7}
    return {
        "version": 8,
        "sources": {"coasts": {"type": "geojson", "data": coasts}},
        "layers": [
            {"id": "ground", "type": "background", "paint": {"background-color": "#d8d4c8"}},
            {"id": "coasts", "type": "line", "source": "coasts", "paint": line},
        ],
    }


STILLS = (
    *(wake, globe, cartopy, ocean, zooms, critical, vortices, sphere, torus, level_of_detail),
    *(grain, levels, kernels, arrows, structure, patterns, half_turns, gyre, nine),
    *(polar, webmap),
)
PICTURES: dict[str, Callable[[], Picture]] = {f.__name__: f for f in STILLS}


def _drawn(figure: Any) -> Picture:
    """Return the pixels of a figure of matplotlib, and close it."""
    import matplotlib.pyplot as plt

    figure.canvas.draw()
    picture = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
    plt.close(figure)
    return picture


def _row(pictures: list[Picture], gap: int = 8) -> Picture:
    """Put pictures side by side."""
    white = np.full((pictures[0].shape[0], gap, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture, white)]
    return np.concatenate(parts[:-1], axis=1)


def main() -> None:
    """Draw every picture, or those that are named, into ``docs/pictures``."""
    from rich.progress import track

    FOLDER.mkdir(exist_ok=True)
    wanted = sys.argv[1:] or [*PICTURES, "streaming", "paper", "app"]
    for name in track(wanted, "Drawing the gallery"):
        if name in ("paper", "app"):
            {"paper": paper, "app": app}[name]()
            continue
        if name == "streaming":
            first, *others = (Image.fromarray(frame) for frame in streaming())
            first.save(
                FOLDER / "streaming.webp",
                save_all=True,
                append_images=others,
                duration=SHOWN,
                loop=0,
                quality=55,
                method=6,
            )
            continue
        draw = doors if name == "doors" else PICTURES[name]
        Image.fromarray(draw()).save(FOLDER / f"{name}.jpg", quality=82, optimize=True)


if __name__ == "__main__":
    main()
