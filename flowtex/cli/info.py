"""``flowtex info``: the contents of a file, and the flow that would be drawn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

from flowtex._util.terminal import terminal
from flowtex.cli.console import in_flags, load_field
from flowtex.cli.options import FILE, FLAT, FieldFlags, UsageError, arguments

if TYPE_CHECKING:
    from pathlib import Path

    from rich.table import Table

    from flowtex.field import FlowField
    from flowtex.sources.read_files import FileSummary

#: Most times that are listed one by one.
MOST_TIMES = 8
#: Most blocks that are listed.
MOST_BLOCKS = 40


def info(*files: FILE, flow: Annotated[FieldFlags | None, FLAT] = None) -> int:
    """Describe the contents of a file, and the flow that would be drawn."""
    from rich.text import Text

    from flowtex.pyramid import is_store
    from flowtex.pyramid.places import is_remote, place_text
    from flowtex.pyramid.source import has_parts
    from flowtex.sources.opening.dataset_files import dataset_paths
    from flowtex.sources.read_files import describe, one_path

    console, options = terminal(), arguments(flow)
    if len(files) == 1 and has_parts(files[0]):
        name = place_text(files[0]) if is_remote(files[0]) else str(files[0])
        console.print(Text(name, "bold"), soft_wrap=True)
        if is_store(files[0]):
            console.print(_store_table(files[0]))
        console.print(_field_table(load_field(files, options)))
        return 0
    if paths := dataset_paths(files):
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        console.print(Text(f"{files[0]}{more}", "bold"), soft_wrap=True)
        console.print(_recognised_table(paths))
        console.print(_field_table(load_field(files, options), has_reading=True))
        return 0
    if not files:
        raise UsageError("no input file; usage: flowtex info FILE")
    file = files[0] if len(files) == 1 else one_path(files)
    summary = describe(file, options.get("block"))
    console.print(Text(str(file), "bold"), soft_wrap=True)
    console.print(_file_table(summary))
    if summary.blocks:
        console.print(_block_table(summary))
    if summary.arrays:
        console.print(_array_table(summary))
    if summary.problem and not options:
        console.print(Text(f"To draw it: {in_flags(summary.problem)}", "yellow"))
        return 0
    console.print(_field_table(load_field(files, options)))
    return 0


def _table(*titles: str, right: tuple[str, ...] = ()) -> Table:
    from rich.table import Table

    table = Table(box=None, header_style="dim")
    for title in titles:
        table.add_column(title, justify="right" if title in right else "left")
    return table


def _pairs(title: str = "") -> Table:
    table = _table("", "")
    table.title, table.title_justify, table.title_style = title or None, "left", "bold"
    table.show_header, table.columns[0].style = False, "dim"
    return table


def _store_table(place: Path) -> Table:
    from flowtex.pyramid.levels import Levels

    about = Levels(place).about
    table = _pairs()
    rows, columns = about["nodes"]
    table.add_row("pyramid", f"{columns} × {rows} nodes, {about['depth'] + 1} levels")
    table.add_row("times", str(len(about["times"])))
    table.add_row("lines", f"{about['lines']} by {about['parameter']}")
    table.add_row("scalars", ", ".join(about["scalars"]) or "none")
    table.add_row("built", "complete" if about.get("complete") else "incomplete; build it again")
    return table


def _recognised_table(paths: list[Path]) -> Table:
    from flowtex.sources.datasets.read_datasets import recognised
    from flowtex.sources.opening.dataset_files import open_datasets
    from flowtex.sources.reader_errors import errors_of_file

    table = _pairs()
    with errors_of_file(paths[0]):
        for row in recognised(open_datasets(paths)).items():
            table.add_row(*row)
    return table


def _file_table(summary: FileSummary) -> Table:
    table = _pairs()
    size = summary.size.replace(" x ", " × ")
    table.add_row("grid", f"{summary.grid}{f', {size}' if size else ''}")
    if summary.cells:
        table.add_row("cells", ", ".join(f"{n:,} × {name}" for name, n in summary.cells.items()))
    if summary.bounds:
        spans = zip("xyz", summary.bounds, strict=True)
        ends = "; ".join(f"{axis} {low:.4g} to {high:.4g}" for axis, (low, high) in spans)
        table.add_row("ends", ends)
    if summary.volume:
        low, high = summary.bounds[2]
        table.add_row("cut by", f"--slice z={(low + high) / 2:.4g}, --contour NAME=VALUE")
    if summary.blanked:
        table.add_row("blanked", f"{summary.blanked:,} nodes")
    if summary.blocks:
        table.add_row("blocks", str(len(summary.blocks)))
    if summary.times:
        is_short = len(summary.times) <= MOST_TIMES
        ends = f"{summary.times[0]:g} to {summary.times[-1]:g}"
        listed = ", ".join(f"{time:g}" for time in summary.times) if is_short else ends
        table.add_row("times", f"{len(summary.times)}: {listed}")
    table.add_row("velocity", ", ".join(summary.candidates) or "none found")
    return table


def _block_table(summary: FileSummary) -> Table:
    table = _table("block", "name", "grid", "size")
    for block in summary.blocks[:MOST_BLOCKS]:
        number = "" if block.number is None else str(block.number)
        size = block.size.removesuffix(" nodes").replace(" x ", " × ")
        table.add_row(number, block.name, block.grid, size)
    if len(summary.blocks) > MOST_BLOCKS:
        table.add_row("", f"and {len(summary.blocks) - MOST_BLOCKS} more", "", "")
    return table


def _array_table(summary: FileSummary) -> Table:
    moment = f" at t = {summary.times[0]:g}" if len(summary.times) > 1 else ""
    numbers = ("numbers", f"least{moment}", "greatest")
    table = _table("array", "on", *numbers, right=numbers)
    for array in summary.arrays:
        parts = f" = {', '.join(array.parts)}" if array.parts else ""
        magnitude = " (magnitude)" if array.components > 1 else ""
        is_known = math.isfinite(array.low)
        span = (f"{array.low:.4g}", f"{array.high:.4g}{magnitude}") if is_known else ("", "")
        table.add_row(f"{array.name}{parts}", array.where, str(array.components), *span)
    return table


def _field_table(field: FlowField, *, has_reading: bool = False) -> Table:
    from flowtex.field.dates import expected_times
    from flowtex.field.derived import DERIVED
    from flowtex.textures.tiles.shared import has_pyramid
    from flowtex.trace.store import changing_share, chosen_lines

    table = _pairs(
        "What would be drawn by default" if has_pyramid(field) else "What would be drawn"
    )
    if field.triangles is None:
        rows, columns = field.shape
        table.add_row("nodes", f"{columns} × {rows} (i × j)")
    else:
        table.add_row("nodes", f"{field.valid.size:,}")
        table.add_row("triangles", f"{len(field.triangles):,}")
    steady = "one, steady"
    ends = f"{field.times[0]:g} to {field.times[-1]:g} {field.time_unit}".rstrip()
    if field.start is not None:
        ends = expected_times(field.start, field.times)
    table.add_row("times", steady if field.steady else f"{len(field.times)}, {ends}")
    if not field.steady:
        share = f"{changing_share(field):.0%} of the nodes)"
        text = f"{chosen_lines(field)} (within a streak, the flow changes by half at {share}"
        table.add_row("lines", text)
    if field.triangles is None:
        closed = [a for a, is_closed in zip("ji", field.periodic, strict=True) if is_closed]
        table.add_row("periodic", " and ".join(sorted(closed)) or "no")
    table.add_row("blanked", f"{int((~field.valid).sum()):,} nodes")
    if field.sign_free:
        table.add_row("signs", "none: v and -v mean the same")
    table.add_row("scalars", ", ".join(dict.fromkeys(("speed", *field.scalars, *DERIVED))))
    shape = "curved" if field.surface.frame is None else "flat"
    table.add_row(
        "surface", f"{shape}, {field.surface.extent:.4g} {field.length_unit}".rstrip() + " across"
    )
    table.add_row("lost", f"{field.normal_share:.1%} of the flow is normal to the surface")
    for step in () if has_reading else field.reading:
        table.add_row(step.step, step.text)
    return table
