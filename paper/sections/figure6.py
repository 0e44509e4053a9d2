"""Figure 6: noise spread evenly over the surface, and LIC at the grid's own resolution."""

from __future__ import annotations

from flowtex._util.array_types import Floats
from paper import measures
from paper.bench import OURS, PAPER, Bench
from paper.findings import Block, Claim, Finding, Panel, Plate, Section, Table
from paper.references import draw_texture, forssell_lic
from paper.views import View, grey, view_of, wing_view

#: Length of the kernel of LIC in nodes, and texels of the noise along the surface.
LIC_LENGTH_NODES, RESOLUTION = 12.0, 512


LABELS = {
    "corrected": "The paper's method, noise spread evenly over the surface.",
    "not corrected": "The same without the correction.",
    "LIC at 52 × 62": "LIC computed at the grid's resolution and laid on the surface.",
    "default": "flowtex by default: noise in space.",
}


def _pictures(bench: Bench, view: View) -> dict[str, Floats]:
    """Draw the view by every method; values of mean zero and deviation one."""
    paper = {**PAPER, "resolution": RESOLUTION}
    texture = forssell_lic(view.field, length=LIC_LENGTH_NODES, seed=bench.seed)
    lic = draw_texture(texture, view.field, view.camera, view.size)
    return {
        "corrected": view.picture(**paper).value,
        "not corrected": view.picture(**paper, noise_correction=False).value,
        "LIC at 52 × 62": measures.standardised(lic),
        "default": view.picture(**OURS).value,
    }


def _evenness(view: View, resolution: int) -> tuple[list[Panel], dict[str, dict[str, float]]]:
    """Draw and measure the noise by itself, with the correction and without."""
    panels, numbers = [], {}
    for correction in (True, False):
        paper = {**PAPER, "resolution": resolution, "noise_correction": correction}
        noise = view.picture(**{**paper, "samples": 1}, lod=False).value
        evenness = measures.evenness(noise, view.mask)
        word = "With" if correction else "Without"
        numbers[f"{word.lower()} correction"] = dict(evenness._asdict())
        label = (
            f"{word} the correction: grains {evenness.stretch:.2f} times as long as wide, large "
            f"ones {evenness.spread:.1f} times the small ones."
        )
        panels += [
            Panel(grey(noise), label),
            Panel(grey(view.picture(**paper).value), "Advected."),
        ]
    # With level of detail, from so many texels that mip levels decide what is seen.
    paper = {**PAPER, "samples": 1, "resolution": 4 * resolution}
    evenness = measures.evenness(view.picture(**paper).value, view.mask)
    numbers["with correction, level of detail"] = dict(evenness._asdict())
    return panels, numbers


def _figure6(bench: Bench) -> Finding:
    flat = view_of(bench, bench.stretched, bench.pick((440, 230), (180, 94)))
    noise, even = _evenness(flat, bench.pick(256, 128))
    view = wing_view(bench, bench.pick((440, 340), (150, 116)), 3.0)
    pictures = _pictures(bench, view)
    figures: dict[str, dict[str, float]] = {
        name: {
            **view.streaks(values)._asdict(),
            **view.grain(values)._asdict(),
            "sharpness": measures.sharpness(values, view.mask),
        }
        for name, values in pictures.items()
    }
    panels = [
        Panel(grey(values), f"{LABELS[name]} Streaks {figures[name]['across']:.1f} px wide.")
        for name, values in pictures.items()
    ]
    rows = [(name, *row.values()) for name, row in figures.items()]
    blocks: list[Block] = [
        Plate(noise[:2], ""),
        Plate(noise[2:], "A flow on 52 × 62 nodes whose cells grow to the right and upwards."),
        Plate(panels[:2], ""),
        Plate(panels[2:], "A part of the wing by the paper's method, by LIC, and by default."),
        Table(HEAD, rows, "The four pictures of the wing. Widths are half widths."),
    ]
    claims = [*_noise_claims(even), *_lic_claims(figures)]
    return Finding(blocks, {"wing": figures, "noise": even}, claims)


HEAD = (
    "picture",
    "mean angle, °",
    "coherence",
    "grain along, px",
    "grain across, px",
    "change from pixel to pixel",
)


def _noise_claims(even: dict[str, dict[str, float]]) -> list[Claim]:
    best, worst = even["with correction"], even["without correction"]
    return [
        Claim(
            "figure6_no_stretched_pattern",
            "Figure 6: with the correction no stretched pattern is seen.",
            best["stretch"],
            1.5,
            "at most",
            "times as long as wide",
        ),
        Claim(
            "figure6_no_stretched_pattern_with_levels",
            "Figure 6 with section 4: nor is it with level of detail, where texels are averaged "
            "along the grid's lines.",
            even["with correction, level of detail"]["stretch"],
            1.5,
            "at most",
            "times as long as wide",
        ),
        Claim(
            "figure6_correction_rounds_the_grains",
            "Figure 6: without the correction grains are stretched.",
            worst["stretch"] / best["stretch"],
            1.5,
            "at least",
            "× as stretched as with it",
        ),
        Claim(
            "figure6_correction_evens_the_grains",
            "Section 3.2: the correction makes the noise as even as possible whatever the cells.",
            best["spread"],
            1.5,
            "at most",
            "× from small to large grains",
        ),
    ]


def _lic_claims(figures: dict[str, dict[str, float]]) -> list[Claim]:
    ours, lic = figures["corrected"], figures["LIC at 52 × 62"]
    return [
        Claim(
            "figure6_clearer_than_lic",
            "Figure 6: patterns are clearer than by LIC at 52 × 62: streaks are finer.",
            ours["across"] / lic["across"],
            0.5,
            "at most",
            "× the width of LIC's",
        ),
        Claim(
            "figure6_more_detail_than_lic",
            "Figure 6: LIC at 52 × 62 has not enough detail: change from pixel to pixel.",
            ours["sharpness"] / lic["sharpness"],
            2.0,
            "at least",
            "× that of LIC",
        ),
        Claim(
            "figure6_direction_clearer_than_lic",
            "Figure 6: LIC at 52 × 62 does not show the directions: its streaks lie farther off.",
            ours["angle"] / lic["angle"],
            1.0,
            "at most",
            "× the angle of LIC's",
        ),
    ]


SECTIONS = [
    Section(
        "figure6",
        "Figure 6: even noise, and LIC at the grid's resolution",
        "Section 3.2, figure 6",
        "On a curvilinear mesh noise is to be spread as evenly as possible whatever the cells "
        "are. With that correction no stretched pattern is seen. At the original resolution of "
        "52 × 62 the method shows clearer patterns than LIC, whose picture has not enough detail "
        "to show the directions.",
        "The noise on a stretched grid of 52 × 62 nodes; then a part of the wing, from near. The "
        "paper does not say how it spreads the noise. Here noise coordinates grow with the length "
        "of the grid lines, and texels that stay longer than wide take an even noise in space. "
        "LIC is that of Cabral and Leedom, in the computational space as Forssell has it, with "
        "one texel for each node.",
        _figure6,
    )
]
