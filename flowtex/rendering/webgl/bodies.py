"""Other objects of a scene: meshes, lines, points and labels in their own colours.

A client draws them with the flow, and hides each behind what lies before it. All meshes are in a
few parts together; the header says which triangles and pieces of lines belong to which body.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from flowtex._util.array_types import Bytes, Floats, Indices
from flowtex.rendering.webgl.protocol import Header, Parts
from flowtex.textures.geometry import DrawnSurface

MOST_VERTICES = 500_000  #: Most vertices of all meshes together that are sent to a browser.
MOST_LABELS = 500  #: Most labels that are sent to a browser.
NORMAL_MAX = 127  #: Greatest component of a normal in eight bits.
BEYOND = 1.01  #: Factor by which the depths in view reach beyond the farthest vertex.


@dataclass(frozen=True, eq=False)
class Body:
    """A mesh in its own colours."""

    points: Floats  #: Vertices in the mesh's own coordinates, (N, 3).
    colours: Bytes  #: Red, green, blue and opacity of each, (N, 4) uint8.
    faces: Indices  #: Corners of triangles, (M, 3).
    pieces: Indices  #: Ends of pieces of lines, (L, 2); twice the same vertex is a point.
    #: Unit normals of smooth faces, (N, 3); drawing computes the normals of flat faces.
    normals: Floats | None = None
    width: float = 1.0  #: Width of lines and points in pixels.
    ambient: float = 1.0  #: Shares of ambient light and of diffuse light.
    diffuse: float = 0.0


@dataclass(frozen=True)
class Label:
    """A text at a point, in pixels of the page, on a plate unless its opacity is 0."""

    text: str
    position: tuple[float, ...]
    size: float
    color: tuple[float, ...]
    plate: tuple[float, ...]


@dataclass(frozen=True)
class Light:
    """A distant light: unit vector and colour; one that ``turns`` does so with the camera."""

    way: tuple[float, ...]
    color: tuple[float, ...]
    turns: bool


@dataclass(frozen=True, eq=False)
class Bodies:
    """All other objects of a scene."""

    meshes: tuple[Body, ...] = ()
    labels: tuple[Label, ...] = ()
    lights: tuple[Light, ...] = ()

    def header(self) -> Header:
        """Return their part of the header."""
        face = piece = 0
        runs = []
        for body in self.meshes:
            runs.append(
                {
                    "faces": [face, len(body.faces)],
                    "pieces": [piece, len(body.pieces)],
                    "clear": bool((body.colours[:, 3] < 255).any()),
                    "width": float(body.width),
                    "ambient": float(body.ambient),
                    "diffuse": float(body.diffuse),
                }
            )
            face = face + len(body.faces)
            piece = piece + len(body.pieces)
        return {
            "runs": runs,
            "labels": [asdict(label) for label in self.labels],
            "lights": [asdict(light) for light in self.lights],
        }

    def reach(self, geometry: DrawnSurface) -> float:
        """Distance of the farthest vertex from the middle of a surface."""
        away = (np.linalg.norm(b.points - geometry.center, axis=1).max() for b in self.meshes)
        return BEYOND * float(max(away, default=0.0))

    def parts(self, geometry: DrawnSurface) -> Parts:
        """Return the arrays, in a surface's own frame."""
        if not self.meshes:
            return {}
        points = np.concatenate([body.points for body in self.meshes])
        normals = np.concatenate(
            [np.zeros_like(b.points) if b.normals is None else b.normals for b in self.meshes]
        )
        starts = np.cumsum([0, *(len(body.points) for body in self.meshes)])
        numbered = list(zip(starts, self.meshes, strict=False))
        faces = np.concatenate([first + body.faces for first, body in numbered])
        pieces = np.concatenate([first + body.pieces for first, body in numbered])
        return {
            "bodyPoints": ((points - geometry.center) @ geometry.frame.T).astype("<f4"),
            "bodyNormals": np.rint(NORMAL_MAX * normals @ geometry.frame.T).astype(np.int8),
            "bodyColours": np.concatenate([body.colours for body in self.meshes]),
            "bodyFaces": faces.astype("<u4"),
            "bodyPieces": pieces.astype("<u4"),
        }
