"""Write ``flowtex/field/earth/coastlines.npz``: the coasts of Natural Earth, packed.

    python tools/coastlines.py land-50m.json

The source is ``land-50m.json`` of the npm package world-atlas (2.0.2): the land of Natural Earth
1:50m, version 4.1, as TopoJSON, whose rings go on across the date line.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Floats

TARGET = Path(__file__).resolve().parents[1] / "flowtex" / "field" / "earth" / "coastlines.npz"
#: What is stored for a degree; a step is 1.1 km.
STEPS_PER_DEGREE = 100
#: South of it lies the edge of the map, at the pole, and no coast.
SOUTHERNMOST_LATITUDE = -89.0


def rings(topology: dict[str, Any]) -> list[Floats]:
    """Return the closed outlines of all land, (N, 2) longitude and latitude in degrees each."""
    scale, translate = (topology["transform"][name] for name in ("scale", "translate"))
    arcs = [np.cumsum(np.array(arc), axis=0) * scale + translate for arc in topology["arcs"]]
    outlines = []
    for geometry in topology["objects"]["land"]["geometries"]:
        for ring in (ring for polygon in geometry["arcs"] for ring in polygon):
            parts = [arcs[i] if i >= 0 else arcs[~i][::-1] for i in ring]
            joined = np.concatenate([parts[0], *(part[1:] for part in parts[1:])])
            if joined[:, 1].min() > SOUTHERNMOST_LATITUDE:
                outlines.append(joined)
    return outlines


def packed(outlines: list[Floats]) -> dict[str, AnyArray]:
    """Return the arrays of the file: steps from point to point, and how many points a ring has."""
    whole = []
    for outline in outlines:
        points = np.round(outline * STEPS_PER_DEGREE).astype(np.int16)
        moved = np.r_[True, (np.diff(points, axis=0) != 0).any(axis=1)]
        if moved.sum() > 3:
            whole.append(points[moved])
    # What does not fit into 16 bits, such as the step across the date line, comes back as well,
    # as sums wrap around in the same way.
    steps = np.diff(np.concatenate(whole), axis=0, prepend=np.zeros((1, 2), np.int16))
    return {"steps": steps, "lengths": np.array([len(ring) for ring in whole], dtype=np.int32)}


if __name__ == "__main__":
    source = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    np.savez_compressed(TARGET, **packed(rings(source)))
