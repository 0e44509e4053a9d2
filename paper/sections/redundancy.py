"""Sections 5 and 6: redundancy between trace slices."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex.field import FlowField
from flowtex.trace.slices import TraceSlices
from flowtex.trace.trace import trace
from paper.bench import Bench
from paper.findings import Block, Claim, Finding, Section, Table, Text
from paper.redundancy import error_in_texels, redundancy

#: Bound of the error in texels of the noise, and texels of the noise along the surface.
BOUND_TEXELS, RESOLUTION = 0.25, 1024
READING = (
    "There is much to save, but less of it lies between the slices than the paper believes: "
    "most of what can be predicted of an entry follows from the entries beside it in the same "
    "slice. To the last bit of a float nearly all that is left is rounding and the error of the "
    "integration, which nothing predicts; the room is in not storing what cannot be seen."
)


def _traced(bench: Bench, field: FlowField) -> TraceSlices:
    """Trace backward slices: of a steady field, or of some time steps of one that varies."""
    if field.steady:
        return trace(field, two_sided=False, progress=False)
    lags = float(np.mean(np.diff(field.times))) * np.arange(1, 11)
    steps = bench.pick((10, 11, 12, 13), (10, 11))
    return trace(field, lags=lags, steps=steps, compose=False, progress=False)


def _measured(bench: Bench, field: FlowField) -> dict[str, Any]:
    slices = _traced(bench, field)
    common: dict[str, Any] = {"texels": RESOLUTION / max(field.shape), "periodic": field.periodic}
    exact, bounded = redundancy(slices), redundancy(slices, BOUND_TEXELS, **common)
    bits = {"exact": exact.by_neighbours.mean(), "bounded": bounded.by_neighbours.mean()}
    data, decoded = slices.displacement, exact.decoded.displacement
    return {
        "raw_bytes": data.nbytes,
        "bits_in_memory": exact.raw,
        "bits_left_exact": float(bits["exact"]),
        "bits_alone_bounded": float(bounded.alone.mean()),
        "bits_left_bounded": float(bits["bounded"]),
        "exact_factor": float(exact.raw / bits["exact"]),
        "bounded_factor": float(exact.raw / bits["bounded"]),
        "shared_exact": exact.share,
        "shared_bounded": bounded.share,
        "exact_again": data.tobytes() == decoded.tobytes(),
        "bound_texels": BOUND_TEXELS,
        "error_texels": error_in_texels(slices, bounded.decoded, **common),
    }


def _redundancy(bench: Bench) -> Finding:
    numbers = {name: _measured(bench, field) for name, field in bench.published.items()}
    columns = {
        "KB, float32": lambda row: row["raw_bytes"] / 1024,
        "bits left, exact": lambda row: row["bits_left_exact"],
        f"bits left, within {BOUND_TEXELS:g} texels": lambda row: row["bits_left_bounded"],
        "times fewer": lambda row: row["bounded_factor"],
        "shared, to the last bit": lambda row: row["shared_exact"],
        f"shared, to {BOUND_TEXELS:g} texels": lambda row: row["shared_bounded"],
        "greatest error, texels": lambda row: row["error_texels"],
    }
    rows = [(name, *(of(row) for of in columns.values())) for name, row in numbers.items()]
    caption = (
        "Bits left of the 32 of a number, as entropy. Shared: part of the bits left of a slice by "
        "itself that its neighbours predict. "
        f"Texels of a noise of {RESOLUTION:,} along the longer side."
    )
    blocks: list[Block] = [Table(("data", *columns), rows, caption), Text(READING)]
    return Finding(blocks, numbers, _claims(numbers))


def _claims(numbers: dict[str, Any]) -> list[Claim]:
    claims = []
    for name, row in numbers.items():
        claims += [
            Claim(
                f"redundancy_{name}",
                f"Sections 5 and 6, {name}: slices of adjacent times are highly redundant. Share "
                "of the bits left of a slice by itself that its neighbours predict, within "
                f"{BOUND_TEXELS:g} texels.",
                row["shared_bounded"],
                0.5,
                "at least",
            ),
            Claim(
                f"room_{name}",
                f"Section 5, {name}: there is still a large room to save space, within "
                f"{BOUND_TEXELS:g} texels. Bits in memory over the entropy of what is left.",
                row["bounded_factor"],
                2.0,
                "at least",
                "times fewer",
            ),
            Claim(
                f"bound_{name}",
                f"Beyond, {name}: rounding what is left keeps the bound.",
                row["error_texels"],
                BOUND_TEXELS,
                "at most",
                "texels",
            ),
        ]
    return claims


SECTIONS = [
    Section(
        "redundancy",
        "Redundancy between slices",
        "Sections 5 and 6, future work",
        "Slices of adjacent times are believed to be highly redundant, so that much space could "
        "be saved; that is left to future work.",
        "Each slice is predicted from those of shorter lag: along its paths, and composed of the "
        "shorter paths that begin where they come by. What is left is measured as entropy: "
        "exactly, or within a bound in texels of the noise, which is what an error is seen in.",
        _redundancy,
    )
]
