"""Figures 1 and 2: how slices are made and looked up, drawn from a real trace."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.field.interpolation import bracket
from flowtex.field.locate import surface_point
from flowtex.rendering.cpu.fragments import Fragments, slice_level
from flowtex.rendering.cpu.noise_texture import NoiseImages, NoiseLookup
from flowtex.rendering.cpu.render import slices_at, view_state
from flowtex.rendering.cpu.texture import Summing
from flowtex.rendering.uniforms import ViewState, uniforms
from flowtex.scene.probe import Recorder, camera_facing, cover_place
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.trace.trace import trace
from paper.bench import PAPER, Bench
from paper.blocks import block_means
from paper.findings import Claim, Finding, Plot, Section, Table
from paper.plots import COLOURS, GROUND, INK, RULE, SOFT, plot_axes

#: Destination time of figure 1, slices that are drawn, and the middle (i, j) of a vortex.
FIGURE1_STEP, FIGURE1_SLICES, VORTEX_NODE = 12, 4, (18, 64)
#: Nodes around it that are shown, by their distance, and the one whose path is shown.
PATCH_OFFSETS, PATH_NODE = np.arange(-7, 8, 2), (6, 4)
#: Where a plane of a time lies in the drawing: how far up, and how it is tilted.
LEVEL_HEIGHT, SHEAR, LEVEL_SCALE = 1.15, 0.45, 0.95
#: Point of figure 2 as (j, i), texels of its noise, and texels that a pixel covers.
FIGURE2_POINT, RESOLUTION, TEXELS_PER_PIXEL = (12.4, 26.3), 512, 2.0


def _tilted(position: Floats, level: float) -> Floats:
    """Take positions (..., 2) of a plane to the drawing, (..., 2)."""
    x, y = position[..., 0], position[..., 1]
    return np.stack([x + SHEAR * y, LEVEL_SCALE * y + LEVEL_HEIGHT * level], axis=-1)


def _figure1(bench: Bench) -> Finding:
    field = bench.vortex
    lags = float(np.mean(np.diff(field.times))) * np.arange(1, FIGURE1_SLICES + 1)
    slices = trace(field, lags=lags, steps=[FIGURE1_STEP], compose=False, progress=False)
    i, j = np.meshgrid(VORTEX_NODE[0] + PATCH_OFFSETS, VORTEX_NODE[1] + PATCH_OFFSETS)
    nodes = np.stack([i, j], axis=-1).astype(float)
    positions = [nodes, *(nodes + slices.displacement[0, m][j, i] for m in range(FIGURE1_SLICES))]
    own = np.array([position[PATH_NODE[1], PATH_NODE[0]] for position in positions])
    low = np.min([p.min(axis=(0, 1)) for p in positions], axis=0) - 2
    high = np.max([p.max(axis=(0, 1)) for p in positions], axis=0) + 2
    scaled = [(p - low) / (high - low) for p in positions]
    rows = [
        (
            f"Td − {m} Δt" if m else "Td",
            *(float(c) for c in position),
            *(float(c) for c in position - own[0]),
        )
        for m, position in enumerate(own)
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
    with plot_axes(
        "Figure 1: a patch of nodes at Td, on top, and where its particles were at K earlier "
        "times: each plane is a trace slice, and its points are the entries. The orange line is "
        "the pathline of one node, followed backward.",
        "Planes of five times, with a patch of nodes that is more and more bent the earlier the "
        "time, and one pathline through all of them.",
        size=(8.6, 6.6),
    ) as figure:
        axes, last = figure.axes, len(scaled) - 1
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], float)
        path = []
        for m, position in enumerate(scaled):
            level = float(last - m)
            axes.plot(*_tilted(corners, level).T, color=RULE, linewidth=1.2, zorder=1)
            patch = _tilted(position, level)
            for line in (*patch, *np.swapaxes(patch, 0, 1)):
                axes.plot(*line.T, color=COLOURS[0], linewidth=0.9, alpha=0.75, zorder=2)
            axes.plot(*patch.reshape(-1, 2).T, ".", color=COLOURS[0], markersize=4, zorder=3)
            path.append(patch[PATH_NODE[1], PATH_NODE[0]])
            axes.plot(*path[-1], "o", color=COLOURS[1], markersize=7, zorder=5)
            _say(axes, m, own[m], level)
        axes.plot(*np.array(path).T, color=COLOURS[1], linewidth=2.2, zorder=4)
        axes.set_xlim(-0.75, 1.55)
        axes.set_axis_off()
    return figure.plot


def _say(axes: Any, m: int, position: Floats, level: float) -> None:
    """Name a plane on its left."""
    name = f"S  at  Td − {m} Δt" if m else "nodes at Td"
    what = (
        f"(a, b) = ({position[0]:.1f}, {position[1]:.1f})"
        if m
        else f"(i, j) = ({position[0]:.0f}, {position[1]:.0f})"
    )
    at = _tilted(np.array([0.0, 0.5]), level)
    axes.annotate(name, at - [0.78, -0.04], color=INK, fontsize=10.5, annotation_clip=False)
    axes.annotate(what, at - [0.78, 0.09], color=SOFT, fontsize=9.5, annotation_clip=False)


class _Looked(NamedTuple):
    """The look-ups of a fragment, by contribution from the nearest to the farthest."""

    level: float  #: Of the noise, and of the slices.
    slice_level: float
    lags: Floats
    slices: Indices  #: Numbers of the slices on both sides of each, (K, 2).
    shares: Floats  #: How far each is from the first of them to the second.
    positions: Floats  #: Where each is, (K, 2) as (i, j), and in texels of the level.
    texels: Floats
    noise: Floats
    weights: Floats
    gain: float
    value: float


def _looked(bench: Bench) -> tuple[_Looked, Floats]:
    """Return the look-ups of the point of figure 2, and the noise at their level."""
    asked: dict[str, Any] = {**PAPER, "resolution": RESOLUTION}
    field = bench.gyre
    textures, surface = bench.textures(field, **asked), field.surface
    noise = textures.image
    assert isinstance(noise, NoiseTextures)
    place = surface_point(surface, FIGURE2_POINT)
    camera = camera_facing(surface, place, TEXELS_PER_PIXEL * surface.extent / RESOLUTION)
    state = view_state(textures, camera, ViewState(still=True), (0, 0))
    values = uniforms(textures, bench.settings(**asked), state)
    fragments = Fragments.of(textures, cover_place(surface, place, camera, (1, 1)))
    slice_mip = slice_level(fragments.coordinate, values)
    lookup = NoiseLookup(fragments, values, NoiseImages(noise))
    recorder = Recorder(lookup, values["u_samples"] + 2)
    slices = slices_at(textures, (0, 0), values)
    summing = Summing(slices, values, recorder, by_lag=True)
    value = summing.texture(fragments.place, slice_mip, fragments.by)[0]
    lags = -np.concatenate(recorder.length)
    order = np.argsort(lags)
    lags, knots = lags[order], np.concatenate([[0.0], values["u_lags"]])
    first, shares = bracket(knots, lags, side="left")
    coordinates = (lookup.start + np.concatenate(recorder.displacement)[:, :2])[order]
    mip = round(float(lookup.level[0]))
    level = np.asarray(block_means(noise.texels[..., 0], 2**mip), float)
    unit = float(slices.layer(fragments.place, 0, slice_mip)[0, 3]) * textures.unit / textures.pace
    return _Looked(
        level=float(lookup.level[0]),
        slice_level=float(slice_mip[0]),
        lags=lags * unit,
        slices=np.stack([first, first + 1], axis=-1),
        shares=shares,
        positions=noise.index(coordinates),
        texels=coordinates * level.shape[::-1] - 0.5,
        noise=recorder.noise[order],
        weights=recorder.weights[order],
        gain=recorder.gain,
        value=float(value),
    ), level


def _figure2(bench: Bench) -> Finding:
    result, noise = _looked(bench)
    names = ("level", "slice_level", "lags", "noise", "weights", "texels", "value")
    numbers = {name: getattr(result, name) for name in names}
    return Finding([_lookups(noise, result), _rows(result)], numbers, _claims(result))


def _rows(result: _Looked) -> Table:
    """Tell the look-ups of the pixel, from the nearest to the farthest."""
    rows = [
        (
            k + 1,
            float(result.lags[k]),
            f"{result.slices[k, 0]} and {result.slices[k, 1]}",
            float(result.shares[k]),
            "{:.2f}, {:.2f}".format(*result.positions[k]),
            "{:.1f}, {:.1f}".format(*result.texels[k]),
            float(result.noise[k]),
        )
        for k in range(len(result.lags))
    ]
    head = ("contribution", "lag", "slices", "share of the later", "(a, b)", "texel", "noise")
    caption = (
        "The look-ups of one pixel: between which slices each lies, where its particle was, and "
        f"the noise there. The mean times {result.gain:.2f} is the pixel, {result.value:.2f}."
    )
    return Table(head, rows, caption)


def _claims(result: _Looked) -> list[Claim]:
    mean = float(np.sum(result.weights * result.noise) * result.gain)
    ways = np.linalg.norm(np.diff(result.texels, axis=0), axis=1)
    return [
        Claim(
            "figure2_value_is_the_mean",
            "Figure 2, equation 2: the pixel is the mean of the looked-up texels. Difference of "
            "both.",
            abs(mean - result.value),
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


def _lookups(noise: Floats, result: _Looked) -> Plot:
    """Draw the path over the mesh, the texels in the noise, and the values that are averaged."""
    with plot_axes(
        "Figure 2: from a fragment to its colour. Left: the fragment (i, j) and the positions "
        "(a, b) that the slices give. Middle: the texels of the noise that they meet. Right: "
        "their values and the mean, which is the colour.",
        "A path over a mesh, the texels of the noise along it, and ten values with their mean.",
        columns=3,
        size=(10.4, 3.9),
    ) as figure:
        _mesh(figure.axes[0], result.positions)
        _noise(figure.axes[1], noise, result.texels)
        _mean(figure.axes[2], result)
    return figure.plot


def _mesh(axes: Any, positions: Floats) -> None:
    low, high = np.floor(positions.min(axis=0)) - 1, np.ceil(positions.max(axis=0)) + 1
    for line in np.arange(low[0], high[0] + 1):
        axes.plot([line, line], [low[1], high[1]], color=RULE, linewidth=1)
    for line in np.arange(low[1], high[1] + 1):
        axes.plot([low[0], high[0]], [line, line], color=RULE, linewidth=1)
    axes.plot(*positions.T, "-o", color=COLOURS[0], markersize=4.5)
    axes.plot(*positions[0], "o", color=COLOURS[1], markersize=9)
    axes.annotate("(i, j)", positions[0], xytext=(7, 7), textcoords="offset points", color=INK)
    axes.annotate("(a, b)", positions[-1], xytext=(7, -12), textcoords="offset points", color=INK)
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


def _mean(axes: Any, result: _Looked) -> None:
    at = np.arange(1, len(result.noise) + 1)
    axes.bar(at, result.noise, color=COLOURS[0], width=0.7)
    mean = float(np.sum(result.weights * result.noise))
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
        "written down by the renderer itself.",
        _figure2,
    ),
]
