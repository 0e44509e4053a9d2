"""Data of the Earth that stay open: their choices, and one field after another."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from flowtex.errors import FieldError
from flowtex.field.earth import GLOBE, NAMES
from flowtex.field.field import FlowField
from flowtex.sources.datasets.axes import LEVEL, Choice, axis_values, choose
from flowtex.sources.datasets.flow import read_flow
from flowtex.sources.datasets.select import find_pairs, two_names, variable
from flowtex.sources.files import one_path
from flowtex.sources.maps.grid_map import projection_of
from flowtex.sources.mesh_source import FlowSource, Source
from flowtex.sources.notices import DatasetNotice
from flowtex.sources.opening.dataset_files import common_name, dataset_paths, open_datasets
from flowtex.sources.opening.series import as_datasets
from flowtex.sources.reader_errors import errors_of_file
from flowtex.sources.record import Record


class DatasetSource(Source):
    """Datasets of xarray's that belong together; blocks are the maps they can be drawn on."""

    def __init__(self, datasets: Any, *, name: str = "") -> None:
        super().__init__(name)
        self._datasets = as_datasets(datasets)
        pairs = find_pairs(self._datasets)
        likely = [pair for pair in pairs if pair.rank == pairs[0].rank]
        pair = likely[0] if pairs else None
        u, v = (None, None) if pair is None else (str(pair.u.name), str(pair.v.name))
        flow = read_flow(self._datasets, u, v, Record())
        first = variable(self._datasets, str(flow.pair.u.name))
        names = (f"{pair.u.name},{pair.v.name}" for pair in (flow.pair, *pairs))
        self.vectors = tuple(dict.fromkeys(names))
        if flow.places.is_earth:
            flat = projection_of(flow.places, None)[0].name
            self.blocks = tuple(dict.fromkeys((flat, GLOBE, *NAMES)))
            self.block_vectors = dict.fromkeys(self.blocks, self.vectors)
        self.block_word, self.reads_late = "Map", True
        self.axes = axis_values(first)
        if name := next(iter(self.axes), ""):
            self.default_plane = f"{name}={flow.drawn.numbers.get(name, 0)}"

    def plane_of(self, level: float | str) -> str:
        """Return the plane of a level, as :meth:`Source.plane_of` does."""
        names = two_names(self.vectors[0])
        array = next(ds[names["u"]] for ds in self._datasets if names["u"] in ds)
        drawn = choose(array, Choice({LEVEL: level}), Record())
        return f"{LEVEL}={drawn.numbers.get(LEVEL, 0)}"

    def part(self, block: str | None = None) -> Source:
        """Return this source, which draws on any of the maps."""
        if block is not None and block not in self.blocks:
            msg = f"block is {block!r}; expected one of {', '.join(self.blocks)}"
            raise FieldError(msg)
        return self

    def _field(
        self, vectors: str | None, plane: str | None, block: str | None, options: dict[str, Any]
    ) -> FlowField:
        names: dict[str, Any] = two_names(vectors or self.vectors[0])
        axis, _, number = (plane or self.default_plane).partition("=")
        array = next((ds[names["u"]] for ds in self._datasets if names["u"] in ds), None)
        if array is not None and axis in axis_values(array):
            options["isel"] = {**(options.get("isel") or {}), axis: int(number)}
        with warnings.catch_warnings():
            # The page shows the choices.
            warnings.simplefilter("ignore", DatasetNotice)
            return FlowField.from_xarray(
                self._datasets, **names, projection=block or None, name=self.name, **options
            )


def open_source(path: str | Path | Sequence[str | Path]) -> Source:
    """Open a file, or several of data of the Earth; errors start with the path."""
    paths = dataset_paths(path)
    if not paths:
        return FlowSource.from_file(one_path(path))
    with errors_of_file(paths[0]):
        return DatasetSource(open_datasets(paths), name=common_name(paths))
