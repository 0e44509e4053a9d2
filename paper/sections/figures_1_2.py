"""Figures 1 and 2: how slices are made and looked up, drawn from a real trace."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.probe import Probe, probe
from flowtex.scene import Scene
from flowtex.trace import trace
from paper.bench import PAPER, Bench
from paper.findings import Block, Claim, Finding, Plot, Table
from paper.plots import COLOURS, GROUND, INK, RULE, SOFT, canvas
from paper.registry import Section

__all__ = ["SECTIONS"]

Floats = NDArray[np.float64]

#: Destination time of figure 1, slices that are drawn, and the middle (i, j) of a vortex.
STEP, COUNT, MIDDLE = 12, 4, (18, 64)
#: Nodes around it that are shown, by their distance, and the one whose path is shown.
AROUND, OWN = np.arange(-7, 8, 2), (6, 4)
#: Where a plane of a time lies in the drawing: how far up, and how it is tilted.
UP, SHEAR, FLAT = 1.15, 0.45, 0.95
#: Point of figure 2 as (j, i), texels of its noise, and texels that a pixel covers.
PLACE, RESOLUTION, COVERS = (12.4, 26.3), 512, 2.0


def _tilted(position: Floats, level: float) -> Floats:
    """Take positions (..., 2) of a plane to the drawing, (..., 2)."""
    x, y = position[..., 0], position[..., 1]
    return np.stack([x + SHEAR * y, FLAT * y + UP * level], axis=-1)


def _figure1(bench: Bench) -> Finding:
    field = bench.vortex
    lags = float(np.mean(np.diff(field.times))) * np.arange(1, COUNT + 1)
    slices = trace(field, lags=lags, steps=[STEP], compose=False, progress=False)
    i, j = np.meshgrid(MIDDLE[0] + AROUND, MIDDLE[1] + AROUND)
    nodes = np.stack([i, j], axis=-1).astype(float)
    places = [nodes, *(nodes + slices.displacement[0, m][j, i] for m in range(COUNT))]
    own = np.array([place[OWN[1], OWN[0]] for place in places])
    low = np.min([p.min(axis=(0, 1)) for p in places], axis=0) - 2
    high = np.max([p.max(axis=(0, 1)) for p in places], axis=0) + 2
    scaled = [(p - low) / (high - low) for p in places]
    rows = [
        (
            f"Td − {m} Δt" if m else "Td",
            *(float(c) for c in place),
            *(float(c) for c in place - own[0]),
        )
        for m, place in enumerate(own)
    ]
    table = Table(
        ("time", "a", "b", "a − i", "b − j"),
        rows,
        "The entries of the slices at that node; displacements, the last two columns, are what is "
        "stored.",
    )
    numbers = {"lags": lags, "positions": own}
    return Finding([_planes(scaled, own), table], numbers)


def _planes(scaled: list[Floats], own: Floats) -> Plot:
    """Draw the patch of nodes at every time, one plane above the other."""
    with canvas(
        "Figure 1: a patch of nodes at Td, on top, and where its particles were at K earlier "
        "times: each plane is a trace slice, and its points are the entries. The orange line is "
        "the pathline of one node, followed backward.",
        "Planes of five times, with a patch of nodes that is more and more bent the earlier the "
        "time, and one pathline through all of them.",
        size=(8.6, 6.6),
    ) as made:
        axes, last = made.axes, len(scaled) - 1
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], float)
        path = []
        for m, place in enumerate(scaled):
            level = float(last - m)
            axes.plot(*_tilted(corners, level).T, color=RULE, linewidth=1.2, zorder=1)
            drawn = _tilted(place, level)
            for line in (*drawn, *np.swapaxes(drawn, 0, 1)):
                axes.plot(*line.T, color=COLOURS[0], linewidth=0.9, alpha=0.75, zorder=2)
            axes.plot(*drawn.reshape(-1, 2).T, ".", color=COLOURS[0], markersize=4, zorder=3)
            path.append(drawn[OWN[1], OWN[0]])
            axes.plot(*path[-1], "o", color=COLOURS[1], markersize=7, zorder=5)
            _say(axes, m, own[m], level)
        axes.plot(*np.array(path).T, color=COLOURS[1], linewidth=2.2, zorder=4)
        axes.set_xlim(-0.75, 1.55)
        axes.set_axis_off()
    return _plot(made.plot)


def _say(axes: Any, m: int, place: Floats, level: float) -> None:
    """Name a plane on its left."""
    name = f"S  at  Td − {m} Δt" if m else "nodes at Td"
    what = (
        f"(a, b) = ({place[0]:.1f}, {place[1]:.1f})"
        if m
        else f"(i, j) = ({place[0]:.0f}, {place[1]:.0f})"
    )
    at = _tilted(np.array([0.0, 0.5]), level)
    axes.annotate(name, at - [0.78, -0.04], color=INK, fontsize=10.5, annotation_clip=False)
    axes.annotate(what, at - [0.78, 0.09], color=SOFT, fontsize=9.5, annotation_clip=False)


def _plot(plot: Plot | None) -> Plot:
    if plot is None:
        msg = "the plot was not drawn"
        raise RuntimeError(msg)
    return plot


def _probed(bench: Bench) -> tuple[Scene, Probe]:
    field: FlowField = bench.gyre
    settings = bench.settings(**PAPER, resolution=RESOLUTION)
    view = Scene(field, settings)
    pixel = COVERS * field.surface.extent / RESOLUTION
    return view, probe(view, PLACE, pixel=pixel)


def _figure2(bench: Bench) -> Finding:
    view, found = _probed(bench)
    paper = view.textures.paper
    if paper is None or found.noise_coordinates is None:
        msg = "there is no noise texture; expected that of the paper's method"
        raise ValueError(msg)
    level, order = round(found.level), np.argsort(found.lags)
    size = np.array(paper.noise.shape[::-1]) // 2**level
    texels = (found.noise_coordinates * size - 0.5)[order]
    numbers = {
        "level": found.level,
        "slice_level": found.slice_level,
        "lags": found.lags[order],
        "noise": found.noise[order],
        "weights": found.weights[order],
        "texels": texels,
        "value": found.value,
    }
    plot = _lookups(_level(paper.noise, level), texels, found, order)
    blocks: list[Block] = [plot, _rows(found, order, texels)]
    return Finding(blocks, numbers, _claims(found, texels))


def _rows(found: Probe, order: NDArray[np.intp], texels: Floats) -> Table:
    """Tell the look-ups of the pixel, from the nearest to the farthest."""
    rows = [
        (
            number + 1,
            float(found.lags[k]),
            f"{found.slices[k, 0]} and {found.slices[k, 1]}",
            float(found.shares[k]),
            "{:.2f}, {:.2f}".format(*found.coordinates[k][::-1]),
            "{:.1f}, {:.1f}".format(*texels[number]),
            float(found.noise[k]),
        )
        for number, k in enumerate(order)
    ]
    head = ("contribution", "lag", "slices", "share of the later", "(a, b)", "texel", "noise")
    caption = (
        "The look-ups of one pixel: between which slices each lies, where its particle was, and "
        f"the noise there. The mean times {found.gain:.2f} is the pixel, {found.value:.2f}."
    )
    return Table(head, rows, caption)


def _claims(found: Probe, texels: Floats) -> list[Claim]:
    mean = float(np.sum(found.weights * found.noise) * found.gain)
    ways = np.linalg.norm(np.diff(texels, axis=0), axis=1)
    return [
        Claim(
            "figure2_value_is_the_mean",
            "Figure 2, equation 2: the pixel is the mean of the looked-up texels. Difference of "
            "both.",
            abs(mean - float(np.asarray(found.value))),
            1e-9,
            "at most",
        ),
        Claim(
            "equation3_texels_are_neighbours",
            "Equation 3: contributions come from neighbouring texels. Longest way from one to "
            "the next.",
            float(ways.max()),
            1.5,
            "at most",
            "texels",
        ),
    ]


def _level(noise: NDArray[np.float32], level: int) -> Floats:
    """Mip level of a noise, (H, W)."""
    rows, columns = (n // 2**level for n in noise.shape)
    return np.asarray(noise.reshape(rows, 2**level, columns, 2**level).mean(axis=(1, 3)), float)


def _lookups(noise: Floats, texels: Floats, found: Probe, order: NDArray[np.intp]) -> Plot:
    """Draw the path over the mesh, the texels in the noise, and the values that are averaged."""
    with canvas(
        "Figure 2: from a fragment to its colour. Left: the fragment (i, j) and the positions "
        "(a, b) that the slices give. Middle: the texels of the noise that they meet. Right: "
        "their values and the mean, which is the colour.",
        "A path over a mesh, the texels of the noise along it, and ten values with their mean.",
        columns=3,
        size=(10.4, 3.9),
    ) as made:
        places = found.coordinates[order][:, ::-1]
        _mesh(made.axes[0], places)
        _noise(made.axes[1], noise, texels)
        _mean(made.axes[2], found.noise[order], found)
    return _plot(made.plot)


def _mesh(axes: Any, places: Floats) -> None:
    low, high = np.floor(places.min(axis=0)) - 1, np.ceil(places.max(axis=0)) + 1
    for line in np.arange(low[0], high[0] + 1):
        axes.plot([line, line], [low[1], high[1]], color=RULE, linewidth=1)
    for line in np.arange(low[1], high[1] + 1):
        axes.plot([low[0], high[0]], [line, line], color=RULE, linewidth=1)
    axes.plot(*places.T, "-o", color=COLOURS[0], markersize=4.5)
    axes.plot(*places[0], "o", color=COLOURS[1], markersize=9)
    axes.annotate("(i, j)", places[0], xytext=(7, 7), textcoords="offset points", color=INK)
    axes.annotate("(a, b)", places[-1], xytext=(7, -12), textcoords="offset points", color=INK)
    axes.set_title("1  trace slices")
    axes.set_aspect("equal")
    axes.grid(visible=False)


def _noise(axes: Any, noise: Floats, texels: Floats) -> None:
    low = np.maximum(np.floor(texels.min(axis=0)).astype(int) - 3, 0)
    high = np.minimum(np.ceil(texels.max(axis=0)).astype(int) + 4, noise.shape[::-1])
    part = noise[low[1] : high[1], low[0] : high[0]]
    extent = (low[0] - 0.5, high[0] - 0.5, low[1] - 0.5, high[1] - 0.5)
    axes.imshow(part, cmap="gray", origin="lower", extent=extent, interpolation="nearest")
    for x, y in np.unique(np.rint(texels), axis=0):
        axes.plot(
            x + 0.5 * np.array([-1, 1, 1, -1, -1]),
            y + 0.5 * np.array([-1, -1, 1, 1, -1]),
            color=COLOURS[1],
            linewidth=1.6,
        )
    axes.plot(*texels.T, "o", color=COLOURS[0], markersize=4.5, markeredgecolor=GROUND)
    axes.set_title("2  noise texture")
    axes.grid(visible=False)


def _mean(axes: Any, noise: Floats, found: Probe) -> None:
    at = np.arange(1, len(noise) + 1)
    axes.bar(at, noise, color=COLOURS[0], width=0.7)
    mean = float(np.sum(found.weights * found.noise))
    axes.axhline(mean, color=COLOURS[1], linewidth=2)
    axes.set_title(f"3  mean of equation 2: {mean:.2f}")
    axes.set_xlabel("contribution")
    axes.set_xticks(at)


SECTIONS = [
    Section(
        "figure1",
        "Figure 1: how trace slices are made",
        "Section 3.1, figure 1",
        "From every grid point a pathline is followed backward from Td. Its positions at K "
        "earlier times make K slices of the size of the grid.",
        "A real trace of the vortex field, from step 12: of every second node of a patch around "
        "a vortex.",
        _figure1,
    ),
    Section(
        "figure2",
        "Figure 2: two look-ups",
        "Sections 3.2 and 3.3, figure 2",
        "A fragment looks up the slices at its own texture coordinates, and with what it finds "
        "there the noise; K such texels are averaged.",
        "One pixel of the gyre, by the paper's method with ten contributions: what it looked up, "
        "written down by the renderer itself (flowtex.probe).",
        _figure2,
    ),
]
