"""The paper's data sets where they can be had, flows of the same kind where not, their sizes."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from flowtex import examples
from flowtex.errors import FieldError
from flowtex.field import FlowField

#: Nodes, time steps, kilobytes of the data and megabytes of the slices, as the paper has them.
PUBLISHED: dict[str, tuple[tuple[int, int], int, float, float]] = {
    "post": ((32, 76), 1, 28.5, 1.00),
    "shuttle": ((52, 62), 1, 37.7, 1.32),
    "vortex": ((100, 100), 31, 3747.0, 21.8),
}
KILO, MEGA = 1024.0, 1024.0**2
#: Bytes of two coordinates, and of three components of velocity, in single precision.
PAIR_BYTES, VECTOR_BYTES = 8, 12


#: Rings of the post that the paper has; the public file has six more outside.
RINGS = 32
#: Grid of the post, and the plane that is shown.
GRID, PLANE = "postxyz.bin", "k=20"
#: How far the grid of the gyre bulges, and the power that crowds its rows to one side.
BULGE, CROWDING = 0.12, 1.3


def post(folder: Path | None = None) -> FlowField | None:
    """Return the inner 32 x 76 nodes of the liquid-oxygen post, or ``None`` where it cannot be had.

    Parameters
    ----------
    folder
        Folder of the two files; by default the one that the environment variable
        ``FLOWTEX_DATA`` names, or else what PyVista downloads.
    """
    named = os.environ.get("FLOWTEX_DATA")
    where = folder if folder is not None else Path(named) if named else None
    try:
        whole = FlowField.from_file(_downloaded() if where is None else where / GRID, plane=PLANE)
    except (OSError, FieldError):
        return None
    return FlowField.from_arrays(
        whole.points[:, :RINGS],
        whole.velocity[0, :, :RINGS],
        valid=whole.valid[:, :RINGS],
        periodic="j",
        name="post",
    )


def _downloaded() -> Path:
    """Return the path of the grid in PyVista's collection, which has the solution beside it."""
    from pyvista.examples import downloads

    paths = [Path(str(downloads.download_file(name))) for name in (GRID, "postq.bin")]
    return paths[0]


def shuttle() -> FlowField:
    """Return a delta wing of 52 x 62 nodes: curved, with cells of very different sizes."""
    return examples.delta_wing_field()


def vortex() -> FlowField:
    """Return decaying turbulence on 100 x 100 nodes over 31 time steps."""
    return examples.vortex_field()


def gyre(rows: int = 60, columns: int = 120) -> FlowField:
    """Return the steady double gyre on a sheared grid whose cells differ."""
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    x = 2 * (s + 0.06 * np.sin(2 * np.pi * s)) + BULGE * np.sin(np.pi * t)
    y = t**CROWDING
    points = np.stack([x, y], axis=-1)
    return FlowField.from_arrays(
        points, examples.double_gyre_velocity(points, 0.0, epsilon=0.0), name="double gyre"
    )


def stretched(rows: int = 52, columns: int = 62) -> FlowField:
    """Return the steady double gyre on 52 x 62 nodes whose cells grow to the right and upwards."""
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    points = np.stack([2 * s**2.5, np.expm1(3 * t) / np.expm1(3)], axis=-1)
    return FlowField.from_arrays(
        points, examples.double_gyre_velocity(points, 0.0, epsilon=0.0), name="stretched gyre"
    )
