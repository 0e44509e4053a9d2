"""Related work: depth cues that noise on the screen loses."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.examples import double_gyre_velocity
from flowtex.field import FlowField
from flowtex.rendering.camera import Camera
from paper import measures
from paper.bench import PAPER, Bench
from paper.findings import Block, Claim, Finding, Panel, Plate, Section, Table
from paper.references import ImageSpace
from paper.views import View, grey

#: Texels of the noise for each pixel of the picture's width: few enough that near by one covers
#: several pixels, as otherwise mip levels bring all grains to the size of a pixel.
TEXELS_PER_PIXEL = 0.6
#: Share of the picture's surface that counts as near, and as far.
NEAR_SHARE, FAR_SHARE = 0.2, 0.2


def _plane() -> FlowField:
    """Make a long plane with a flow along it, to look along."""
    x, y = np.meshgrid(np.linspace(0, 6, 181), np.linspace(0, 2, 61))
    points = np.stack([x, y], axis=-1)
    gyres = double_gyre_velocity(np.stack([x % 2.0, y / 2], axis=-1), 0.0, epsilon=0.0)
    flow = np.stack([1.0 + 0 * x, 0.8 * gyres[..., 1]], axis=-1)
    return FlowField.from_arrays(points, flow, periodic="", name="plane")


def _view(bench: Bench) -> View:
    size = bench.pick((440, 300), (165, 112))
    camera = Camera((-1.15, 1.0, 0.8), (1.6, 1.0, 0.0), (0.0, 0.0, 1.0), view_angle=38.0)
    return View(bench, bench.once("plane", _plane), camera, size)


def _resolution(view: View) -> int:
    return round(TEXELS_PER_PIXEL * view.size[0])


def _bands(view: View) -> dict[str, Bools]:
    """Pixels near by and far off, by their distance along the plane."""
    far = view.position[..., 0]
    low, high = np.quantile(far[view.mask], (NEAR_SHARE, 1 - FAR_SHARE))
    with np.errstate(invalid="ignore"):
        return {"near": view.mask & (far <= low), "far": view.mask & (far >= high)}


def _noises(bench: Bench, view: View) -> dict[str, Floats]:
    """Draw the noise by itself, before it is advected."""
    image = ImageSpace(view.camera, view.size, view.field, blend=1.0, seed=bench.seed)
    fine = _resolution(view)
    return {
        "image space": image.frame(),
        "the paper's texture": view.picture(**{**PAPER, "samples": 1, "resolution": fine}).value,
        "default": view.picture(samples=1).value,
        "default, fixed grain": view.picture(samples=1, fixed_grain=True, resolution=fine).value,
    }


def _advected(bench: Bench, view: View) -> dict[str, Floats]:
    image = ImageSpace(view.camera, view.size, view.field, seed=bench.seed)
    fine = _resolution(view)
    values = image.frames(bench.pick(40, 25))
    return {
        "image space": measures.standardised(values),
        "the paper's texture": view.picture(**{**PAPER, "samples": 25, "resolution": fine}).value,
        "default": view.picture().value,
        "default, fixed grain": view.picture(fixed_grain=True, resolution=fine).value,
    }


def _depth(bench: Bench) -> Finding:
    view = _view(bench)
    bands = _bands(view)
    figures: dict[str, dict[str, float]] = {}
    for name, values in _noises(bench, view).items():
        near, far = (measures.local_grain(values, mask) for mask in bands.values())
        figures[name] = {
            "near": float(np.sqrt(near.along * near.across)),
            "far": float(np.sqrt(far.along * far.across)),
            "flattened": far.along / far.across,
        }
        figures[name]["near_over_far"] = figures[name]["near"] / figures[name]["far"]
    panels = [
        Panel(
            grey(values),
            f"{name.capitalize()}: near grains {figures[name]['near_over_far']:.2f} "
            f"times far ones; far ones {figures[name]['flattened']:.2f} times as wide as high.",
        )
        for name, values in _advected(bench, view).items()
    ]
    rows = [(name, *row.values()) for name, row in figures.items()]
    head = ("noise", "grain near, px", "grain far, px", "far: width over height", "near over far")
    blocks: list[Block] = [
        Plate(panels[:2], ""),
        Plate(panels[2:], "A plane seen along it, by four kinds of noise."),
        Table(head, rows, "Measured on the noise by itself, before it is advected."),
    ]
    return Finding(blocks, figures, [*_lost(figures), *_kept(figures)])


def _lost(figures: dict[str, Any]) -> list[Claim]:
    image = figures["image space"]
    return [
        Claim(
            "depth_image_space_has_one_size",
            "Section 1: noise on the screen has one size whatever the distance is.",
            abs(np.log2(image["near_over_far"])),
            0.15,
            "at most",
            "octaves from near to far",
        ),
        Claim(
            "depth_image_space_has_one_shape",
            "Section 1: noise on the screen has one shape whatever the surface's slope is.",
            abs(np.log2(image["flattened"])),
            0.15,
            "at most",
            "octaves from width to height",
        ),
    ]


def _kept(figures: dict[str, Any]) -> list[Claim]:
    paper = figures["the paper's texture"]
    return [
        Claim(
            "depth_size_here",
            "Section 1: noise on the surface keeps the cue of size: near grains are larger.",
            paper["near_over_far"],
            1.5,
            "at least",
            "× the far ones",
        ),
        Claim(
            "depth_shape_here",
            "Section 1: noise on the surface keeps the cue of shape: on a slope grains are flat.",
            paper["flattened"],
            1.5,
            "at least",
            "× as wide as high",
        ),
        Claim(
            "depth_default_shape",
            "By default grains have one size on the screen, but keep the cue of shape.",
            figures["default"]["flattened"],
            1.5,
            "at least",
            "× as wide as high",
        ),
    ]


SECTIONS = [
    Section(
        "depth",
        "Cues of depth and shape",
        "Section 1",
        "Noise that is defined on the screen has one size and frequency everywhere, whatever "
        "the distances and forms are, so that cues of depth and shape are lost.",
        "A plane seen along it. Grain is measured on the noise by itself: its size near by and "
        "far off, and how much wider than high it is far off, where the plane is steepest. Size "
        "is a cue only where texels are larger than pixels: elsewhere the paper's own mip levels "
        "make all grains as large as a pixel, and so does flowtex unless the grain is fixed.",
        _depth,
        "The related work, beside it",
    )
]
