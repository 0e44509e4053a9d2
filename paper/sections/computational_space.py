"""Related work: noise in computational space is stretched with the grid."""

from __future__ import annotations

import numpy as np

from paper import measures
from paper.bench import PAPER, Bench
from paper.findings import Claim, Finding, Panel, Plate, Section, Table
from paper.references import draw_texture, forssell_lic
from paper.views import grey, view_of

#: Texels of the texture of computational space, for each node.
TEXELS_PER_NODE = 6


def _stretched(bench: Bench) -> Finding:
    field = bench.stretched
    view = view_of(bench, field, bench.pick((520, 272), (300, 156)))
    rows, columns = (TEXELS_PER_NODE * n for n in field.shape)
    white = np.random.default_rng(bench.seed).standard_normal((rows, columns))
    texture = forssell_lic(field, (rows, columns), length=30.0, kernel="hann", seed=bench.seed)
    paper = {**PAPER, "resolution": 512}
    pictures = {
        "Forssell and Cohen": draw_texture(texture, field, view.camera, view.size),
        "the paper's method": view.picture(**paper).value,
        "default": view.picture().value,
    }
    noises = {
        "Forssell and Cohen": draw_texture(white, field, view.camera, view.size),
        "the paper's method": view.picture(**{**paper, "samples": 1}).value,
        "default": view.picture(samples=1).value,
    }
    figures = {
        name: measures.evenness(noises[name], view.mask)._asdict()
        | view.streaks(measures.standardised(values))._asdict()
        for name, values in pictures.items()
    }
    panels = [
        Panel(
            grey(measures.standardised(values)),
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
    table = Table(head, [(name, *row.values()) for name, row in figures.items()])
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
