"""Table 1: sizes of the data."""

from __future__ import annotations

from paper.bench import Bench
from paper.data_sets import KILO, PUBLISHED, VECTOR_BYTES
from paper.findings import Claim, Finding, Section, Table


def _table1(bench: Bench) -> Finding:
    rows, numbers, claims = [], {}, []
    for name, field in bench.published.items():
        shape, steps, published, _ = PUBLISHED[name]
        ours = (
            field.points.shape[0] * field.points.shape[1] * len(field.times) * VECTOR_BYTES / KILO
        )
        rows.append(
            (
                name,
                "{} × {}".format(*shape),
                steps,
                published,
                "{} × {}".format(*sorted(field.shape)),
                ours,
                ours / 2,
            )
        )
        numbers[name] = {"shape": sorted(field.shape), "steps": len(field.times), "kilobytes": ours}
        claims.append(
            Claim(
                f"table1_{name}_size",
                f"Table 1, {name}: three components in single precision take the published size.",
                100 * abs(ours - published) / published,
                5.0,
                "at most",
                "% apart",
            )
        )
    head = (
        "data",
        "nodes, paper",
        "steps",
        "KB, paper",
        "nodes, here",
        "KB, float32",
        "KB, half precision",
    )
    return Finding([Table(head, rows)], numbers, claims)


SECTIONS = [
    Section(
        "table1",
        "Table 1: the data",
        "Section 5, table 1",
        "Three data sets: the post with 32 × 76 nodes and 28.5 KB, the shuttle with 52 × 62 and "
        "37.7 KB, both steady and curvilinear; the vortex with 100 × 100 nodes over 31 steps and "
        "3747 KB, Cartesian.",
        "The post is the public PLOT3D file, plane k = 20, of which the inner 32 of 38 rings are "
        "taken. The shuttle and the vortex data were not published; a delta wing and a field of "
        "decaying turbulence of the same dimensions take their places.",
        _table1,
    ),
]
