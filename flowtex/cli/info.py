"""``flowtex info``: the contents of a file, and the flow that would be drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated

from flowtex._util.terminal import terminal
from flowtex.cli.console import load_field, typed
from flowtex.cli.options import FILE, FLAT, FieldFlags, UsageError, arguments

if TYPE_CHECKING:
    from pathlib import Path

    from rich.table import Table

    from flowtex.field import FlowField
    from flowtex.sources.read_files import FileSummary

#: Most times that are listed one by one.
MOST_TIMES = 8


def info(*files: FILE, flow: Annotated[FieldFlags | None, FLAT] = None) -> int:
    """Describe the contents of a file, and the flow that would be drawn.

    Raises
    ------
    UsageError
        When no file is given.
    """
    from rich.table import Table
    from rich.text import Text

    from flowtex.pyramid import is_store
    from flowtex.pyramid.places import is_remote, place_text
    from flowtex.pyramid.source import has_parts
    from flowtex.sources.opening.dataset_files import dataset_paths

    if not files:
        raise UsageError("no input file; usage: flowtex info FILE")
    options = arguments(flow)
    name = str(files[0])
    problem = ""
    tables = list[Table]()
    paths = None
    if len(files) == 1 and has_parts(files[0]):
        if is_remote(files[0]):
            name = place_text(files[0])
        if is_store(files[0]):
            tables.append(_store_table(files[0]))
    else:
        paths = dataset_paths(files)
        if paths:
            if len(files) > 1:
                name += f" and {len(files) - 1} more"
            tables.append(_recognised_table(paths))
        else:
            name, problem, tables = _mesh_tables(files, options.get("block"))
    console = terminal()
    console.print(Text(name, "bold"), soft_wrap=True)
    for table in tables:
        console.print(table)
    if problem and not options:
        console.print(Text(f"To draw it: {typed(problem)}", "yellow"))
    else:
        field = load_field(files, options)
        console.print(_field_table(field, has_reading=bool(paths)))
    return 0


def _mesh_tables(files: Sequence[Path], block: str | None) -> tuple[str, str, list[Table]]:
    """Return the name of a file with a mesh, what prevents drawing it, and its tables."""
    from flowtex.sources.read_files import describe, one_path

    file = files[0]
    if len(files) > 1:
        file = one_path(files)
    summary = describe(file, block)
    tables = [_file_table(summary)]
    if summary.blocks:
        tables.append(_block_table(summary))
    if summary.arrays:
        tables.append(_array_table(summary))
    return str(file), summary.problem, tables


def _table(*titles: str, right: tuple[str, ...] = ()) -> Table:
    """Return an empty table with titles, some of them at the right."""
    from rich.table import Table

    table = Table(box=None, header_style="dim")
    for title in titles:
        if title in right:
            table.add_column(title, justify="right")
        else:
            table.add_column(title, justify="left")
    return table


def _pairs(rows: Mapping[str, str], title: str = "") -> Table:
    """Return a table of labels and texts; rows without a text are left out."""
    table = _table("", "")
    table.title = title or None
    table.title_justify = "left"
    table.title_style = "bold"
    table.show_header = False
    table.columns[0].style = "dim"
    for label, text in rows.items():
        if text:
            table.add_row(label, text)
    return table


def _store_table(place: Path) -> Table:
    from flowtex.pyramid.levels import Levels

    about = Levels(place).about
    rows, columns = about["nodes"]
    state = "incomplete; build it again"
    if about.get("complete"):
        state = "complete"
    return _pairs(
        {
            "pyramid": f"{columns} × {rows} nodes, {about['depth'] + 1} levels",
            "times": str(len(about["times"])),
            "lines": f"{about['lines']} by {about['parameter']}",
            "scalars": ", ".join(about["scalars"]) or "none",
            "built": state,
        }
    )


def _recognised_table(paths: list[Path]) -> Table:
    """Return a table of what was recognised in dataset files."""
    from flowtex.sources.datasets.read_datasets import recognised
    from flowtex.sources.opening.dataset_files import open_datasets
    from flowtex.sources.reader_errors import errors_of_file

    with errors_of_file(paths[0]):
        return _pairs(recognised(open_datasets(paths)))


def _file_table(summary: FileSummary) -> Table:
    bounds = summary.bounds
    ends = []
    for axis, (low, high) in zip("xyz", bounds, strict=False):
        ends.append(f"{axis} {low:.4g} to {high:.4g}")
    rows = {"grid": summary.grid, "ends": "; ".join(ends)}
    if summary.size:
        rows["grid"] += ", " + summary.size.replace(" x ", " × ")
    if summary.volume:
        middle = 0.0
        if bounds:
            middle = sum(bounds[2]) / 2
        rows["cut by"] = f"--slice z={middle:.4g}, --contour NAME=VALUE"
    if summary.blanked:
        rows["blanked"] = f"{summary.blanked:,} nodes"
    if summary.blocks:
        rows["blocks"] = str(len(summary.blocks))
    if summary.times:
        rows["times"] = f"{len(summary.times)}: {_span_of(summary.times)}"
    rows["velocity"] = ", ".join(summary.candidates) or "none found"
    return _pairs(rows)


def _span_of(times: Sequence[float]) -> str:
    """Return times as text, of many only the first and the last."""
    if len(times) > MOST_TIMES:
        return f"{times[0]:g} to {times[-1]:g}"
    return ", ".join(f"{time:g}" for time in times)


def _block_table(summary: FileSummary) -> Table:
    table = _table("block", "name", "grid", "size")
    for block in summary.blocks:
        if block.number is None:
            number = ""
        else:
            number = str(block.number)
        size = block.size.removesuffix(" nodes").replace(" x ", " × ")
        table.add_row(number, block.name, block.grid, size)
    return table


def _array_table(summary: FileSummary) -> Table:
    if len(summary.times) > 1:
        moment = f" at t = {summary.times[0]:g}"
    else:
        moment = ""
    numbers = ("numbers", f"least{moment}", "greatest")
    table = _table("array", "on", *numbers, right=numbers)
    for array in summary.arrays:
        if array.parts:
            parts = f" = {', '.join(array.parts)}"
        else:
            parts = ""
        if array.since is not None:
            parts = f", from t = {array.since:g}"
        if array.components > 1:
            magnitude = " (magnitude)"
        else:
            magnitude = ""
        is_known = math.isfinite(array.low)
        if is_known:
            span = (f"{array.low:.4g}", f"{array.high:.4g}{magnitude}")
        else:
            span = ("", "")
        table.add_row(f"{array.name}{parts}", array.where, str(array.components), *span)
    return table


def _field_table(field: FlowField, *, has_reading: bool = False) -> Table:
    from flowtex.field.dates import expected_times
    from flowtex.field.derived.kinds import DERIVED
    from flowtex.textures.tiles.shared import has_pyramid
    from flowtex.trace.store import changing_share, chosen_lines

    rows = _size_rows(field)
    if field.steady:
        rows["times"] = "one, steady"
    else:
        ends = f"{field.times[0]:g} to {field.times[-1]:g} {field.time_unit}".rstrip()
        if field.start is not None:
            ends = expected_times(field.start, field.times)
        rows["times"] = f"{len(field.times)}, {ends}"
        rows["lines"] = (
            f"{chosen_lines(field)} (within a streak, the flow changes by half at "
            f"{changing_share(field):.0%} of the nodes)"
        )
    rows["blanked"] = f"{int((~field.valid).sum()):,} nodes"
    if field.sign_free:
        rows["signs"] = "none: v and -v mean the same"
    rows["scalars"] = ", ".join(dict.fromkeys(("speed", *field.scalars, *DERIVED)))
    shape = "flat"
    if field.surface.frame is None:
        shape = "curved"
    extent = f"{field.surface.extent:.4g} {field.length_unit}".rstrip()
    rows["surface"] = f"{shape}, {extent} across"
    rows["lost"] = f"{field.normal_share:.1%} of the flow is normal to the surface"
    title = "What would be drawn"
    if has_pyramid(field):
        title += " by default"
    table = _pairs(rows, title)
    if not has_reading:
        for step in field.reading:
            table.add_row(step.step, typed(step.text))
    return table


def _size_rows(field: FlowField) -> dict[str, str]:
    """Return rows about the nodes of a field, and about its triangles or its closed axes."""
    if field.triangles is not None:
        return {"nodes": f"{field.valid.size:,}", "triangles": f"{len(field.triangles):,}"}
    rows, columns = field.shape
    closed_rows, closed_columns = field.periodic
    closed = []
    if closed_columns:
        closed.append("i")
    if closed_rows:
        closed.append("j")
    return {
        "nodes": f"{columns} × {rows} (i × j)",
        "periodic": " and ".join(closed) or "no",
    }
