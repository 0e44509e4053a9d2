"""Paths through nodes of sharp edges, which leave the face of their node at once.

Between such a node and a node inside the face, the mean of both paths would lead along neither. So
the path goes straight on in the face for as long as the paths of the neighbours stay in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.arrays import norm, smoothstep
from flowtex.field.triangles.triangle_surface import TriangleSurface

#: Sines of the angles to the face, at the first lag, from none to all of which a path leaves it.
ALONG_FACE = 0.1
OFF_FACE = 0.3
#: Lags, over the longest triangle at the node, from all to none of which it goes straight on.
NEAR_LAG = 1.0
FAR_LAG = 4.0


@dataclass(frozen=True, eq=False)
class EdgePaths:
    """The nodes of sharp edges, E of the nodes in the textures."""

    nodes: Bools  #: Which of the nodes in the textures they are.
    lengths: Floats  #: Length of the longest triangle at each, (E,).

    @classmethod
    def of(cls, surface: TriangleSurface, texels: tuple[slice, AnyArray | slice]) -> EdgePaths:
        """Find the nodes of a surface that lie in the textures."""
        nodes = surface.at_edge[texels]
        return cls(nodes, surface.node_lengths[texels][nodes])

    def sines(self, tangent: AnyArray, moved: AnyArray) -> Floats:
        """Return sines of the angles between velocities and paths, (E,), of all nodes."""
        ahead = tangent[self.nodes].astype(float)
        way = moved[self.nodes].astype(float)
        size = np.maximum(norm(ahead) * norm(way), np.finfo(float).tiny)
        return np.asarray(norm(np.cross(ahead, way)) / size)

    def straighten(
        self, slopes: AnyArray, tangent: AnyArray, sines: Floats, lags: AnyArray
    ) -> None:
        """Let paths that leave their face go straight on for short lags.

        Parameters
        ----------
        slopes
            Slopes of all nodes in the textures; at nodes of sharp edges they are changed in place.
        tangent
            Slopes at lag zero of all nodes.
        sines
            Sines of the angles by which paths leave their face, (E,).
        lags
            Lag of the slopes as a length, for all nodes.
        """
        share = smoothstep(ALONG_FACE, OFF_FACE, sines)
        share *= 1.0 - smoothstep(NEAR_LAG, FAR_LAG, lags[self.nodes] / self.lengths)
        bent = slopes[self.nodes]
        slopes[self.nodes] = bent + share[:, None] * (tangent[self.nodes] - bent)
