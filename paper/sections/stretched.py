"""Related work: noise in computational space is stretched with the grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from paper import measures
from paper.bench import PAPER, Bench
from paper.findings import Claim, Finding, Panel, Plate, Table
from paper.references import draw_texture, forssell_lic
from paper.registry import Section
from paper.shots import shoot, tone

__all__ = ["SECTIONS"]

Floats = NDArray[np.float64]

#: Texels of the texture of computational space, for each node.
FINER = 6


def _unit(values: Floats) -> Floats:
    return np.asarray((values - np.nanmean(values)) / np.nanstd(values))


def _stretched(bench: Bench) -> Finding:
    field = bench.stretched
    shot = shoot(bench, field, bench.pick((520, 272), (300, 156)))
    rows, columns = (FINER * n for n in field.shape)
    white = np.random.default_rng(bench.seed).standard_normal((rows, columns))
    texture = forssell_lic(field, (rows, columns), length=30.0, kernel="hann", seed=bench.seed)
    paper = {**PAPER, "resolution": 512}
    pictures = {
        "Forssell and Cohen": draw_texture(texture, field, shot.camera),
        "the paper's method": shot.picture(**paper).value,
        "default": shot.picture().value,
    }
    noises = {
        "Forssell and Cohen": draw_texture(white, field, shot.camera),
        "the paper's method": shot.picture(**{**paper, "samples": 1}).value,
        "default": shot.picture(samples=1).value,
    }
    figures = {
        name: measures.evenness(noises[name], shot.mask)._asdict()
        | shot.streaks(_unit(values))._asdict()
        for name, values in pictures.items()
    }
    panels = [
        Panel(
            tone(_unit(values)),
            f"{name[0].upper()}{name[1:]}: grains "
            f"{figures[name]['stretch']:.2f} times as long as wide.",
        )
        for name, values in pictures.items()
    ]
    head = (
        "method",
        "large over small grains",
        "length over width of grains",
        "mean angle, °",
        "coherence",
    )
    table = Table(head, [(name, *found.values()) for name, found in figures.items()])
    where = "A double gyre on 52 × 62 nodes whose cells grow to the right and upwards."
    plate = Plate(panels, where)
    return Finding([plate, table], figures, _claims(figures))


def _claims(figures: dict[str, dict[str, float]]) -> list[Claim]:
    theirs = figures["Forssell and Cohen"]
    return [
        Claim(
            "stretched_in_computational_space",
            "Sections 1 and 2: a texture of computational space is distorted with the mesh.",
            theirs["stretch"],
            1.5,
            "at least",
            "times as long as wide",
        ),
        Claim(
            "stretched_uneven_in_computational_space",
            "Sections 1 and 2: its grains differ with the density of the mesh.",
            theirs["spread"],
            1.25,
            "at least",
            "× from small to large grains",
        ),
        Claim(
            "beyond_round_grains",
            "Beyond: noise in space has round grains on any mesh.",
            figures["default"]["stretch"],
            1.25,
            "at most",
            "times as long as wide",
        ),
        Claim(
            "beyond_even_grains",
            "Beyond: noise in space has grains of one size on any mesh.",
            figures["default"]["spread"],
            1.25,
            "at most",
            "× from small to large grains",
        ),
    ]


SECTIONS = [
    Section(
        "stretched",
        "Noise in computational space",
        "Sections 1 and 2",
        "LIC in the computational space of a curvilinear mesh (Forssell and Cohen) is mapped on "
        "the surface afterwards; aliasing or distortion can happen where the mesh is denser or "
        "sparser than the screen.",
        "That method, six texels for each node along both axes, on a stretched grid; beside it "
        "the paper's and the default.",
        _stretched,
        "The related work, beside it",
    )
]
