"""Table 3: sizes of the trace slices."""

from __future__ import annotations

from flowtex.field import FlowField
from flowtex.trace.slices import choose_lags
from paper.bench import Bench
from paper.data_sets import KILO, MEGA, PAIR_BYTES, PUBLISHED, VECTOR_BYTES
from paper.findings import Claim, Finding, Section, Table, Text

#: Convolution size of the paper, and slices of a steady field that its sizes come to.
K, STEADY_SLICES = 10, 54


HEAD = (
    "data",
    "MB, paper",
    "MB, as the paper seems to count",
    "slices of that",
    "MB, K = 10",
    "MB here, float32",
    "MB here, half precision",
)


def _slices(field: FlowField) -> dict[str, int]:
    """Count slices: the paper's K, those that its sizes come to, and those of this package."""
    steps = len(field.times)
    # A field that varies has lags from 0 to K, as far as there are earlier time steps.
    published = STEADY_SLICES if field.steady else sum(min(step, K) + 1 for step in range(steps))
    parameter = "arclength" if field.steady else "time"
    return {"k": K * steps, "told": published, "ours": len(choose_lags(field, parameter)) * steps}


def _table3(bench: Bench) -> Finding:
    rows, numbers, claims = [], {}, []
    for name, field in bench.published.items():
        published = PUBLISHED[name][3]
        nodes, count = field.points[..., 0].size, _slices(field)
        size = {key: nodes * number * PAIR_BYTES / MEGA for key, number in count.items()}
        rows.append(
            (
                name,
                published,
                size["told"],
                count["told"],
                size["k"],
                size["ours"],
                size["ours"] / 2,
            )
        )
        numbers[name] = {
            "published": published,
            "slices": count,
            "megabytes_told": size["told"],
            "megabytes_k10": size["k"],
            "megabytes_float32": size["ours"],
            "megabytes_half": size["ours"] / 2,
            "over_data_published": published * MEGA / (PUBLISHED[name][2] * KILO),
            "over_data_half": size["ours"] / 2 * MEGA / (nodes * len(field.times) * VECTOR_BYTES),
        }
        claims += _claims(name, size)
    caption = (
        "Backward slices of all time steps. Here lags double from a quarter of a cell to a quarter "
        "of the surface, so that a dozen of slices serve every zoom. Drawing steady flow to both "
        "sides takes as much again."
    )
    return Finding([Table(HEAD, rows, caption), Text(_reading())], numbers, claims)


def _reading() -> str:
    return (
        "The published sizes come out to the last digit (the paper cuts digits off) with pairs of "
        f"single floats: {STEADY_SLICES} slices for the steady data, far more than K = 10; and for "
        "the vortex data lags 0 to 10 as far as earlier steps exist, 286 slices. Many lags are "
        "what adapted steps need: a step doubles with each level of detail, so ten even lags only "
        "serve one zoom. Lags that double serve all of them."
    )


def _claims(name: str, size: dict[str, float]) -> list[Claim]:
    published = PUBLISHED[name][3]
    return [
        Claim(
            f"table3_{name}_size",
            f"Table 3, {name}: the published size of the slices can be arrived at.",
            100 * abs(size["told"] - published) / published,
            1.0,
            "at most",
            "% apart",
        ),
        Claim(
            f"table3_{name}_moderate",
            f"Table 3, {name}: the overhead is moderate. In half precision, all zooms, against "
            "the published size.",
            size["ours"] / 2 / published,
            1.0,
            "at most",
            "× the published size",
        ),
    ]


SECTIONS = [
    Section(
        "table3",
        "Table 3: size of the trace slices",
        "Section 5, table 3",
        "1.00 MB for the post, 1.32 MB for the shuttle, 21.8 MB for the vortex with all its time "
        "steps; moderate, and with much room to save since slices of neighbouring times repeat "
        "each other.",
        "Sizes of this package's slices in single and in half precision. How redundant they are "
        "is measured in a section of its own.",
        _table3,
    ),
]
