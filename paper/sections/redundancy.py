"""Section 5 and 6: redundancy between trace slices, and a store without it."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from flowtex.field import FlowField
from flowtex.trace import TraceSlices, trace
from paper.bench import Bench
from paper.compact import compact, error_in_texels, redundancy
from paper.findings import Block, Claim, Finding, Table, Text
from paper.registry import Section

__all__ = ["SECTIONS"]

#: Bound of the error in texels of the noise, and texels of the noise along the surface.
BOUND, RESOLUTION = 0.25, 1024


def _traced(bench: Bench, name: str, field: FlowField) -> TraceSlices:
    """Trace backward slices: of a steady field, or of some time steps of one that varies."""
    if field.steady:
        return bench.once(("compact", name), lambda: trace(field, two_sided=False, progress=False))
    lags = float(np.mean(np.diff(field.times))) * np.arange(1, 11)
    steps = bench.pick((10, 11, 12, 13), (10, 11))
    return trace(field, lags=lags, steps=steps, compose=False, progress=False)


def _one(bench: Bench, name: str, field: FlowField) -> tuple[dict[str, Any], dict[str, float]]:
    slices = _traced(bench, name, field)
    texels = RESOLUTION / max(field.shape)
    common: dict[str, Any] = {"texels": texels, "periodic": field.periodic}
    raw = slices.displacement.nbytes
    started = time.perf_counter()
    exact = compact(slices)
    bounded = compact(slices, BOUND, **common)
    seconds = time.perf_counter() - started
    restored = bounded.restore()
    error = error_in_texels(slices, restored, **common)
    told, shown = redundancy(slices), redundancy(slices, BOUND, **common)
    numbers = {
        "raw_bytes": raw,
        "exact_bytes": exact.slice_bytes,
        "bounded_bytes": bounded.slice_bytes,
        "exact_factor": raw / exact.slice_bytes,
        "bounded_factor": raw / bounded.slice_bytes,
        "bound_texels": BOUND,
        "error_texels": float(np.max(error)),
        "exact_again": bool(np.array_equal(exact.restore().displacement, slices.displacement)),
        "shared_exact": told.share,
        "shared_bounded": shown.share,
        "bits_in_memory": told.raw,
        "bits_left_exact": float(told.given.mean()),
        "bits_alone_bounded": float(shown.alone.mean()),
        "bits_left_bounded": float(shown.given.mean()),
    }
    return numbers, {"seconds": seconds}


def _slices(bench: Bench) -> Finding:
    flows = {"post": bench.post, "shuttle": bench.shuttle, "vortex": bench.vortex}
    numbers, timings, rows = {}, {}, []
    for name, field in flows.items():
        if field is None:
            continue
        found, timings[name] = _one(bench, name, field)
        numbers[name] = found
        rows.append(
            (
                name,
                found["raw_bytes"] / 1024,
                found["exact_bytes"] / 1024,
                found["bounded_bytes"] / 1024,
                found["bounded_factor"],
                found["shared_exact"],
                found["shared_bounded"],
                found["error_texels"],
            )
        )
    head = (
        "data",
        "KB, float32",
        "KB, exact",
        f"KB, within {BOUND:g} texels",
        "times smaller",
        "shared, to the last bit",
        f"shared, to {BOUND:g} texels",
        "greatest error, texels",
    )
    caption = (
        "Shared: part of the bits that a slice does not tell of itself, but its neighbours do. "
        f"Texels of a noise of {RESOLUTION:,} along the longer side."
    )
    blocks: list[Block] = [Table(head, rows, caption), Text(_reading())]
    return Finding(blocks, numbers, _claims(numbers), timings)


def _reading() -> str:
    return (
        "There is much to save, but less of it lies between the slices than the paper believes: "
        "most of what can be predicted of an entry, the entries beside it in the same slice tell. "
        "To the last bit of a float nearly all that is left is rounding and the error of the "
        "integration, which nothing tells; so the room is in not keeping what cannot be seen."
    )


def _claims(numbers: dict[str, Any]) -> list[Claim]:
    claims = []
    for name, found in numbers.items():
        claims += [
            Claim(
                f"redundancy_{name}",
                f"Sections 5 and 6, {name}: slices of adjacent times are highly redundant. Share "
                f"of what a slice does not tell of itself, within {BOUND:g} texels.",
                found["shared_bounded"],
                0.5,
                "at least",
            ),
            Claim(
                f"room_{name}",
                f"Section 5, {name}: there is still a large room to save space, within "
                f"{BOUND:g} texels.",
                found["bounded_factor"],
                2.0,
                "at least",
                "times smaller",
            ),
            Claim(
                f"bound_{name}",
                f"Beyond, {name}: the store keeps its bound.",
                found["error_texels"],
                BOUND,
                "at most",
                "texels",
            ),
        ]
    return claims


SECTIONS = [
    Section(
        "redundancy",
        "Redundancy between slices, taken out",
        "Sections 5 and 6, future work",
        "Slices of adjacent times are believed to be highly redundant, so that much space could "
        "be saved; that is left to future work.",
        "How much slices tell of each other is measured as the entropy that is left when each is "
        "predicted from those of shorter lags. A store takes it out: exactly, or within a bound "
        "in texels of the noise, which is what an error is seen in.",
        _slices,
    )
]
