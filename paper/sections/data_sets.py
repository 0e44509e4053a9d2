"""What tables 1 and 3 share: the data sets, and what the paper says of their sizes."""

from __future__ import annotations

from flowtex.field import FlowField
from paper.bench import Bench

__all__ = ["KILO", "MEGA", "PAIR", "PUBLISHED", "VECTOR", "flows"]

#: Nodes, time steps, kilobytes of the data and megabytes of the slices, as the paper has them.
PUBLISHED: dict[str, tuple[tuple[int, int], int, float, float]] = {
    "post": ((32, 76), 1, 28.5, 1.00),
    "shuttle": ((52, 62), 1, 37.7, 1.32),
    "vortex": ((100, 100), 31, 3747.0, 21.8),
}
KILO, MEGA = 1024.0, 1024.0**2
#: Bytes of two coordinates, and of three components of velocity, in single precision.
PAIR, VECTOR = 8, 12


def flows(bench: Bench) -> dict[str, FlowField]:
    """Return the data sets by name; without the post where it cannot be had."""
    found = {"post": bench.post, "shuttle": bench.shuttle, "vortex": bench.vortex}
    return {name: flow for name, flow in found.items() if flow is not None}
