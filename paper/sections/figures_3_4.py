"""Figures 3 and 4: how far particles are off, by slices and by fields of fewer nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from flowtex.examples import cylinder_field, double_gyre_field
from flowtex.field import FlowField
from paper.bench import Bench
from paper.findings import Claim, Finding, Section, Table, Text
from paper.plots import Line, line_plot
from paper.position_errors import STEPS, Errors, position_errors, step_slices

#: Growth over ten steps up to which an error counts as not accumulating.
BOUNDED_GROWTH = 2.0
FACTOR_WORDS = {2: "half", 4: "a quarter"}


def _measured(bench: Bench, name: str, field: FlowField, step: int, factor: int) -> Errors:
    tolerance = bench.pick(1e-5, 1e-3)
    slices = bench.once(("step slices", name), lambda: step_slices(field, step, tolerance))
    count = bench.pick(2500, 300)
    return bench.once(
        ("errors", name, factor),
        lambda: position_errors(field, slices, factor, count, bench.rng, tolerance),
    )


def _figure(bench: Bench, factor: int) -> Finding:
    """Measure the vortex with every second or fourth node."""
    errors = _measured(bench, "vortex", bench.vortex, 10, factor)
    figure, nodes = {2: (3, "50 × 50"), 4: (4, "25 × 25")}[factor]
    steps = list(range(1, STEPS + 1))
    plot = line_plot(
        [
            Line("field, down-sampled", steps, list(errors.field)),
            Line("trace slices, down-sampled: at their entries", steps, list(errors.slices)),
            Line(
                "trace slices, down-sampled: between entries",
                steps,
                list(errors.between),
                dashed=True,
            ),
            Line("trace slices, 100 × 100: between entries", steps, list(errors.full), dashed=True),
        ],
        x="time steps travelled",
        y="mean error of position, in boxes",
        caption=(
            f"Figure {figure}: 100 × 100 nodes reduced to {nodes}. The box is 99 cells wide; after "
            f"ten steps a particle is {99 * errors.travelled[-1]:.0f} cells from where it was."
        ),
        alt=(
            f"Errors over 1 to 10 steps. Field: {errors.field[0]:.2g} to {errors.field[-1]:.2g}; "
            f"slices: {errors.slices[0]:.2g} to {errors.slices[-1]:.2g}."
        ),
    )
    return Finding([plot, Text(_reading(errors))], _numbers(errors), _claims(errors, figure, nodes))


def _reading(errors: Errors) -> str:
    cells = 99 * errors.even
    if not np.isfinite(cells):
        return "Slices are the more accurate ones over all ten steps."
    return (
        f"Down-sampled slices are the more accurate ones up to a way of about {cells:.0f} cells. "
        "Beyond it their error grows faster than the field's: not by integration, of which there "
        "is none, but because neighbouring particles drift apart, so that the mean of four or "
        "sixteen of them, and what is interpolated between, stand for none of them. This vortex "
        "field turns quickly: its particles cross a fifth of the box in ten steps."
    )


def _numbers(errors: Errors) -> dict[str, Any]:
    return {
        "steps": list(range(1, STEPS + 1)),
        "field": errors.field,
        "slices": errors.slices,
        "slices_between_entries": errors.between,
        "full_slices_between_entries": errors.full,
        "travelled": errors.travelled,
        "growth": errors.growth,
        "last_error_in_texels": errors.texels,
        "break_even_way": errors.even,
    }


def _claims(errors: Errors, figure: int, nodes: str) -> list[Claim]:
    name = f"figure{figure}"
    return [
        Claim(
            f"{name}_field_errors_accumulate",
            f"Down-sampled to {nodes}, errors of the field's paths grow with the steps.",
            errors.growth["field"],
            BOUNDED_GROWTH,
            "at least",
            "× from step 1 to 10",
        ),
        Claim(
            f"{name}_slices_more_accurate_at_first",
            f"Down-sampled to {nodes}, trace slices are more accurate than the field "
            "after one step.",
            errors.quotient[0],
            1.0,
            "at most",
            "× the field's error",
        ),
        Claim(
            f"{name}_slices_more_accurate_at_last",
            f"Down-sampled to {nodes}, trace slices are more accurate than the field "
            "after ten steps.",
            errors.quotient[-1],
            1.0,
            "at most",
            "× the field's error",
        ),
        Claim(
            f"{name}_slices_errors_bounded",
            f"Down-sampled to {nodes}, errors of the slices are bounded and do not accumulate.",
            errors.growth["slices"],
            BOUNDED_GROWTH,
            "at most",
            "× from step 1 to 10",
        ),
        Claim(
            f"{name}_slices_errors_below_a_texel",
            f"Beyond: down-sampled to {nodes}, errors of the slices after ten steps stay below "
            "one of their own texels, which is a pixel where that level is drawn.",
            errors.texels,
            1.0,
            "at most",
            "texels",
        ),
    ]


def _figure4(bench: Bench) -> Finding:
    finding = _figure(bench, 4)
    half, quarter = (_measured(bench, "vortex", bench.vortex, 10, f) for f in (2, 4))
    larger = Claim(
        "figure4_field_errors_larger_at_25",
        "With 25 × 25 nodes the error of the field's paths is larger than with 50 × 50.",
        float(quarter.field[-1] / half.field[-1]),
        1.0,
        "at least",
        "× after ten steps",
    )
    return Finding(finding.blocks, finding.numbers, [larger, *finding.claims])


def _others(bench: Bench) -> Finding:
    """Do the same on a swinging double gyre and on vortex shedding."""
    rows: list[Sequence[Any]] = []
    numbers: dict[str, Any] = {}
    claims: list[Claim] = []
    for name, make, step in (
        ("double gyre", lambda: double_gyre_field(time_varying=True), 10),
        ("cylinder", cylinder_field, 12),
    ):
        field = bench.once(("flow", name), make)
        for factor in bench.pick((2, 4), (2,)):
            errors = _measured(bench, name, field, step, factor)
            grid = f"{errors.grid[1]} × {errors.grid[0]}"
            pairs = ((errors.slices[at], errors.field[at]) for at in (0, -1))
            last = float(errors.quotient[-1])
            rows.append((name, grid, *(float(1e3 * e) for pair in pairs for e in pair), last))
            numbers[f"{name}, {FACTOR_WORDS[factor]}"] = _numbers(errors)
            claims.append(
                Claim(
                    f"{name}_{grid}_slices_more_accurate".replace(" × ", "x").replace(" ", "_"),
                    f"{name.capitalize()} with {grid} entries: after ten steps trace slices are "
                    "more accurate than the field.",
                    last,
                    1.0,
                    "at most",
                    "× the field's error",
                )
            )
    caption = "Mean errors of position, in thousandths of the unit of length."
    return Finding([Table(HEAD, rows, caption)], numbers, claims)


HEAD = (
    "flow",
    "entries",
    "slices, 1 step",
    "field, 1 step",
    "slices, 10 steps",
    "field, 10 steps",
    "slices / field",
)

SECTIONS = [
    Section(
        "figure3",
        "Figure 3: paths from 50 × 50 nodes",
        "Section 5, figure 3",
        "Slices of the vortex data, made at 100 × 100 and then averaged down to 50 × 50, are "
        "compared with paths integrated in the field down-sampled to 50 × 50, over 1 to 10 steps. "
        "Errors of the field accumulate; those of the slices are bounded and do not.",
        "The same on this package's vortex field, from step 10 backward, against paths integrated "
        "in the full field with an error of 10⁻⁵ cells a step (10⁻³ in the reduced form). Slices "
        "are averaged as mip levels are; the field keeps every second node. Both are judged at "
        "the slices' entries; the dashed lines are what a renderer meets, between the entries.",
        lambda bench: _figure(bench, 2),
    ),
    Section(
        "figure4",
        "Figure 4: paths from 25 × 25 nodes",
        "Section 5, figure 4",
        "The same from 25 × 25. The errors of the field become larger.",
        "The same with blocks of four by four, and every fourth node of the field.",
        _figure4,
    ),
    Section(
        "figures34_others",
        "Figures 3 and 4 on two more flows",
        "Section 5",
        "Tried on the vortex data alone.",
        "A double gyre that swings, 201 × 101 nodes, and vortex shedding behind a cylinder on an "
        "O-grid of 161 × 65 nodes.",
        _others,
    ),
]
