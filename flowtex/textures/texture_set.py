"""TraceSlices as textures.

A layer does not hold a displacement D(s) at lag s but the mean slope D(s) / s since lag zero, with
s negative backward. It is of order one at every lag, so half precision serves.

====================  =====================================================  =================
layer                 first three channels                                   fourth channel
====================  =====================================================  =================
0                     slope at lag zero                                      unit of lag
1 ... M               slopes of the backward slices                          1: reach; 2: speed
M + 1 ... 2 M         slopes of the forward slices, where there are any      M + 1: reach
the last              of streamlines: layer 0 in cells, two channels;        speed
                      sine of the angle by which paths leave their face
====================  =====================================================  =================

Layers 3 and M + 3 have the uncertainty of the direction. The speed in layer 2 is that of
:func:`flowtex.textures.crossing.shown_speed`. Slopes are in space, lengths per unit of
nominal length; in image coordinates per unit of lag for an image in place of the noise.
"""

from __future__ import annotations

import contextvars
import os
from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from flowtex._util.array_types import AnyArray, Floats, Floats32, Halves
from flowtex._util.arrays import dot, norm
from flowtex._util.forks import renew_after_fork
from flowtex._util.progress import pool
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.folds import ROWS_OF_FOLDS
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.field.uncertainty import unknown_share
from flowtex.field.validation import three_components
from flowtex.settings import SettingsError
from flowtex.textures.crossing import shown_speed
from flowtex.textures.edge_paths import EdgePaths
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.images import ImageTextures
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.textures.triangle_geometry import TriangleGeometry
from flowtex.trace.slices import TraceSlices, typical_speed
from flowtex.trace.store import SliceStore

MOST_LAGS = 32  #: Most slices on each side, by the room in a shader.
UNCERTAIN_LAYER = 3  #: The layer whose fourth channel is the uncertainty of the direction.
HALF_MAX = 65504.0  #: Greatest number in half precision, in which texels are stored.
SLOPE_ERROR = 2.0**-12  #: Relative error that is allowed in a slope: half of the rounding error.
EDGE_CELLS = 2.0  #: Cells that a path goes in a triangle at a sharp edge for one elsewhere.
AGREED = 0.99  #: Length of the mean velocity over the mean length where nodes agree.


@dataclass(frozen=True, eq=False)
class TextureSet:
    """The data of a flow for a renderer.

    Slopes are in image coordinates with an image, or with noise that is a texture.
    """

    geometry: SurfaceGeometry | TriangleGeometry
    store: SliceStore
    image: ImageTextures | None = None
    #: In a tile, the typical speed of the whole flow, and how long its paths have to be.
    whole_speed: float | None = None
    longest: float = np.inf

    @classmethod
    def build(cls, store: SliceStore, image: Floats32 | None = None) -> TextureSet:
        """Make the textures of a flow from its traced slices.

        Parameters
        ----------
        store
            The slices.
        image
            Image that is drawn along the flow, in place of noise.

        Raises
        ------
        FieldError
            When the slices have too few or too many lags.
        SettingsError
            When an image is given for a surface of triangles.
        """
        field = store.field
        if field.uncertainty:
            least = UNCERTAIN_LAYER
        else:
            least = 2
        if not least <= len(store.lags) <= MOST_LAGS:
            raise FieldError(
                f"{len(store.lags)} lags were traced; drawing needs {least} to {MOST_LAGS}"
            )
        kind: type[SurfaceGeometry | TriangleGeometry] = SurfaceGeometry
        if field.triangles is not None:
            kind = TriangleGeometry
        textures = cls(kind.of(field), store)
        if image is None:
            return textures
        check_noise(field, "image")
        return replace(textures, image=ImageTextures.build(store, image))

    def with_noise(self, resolution: int, seed: int, *, corrected: bool = True) -> TextureSet:
        """Return the same with a mipmapped noise texture over the parameters of the surface.

        Parameters
        ----------
        resolution
            Number of texels along the longer side of the surface.
        seed
            Seed of the noise.
        corrected
            Whether the noise is even on the surface; otherwise it is even over the cells.

        Raises
        ------
        SettingsError
            When the surface consists of triangles.
        """
        check_noise(self.geometry.field, "texture")
        noise = NoiseTextures.of(self.store, resolution, seed, corrected=corrected)
        return replace(self, image=noise)

    def with_image(self, image: Floats32) -> TextureSet:
        """Return the same with another image."""
        assert self.image is not None
        return replace(self, image=replace(self.image, texels=image))

    def same_paths(self, other: TextureSet) -> bool:
        """Return whether only the image differs."""
        if self.geometry is not other.geometry or self.image is None or other.image is None:
            return False
        return self.image.step is other.image.step

    @property
    def grid(self) -> SurfaceGeometry:
        """The geometry of a structured surface."""
        assert isinstance(self.geometry, SurfaceGeometry)
        return self.geometry

    @property
    def sides(self) -> int:
        """1 when paths lead backward only, 2 when forward too."""
        if self.store.two_sided:
            return 2
        return 1

    @cached_property
    def pace(self) -> float:
        """Nominal length of a unit of ``store.unit``: 1 by arc length, a typical speed by time."""
        if self.store.parameter == "arclength":
            return 1.0
        return self.typical_speed

    @cached_property
    def typical_speed(self) -> float:
        """Typical speed of the field, or of the whole field if it is a part."""
        return self.whole_speed or typical_speed(self.geometry.field)

    @cached_property
    def unit(self) -> float:
        """Length that the fourth channel of layer 0 is measured in."""
        return float(np.median(self.store.unit[self.geometry.field.valid])) * self.pace

    @property
    def lags(self) -> Floats32:
        """Lags of the slices, (M,), in multiples of the unit at each node."""
        return self.store.lags.astype(np.float32)

    @property
    def count(self) -> int:
        """Number of layers."""
        return 1 + self.sides * len(self.store.lags) + self.in_cells

    @property
    def in_cells(self) -> bool:
        """Whether the last layer holds the velocity in cells."""
        has_direction = self.store.streamlines and not self.geometry.field.sign_free
        return has_direction and self.image is None

    @cached_property
    def cell(self) -> float:
        """Length of a cell that the last layer's velocities are measured in."""
        return float(np.median(self.geometry.field.surface.cell_size[self.geometry.field.valid]))

    @cached_property
    def critical_cell(self) -> float:
        """Length of the longest cell whose nodes may not agree on the direction; 0 if all do."""
        if not self.in_cells:
            return 0.0
        field = self.geometry.field
        if field not in _critical_cells:
            _critical_cells[field] = self._critical_cell(field)
        return _critical_cells[field]

    def _critical_cell(self, field: FlowField) -> float:
        """Return the size of the largest cell in which the flow has different directions."""
        corners = field.surface.cell_corners
        cells = field.surface.cells
        lengths = field.surface.cell_lengths
        # Paths go over sharp edges out of the plane of a triangle, and follow it from farther away.
        at_edge = field.surface.at_edge
        edge = np.zeros_like(cells)
        for corner in corners:
            edge |= at_edge[corner]
        edge &= cells
        longest = EDGE_CELLS * float(lengths[edge].max(initial=0.0))
        if not field.steady:
            return max(float(lengths[cells].max(initial=0.0)), longest)
        flow = field.index_velocity.components[0]
        tangents = field.surface.tangents
        along = flow[..., :1] * tangents[0] + flow[..., 1:] * tangents[1]
        length = norm(along)[..., None]
        along = np.divide(along, length, out=np.zeros_like(along), where=length > 0)
        # A flow that leaves the plane of a triangle has another direction in it.
        mean = field.surface.in_cells(sum((along[at] for at in corners[1:]), along[corners[0]]))
        mean /= np.maximum(norm(mean), np.finfo(float).tiny)[..., None]
        # A node at rest has no direction.
        parting = np.zeros_like(cells)
        for corner in corners:
            moves = length[corner][..., 0] > 0
            parting |= moves & (dot(along[corner], mean) < AGREED)
        parting &= cells
        return max(float(lengths[parting].max(initial=0.0)), longest)

    def forget(self) -> None:
        """Drop data that are only needed to make layers."""
        self.store.forget()
        self.geometry.field.forget()
        for name in ("_displacements", "_edge_paths", "_length"):
            self.__dict__.pop(name, None)

    def layers(self, step: int = 0, dtype: type = np.float16) -> AnyArray:
        """Return texels (layers, H, W, 4) of a destination time, rounded here, not by drivers."""
        all_nodes = self.store.at(step)
        slices = all_nodes.part(*self.geometry.texels)
        tangent = self._tangent(all_nodes)
        result: AnyArray = np.empty((self.count, *self.geometry.size, 4), dtype)

        def make(layer: int) -> None:
            nodal = self._nodal(slices, tangent, layer)
            self.geometry.write_texels(np.clip(nodal, -HALF_MAX, HALF_MAX, nodal), result[layer])

        with pool(min(os.cpu_count() or 1, 8), "flowtex-layers") as threads:
            list(threads.map(make, range(self.count)))
        return result

    def _nodal(self, slices: TraceSlices, tangent: AnyArray, layer: int) -> Floats32:
        """Return a layer of the texture at the nodes, (J, I, 4)."""
        result = np.zeros((*slices.shape, 4), np.float32)
        if layer == 0:
            result[..., :3] = tangent
            result[..., 3] = slices.unit * self.pace / self.unit
            return result
        if self.in_cells and layer == self.count - 1:
            result[..., :2] = slices.rate[0] * (self.cell / self.unit)
            self._mark_edges(slices, tangent, result[..., 2])
            # Tangents by arc length do not contain the speed.
            timed = self.store.parameter == "time"
            result[..., 3] = 1.0
            if not timed:
                result[..., 3] = np.maximum(self._speed(slices), 0.0)
            return result
        side, m = divmod(layer - 1, len(slices.lags))
        sign = -1.0
        displacement = slices.displacement
        reach = slices.reach
        if side and slices.forward is not None and slices.forward_reach is not None:
            sign = 1.0
            displacement = slices.forward
            reach = slices.forward_reach
        self._write_tangents(displacement[0, m], sign, float(slices.lags[m]), slices.nodes, result)
        self._straighten(slices, tangent, (side, m), result[..., :3])
        if m == 0:
            # Nodes at rest leave the reach to their neighbours.
            still = ~np.abs(slices.rate[0]).any(axis=-1)
            last = 2 * float(self.store.lags[-1])
            result[..., 3] = np.where(still, np.inf, reach[0]).clip(max=last)
        if layer == 2:
            result[..., 3] = self._speed(slices)
        if m + 1 == UNCERTAIN_LAYER and (field := self.geometry.field).uncertainty:
            result[..., 3] = unknown_share(field, self._step(slices))[self.geometry.texels]
        return result

    def _write_tangents(
        self, displacement: AnyArray, sign: float, lag: float, nodes: AnyArray, result: AnyArray
    ) -> None:
        """Write displacements, in cells, as mean tangents by lag, in the image or in space."""
        scale = sign / lag
        if self.image is not None:
            moved = self.image.at(nodes + displacement) - self.image.coordinate
            result[..., :2] = moved * scale
            return
        by_length = np.float32(scale) / self._length[..., 0]
        least = float(np.min(self.store.unit[self.geometry.field.valid]))
        error = SLOPE_ERROR * lag * least * self.pace
        for channel, moved in enumerate(self._displacements(displacement, error)):
            np.multiply(moved, by_length, out=result[..., channel])

    def _straighten(
        self, slices: TraceSlices, tangent: AnyArray, number: tuple[int, int], slopes: AnyArray
    ) -> None:
        """Let paths that leave their faces go straight on, in the slice ``number`` of a side."""
        if self._edge_paths is None:
            return
        side, m = number
        length = float(slices.lags[m]) * self._length[..., 0]
        sines = self._leaving(slices, tangent, side)
        self._edge_paths.straighten(slopes, tangent, sines, length)

    def _mark_edges(self, slices: TraceSlices, tangent: AnyArray, channel: AnyArray) -> None:
        """Write how paths of any side leave their faces."""
        if self._edge_paths is None:
            return
        by_side = [self._leaving(slices, tangent, side) for side in range(self.sides)]
        channel[self._edge_paths.nodes] = np.max(by_side, axis=0)

    def _leaving(self, slices: TraceSlices, tangent: AnyArray, side: int) -> Floats:
        """Return the sines by which paths to a side leave their faces at sharp edges."""
        assert self._edge_paths is not None
        moved = slices.displacement
        if side and slices.forward is not None:
            moved = slices.forward
        return self._edge_paths.sines(tangent, moved[0, 0] @ self.geometry.frame.T)

    @cached_property
    def _edge_paths(self) -> EdgePaths | None:
        """Nodes of sharp edges, if there are any."""
        surface = self.geometry.field.surface
        if not isinstance(surface, TriangleSurface) or not surface.at_edge.any():
            return None
        return EdgePaths.of(surface, self.geometry.texels)

    def _speed(self, slices: TraceSlices) -> AnyArray:
        field = self.geometry.field
        step = self._step(slices)
        return shown_speed(field, step, self.typical_speed)[self.geometry.texels]

    def _step(self, slices: TraceSlices) -> int:
        return int(np.argmin(np.abs(self.geometry.field.times - slices.times[0])))

    def _tangent(self, slices: TraceSlices) -> AnyArray:
        """Return slopes at lag zero of the nodes in the textures, from the slices of all nodes."""
        rate = slices.rate[0]
        texels = self.geometry.texels
        if self.image is not None:
            return three_components(rate * self.image.by_cell())
        surface = self.geometry.field.surface
        p_i, p_j = surface.tangents
        along = rate[..., :1] * p_i + rate[..., 1:] * p_j
        for pole in surface.poles or ():
            # A point has one slope; each of its nodes holds the component in its own unit.
            unit = pole.lines(slices.unit)[pole.line]
            across = pole.lines(rate)[pole.line, :, pole.component] / unit
            slope = pole.vector(across) @ pole.plane
            pole.lines(along)[pole.line] = unit[:, None] * slope
        if (sharp := surface.sharp).any():
            # Each face of a sharp edge takes the part of the velocity that lies in it.
            velocity = self.geometry.field.velocity[self._step(slices)][sharp]
            length = np.maximum(norm(velocity), np.finfo(float).tiny)
            along[sharp] = velocity * (norm(along[sharp]) / length)[:, None]
        return np.asarray(along[texels] @ self.geometry.frame.T) / self._length

    @cached_property
    def _displacements(self) -> Callable[[AnyArray, float], AnyArray]:
        """Map of displacements to the surface's frame; a flat one has no third component."""
        geometry = self.geometry
        if geometry.planar:
            return geometry.displacements(geometry.frame[:2])
        return geometry.displacements(geometry.frame)

    @cached_property
    def _length(self) -> Floats32:
        length = (self.store.unit * self.pace)[self.geometry.texels]
        return length[..., None].astype(np.float32)


#: Critical cells by field, because the tiles of a window share its field.
_critical_cells: WeakKeyDictionary[FlowField, float] = WeakKeyDictionary()


def check_noise(field: FlowField, noise: str) -> None:
    """Check that a field can be drawn with a kind of noise.

    Raises
    ------
    SettingsError
        When the surface consists of triangles and the noise is not ``"procedural"``.
    """
    if noise != "procedural" and field.triangles is not None:
        raise SettingsError(
            f"noise is {noise!r}, which needs rows and columns, but this surface consists of "
            f"triangles; expected noise='procedural'. {ROWS_OF_FOLDS}"
        )


class LayerPrefetch:
    """Layers of a texture set by time, one of them computed by a thread before it is needed."""

    def __init__(self, textures: TextureSet) -> None:
        self._textures = textures
        self._pool: Executor | None = None
        self._ready: tuple[int, Future[Halves]] | None = None
        renew_after_fork(self)

    def renew(self) -> None:
        """Forget, in a forked process, layers that a thread of the process before makes."""
        if self._ready is not None and not self._ready[1].done():
            self._ready = None

    def prepare(self, step: int) -> None:
        """Begin to compute the layers of a step, if it exists, as work of this thread."""
        if not 0 <= step < self._textures.store.steps:
            return
        if self._ready is not None:
            if self._ready[0] == step:
                return
            self._ready[1].cancel()
        if self._pool is None:
            self._pool = pool(1, "flowtex-prefetch")
        make = contextvars.copy_context().run
        self._ready = step, self._pool.submit(make, self._textures.layers, step)

    def take(self, step: int) -> Halves:
        """Return the layers of a step, (layers, H, W, 4), prepared or computed now."""
        ready = self._ready
        self._ready = None
        if ready is None or ready[0] != step:
            self._ready = ready
            return self._textures.layers(step)
        return ready[1].result()

    def close(self) -> None:
        """Stop the thread."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
        self._pool = self._ready = None
