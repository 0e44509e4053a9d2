"""Trace slices without what their neighbours tell: smaller, and exact or within a bound.

The paper leaves to future work that slices of adjacent times are alike (section 5). Here each
slice is predicted from those of shorter lags (:mod:`paper.compact.predict`), by the best
of a few ways, and only what the prediction misses is kept: exactly, as the difference of the
floats' bits; or within a bound, as a whole number of steps. Neighbouring entries are subtracted
where that helps, and the rest is compressed (:mod:`paper.compact.residuals`).

The bound is stated in texels of the noise, which is what an error is seen in: a step is wide
where texels are. It holds for every entry of the slices, as every entry is tried; one that would
not keep it is stored exactly. So are reaches, units, NaN and infinities.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.trace.slices import TraceSlices
from paper.compact.blocks import WAYS, Block, Start
from paper.compact.coding import Bounded
from paper.compact.residuals import Writer
from paper.compact.restore import checksum, restored
from paper.compact.tables import add_array

__all__ = ["CompactSlices", "compact"]

#: First bytes of everything that is written, and how the length of the header follows.
MAGIC, LENGTH = b"flowtex-compact-1\n", struct.Struct("<I")
EXPECTED = "expected what compact() made"


@dataclass(frozen=True, eq=False, repr=False)
class CompactSlices:
    """Compressed trace slices, from :func:`compact` or from a file.

    Attributes
    ----------
    data
        Everything, to be written to a file as it is.

    Raises
    ------
    ValueError
        When the bytes are something else, or damaged. Nothing in them is ever executed.
    """

    data: bytes

    def __post_init__(self) -> None:
        """Read what the slices are."""
        _ = self._parts

    @property
    def nbytes(self) -> int:
        """Bytes in all."""
        return len(self.data)

    @property
    def slice_bytes(self) -> int:
        """Bytes of the slices alone, without the slopes at lag zero, reaches, units and nodes."""
        return len(self._parts[1])

    @property
    def bound(self) -> float | None:
        """Greatest error in texels of the noise; ``None`` for exact ones."""
        bound = self._parts[0]["bound"]
        return None if bound is None else float(bound)

    def restore(self) -> TraceSlices:
        """Return the slices, in the precision that they had.

        Raises
        ------
        ValueError
            When the data are damaged, or exact ones come out otherwise than they went in.
        """
        try:
            return restored(*self._parts)
        except (KeyError, IndexError, TypeError, AttributeError, StopIteration) as error:
            msg = f"the compact slices are damaged: {error!r}; {EXPECTED}"
            raise ValueError(msg) from error

    @cached_property
    def _parts(self) -> tuple[dict[str, Any], bytes, bytes]:
        """Header, slices, and all else."""
        start = len(MAGIC) + LENGTH.size
        if not self.data.startswith(MAGIC) or len(self.data) < start:
            msg = f"the data begin with {self.data[: len(MAGIC)]!r}; {EXPECTED}"
            raise ValueError(msg)
        (length,) = LENGTH.unpack_from(self.data, len(MAGIC))
        try:
            header = json.loads(self.data[start : start + length])
            middle = start + length + int(header["length"])
            _ = header["bound"]
        except (ValueError, KeyError, TypeError) as error:
            msg = f"the compact slices are damaged: {error!r}; {EXPECTED}"
            raise ValueError(msg) from error
        return header, self.data[start + length : middle], self.data[middle:]

    def __repr__(self) -> str:
        kind = "exact" if self.bound is None else f"within {self.bound:g} texels"
        return f"CompactSlices({kind}, {self.nbytes / 1e6:.2f} MB)"


def compact(
    slices: TraceSlices,
    bound: float | None = None,
    *,
    texels: ArrayLike = 1.0,
    periodic: tuple[bool, bool] = (False, False),
) -> CompactSlices:
    """Compress trace slices.

    Parameters
    ----------
    slices
        What to compress.
    bound
        Greatest error of a position in texels of the noise, the way along i and that along j
        added; ``None`` to keep everything exactly. Between two lags that double, interpolation
        adds an eighth at most.
    texels, periodic
        Texels per cell, and whether the (j, i) axis goes around; see
        :class:`paper.compact.texels.Texels`. Without a bound they do not count.

    Returns
    -------
    CompactSlices

    Raises
    ------
    ValueError
        When the bound or a number of texels is not positive.
    """
    start = Start.of(slices, bound, texels, periodic)
    found = [block for side in start.encoded(slices) for block in side]
    main, rest = Writer(), Writer()
    header = {
        "bound": bound,
        "parameter": slices.parameter,
        "lags": slices.lags.tolist(),
        "times": slices.times.tolist(),
        "dtype": slices.displacement.dtype.str,
        "blocks": [[WAYS.index(b.way), b.left[b.way].axes] for b in found],
        "beside": [add_array(main, *item) for item in _beside(found, start, slices).items()],
        "rest": [add_array(rest, *item) for item in _rest(slices, start).items()],
        "shift": start.shift,
        "check": checksum(b.restored for b in found) if bound is None else None,
    }
    for block in found:
        main.add(block.left[block.way].folded)
    packed = main.packed()
    text = json.dumps({**header, "length": len(packed)}).encode()
    return CompactSlices(b"".join([MAGIC, LENGTH.pack(len(text)), text, packed, rest.packed()]))


def _beside(found: list[Block], start: Start, slices: TraceSlices) -> dict[str, NDArray[Any]]:
    """Return what the blocks need to be read: steps, and values that are kept as they are."""
    size = slices.displacement[:, 0].size
    kept: dict[str, NDArray[Any]] = {
        "where": np.concatenate([b.where + n * size for n, b in enumerate(found)]),
        "raw": np.concatenate([b.raw for b in found]),
    }
    if isinstance(start.coding, Bounded):
        kept["exponent"] = start.coding.exponent
    return kept


def _rest(slices: TraceSlices, start: Start) -> dict[str, NDArray[Any]]:
    """All other arrays."""
    rest = {"unit": slices.unit, "nodes": slices.nodes, "reach": slices.reach, "rate": start.slope}
    if slices.forward_reach is not None:
        rest["forward_reach"] = slices.forward_reach
    return rest
