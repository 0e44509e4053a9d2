"""What the measured pyramids cost, and what follows for larger ones, as the tables of a page.

Everything but the rows of measured figures is computed here, so that a new measurement changes all
of ``docs/scale.md``.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from flowtex.pyramid.layout import TILE_CELLS
from flowtex.textures.tiles.grid_levels import ROOT_NODES

ROOT = Path(__file__).resolve().parents[1]
RESULTS, PAGE = ROOT / "benchmarks" / "pyramid.json", ROOT / "docs" / "scale.md"
#: Fields and workers that are planned for.
FIELDS, WORKERS = (10**9, 10**11), (10, 1000)
#: Names of objects that one answer lists.
LISTED = 1000
#: Seconds of looking at a place before going to the next one.
STAY_S = 3.0
GB, MB = 1e9, 1e6

Row = tuple[str, ...]


def tables(kept: Mapping[str, Any]) -> dict[str, str]:
    """Return the tables of the page by their names, as Markdown."""
    results = sorted(kept.values(), key=_nodes)
    return {
        "measured": _table(["built", *map(_title, results)], _measured(results)),
        "unit costs": _table(["cost", *map(_title, results)], _unit_costs(results)),
        "reading": _table(["view", *map(_title, results)], _reading(results)),
        "pictures": _pictures(results),
        "plans": _plans(results[-1]),
    }


def write_docs(kept: Mapping[str, Any]) -> None:
    """Put the tables into the page, between the marks that name them."""
    text = PAGE.read_text(encoding="utf-8")
    for name, table in tables(kept).items():
        begin, end = f"<!-- {name}: made by benchmarks/pyramid.py -->", f"<!-- end of {name} -->"
        before, _, rest = text.partition(begin)
        _, _, after = rest.partition(end)
        text = f"{before}{begin}\n\n{table}\n\n{end}{after}"
    PAGE.write_text(text, encoding="utf-8")


def _measured(results: list[Any]) -> list[Row]:
    """Rows of what was measured."""

    def row(name: str, of: Any) -> Row:
        return (name, *(of(result, result["build"]) for result in results))

    return [
        row("tiles", lambda r, b: f"{b['tiles']:,}"),
        row("memory of a worker", lambda r, _: r["memory"]),
        row("source, GB", lambda r, _: f"{r['source']['bytes'] / GB:.2f}"),
        row("store, GB", lambda r, _: f"{r['store']['bytes'] / GB:.2f}"),
        row("objects", lambda r, _: f"{r['store']['objects']:,}"),
        row("time, min", lambda _, b: f"{b['seconds'] / 60:.1f}"),
        row("tasks", lambda _, b: f"{b['made']:,}"),
        row("worker killed at tile", lambda _, b: f"{b['killed_at_tile']:,}"),
        row("objects compared", lambda r, _: f"{r['compared']:,}" if "compared" in r else ""),
        row("the same as undisturbed", lambda r, _: _told(r.get("same"))),
        row("peak of a worker, MB", lambda _, b: f"{_peak(b, 'worker') / MB:.0f}"),
        row("peak of the scheduler, MB", lambda _, b: f"{_peak(b, 'scheduler') / MB:.0f}"),
        row("peak of the caller, MB", lambda _, b: f"{_peak(b, 'caller') / MB:.0f}"),
        row("requests", lambda _, b: f"{sum(b['requests'].values()):,}"),
    ]


def _unit_costs(results: list[Any]) -> list[Row]:
    costs = [Costs(result) for result in results]
    return [
        ("processor time of a node, µs", *(f"{1e6 * c.cpu:.1f}" for c in costs)),
        ("bytes read for a node", *(f"{c.read:.0f}" for c in costs)),
        ("bytes written for a node", *(f"{c.written:.0f}" for c in costs)),
        ("bytes stored for a node", *(f"{c.stored:.0f}" for c in costs)),
        ("shards a second, of both workers", *(f"{c.shards:.2f}" for c in costs)),
        ("seconds of a worker for a shard", *(f"{c.task:.2f}" for c in costs)),
        ("requests for a shard", *(f"{c.requests:.1f}" for c in costs)),
        ("time of the scheduler for a task, ms", *(f"{1e3 * c.scheduling:.1f}" for c in costs)),
        ("time of the caller for a task, ms", *(f"{1e3 * c.calling:.1f}" for c in costs)),
    ]


class Costs:
    """What a node, a shard and a task cost in one measurement."""

    def __init__(self, result: Mapping[str, Any]) -> None:
        build, nodes = result["build"], _nodes(result)
        #: Seconds of the processors of all workers, and bytes, for a node.
        self.cpu = build["worker_cpu_seconds"] / nodes
        self.read = sum(build["read"].values()) / nodes
        self.written = sum(build["written"].values()) / nodes
        self.stored = result["store"]["bytes"] / nodes
        #: Tasks and objects, of all levels.
        self.tasks, self.objects = build["made"] / nodes, result["store"]["objects"] / nodes
        self.shards = build["made"] / build["seconds"]
        self.task = build["worker_cpu_seconds"] / build["made"]
        self.requests = sum(build["requests"].values()) / build["made"]
        self.scheduling = build["scheduler_seconds_a_task"]
        self.calling = build["caller_seconds_a_task"]
        self.worker_peak = _peak(build, "worker")


def _reading(results: list[Any]) -> list[Row]:
    """Rows of what the browser took, where one was tried."""

    def row(name: str, of: Any) -> Row:
        return (name, *(of(r["browser"]) if "browser" in r else "" for r in results))

    def places(browser: Any, name: str) -> list[float]:
        return [place[name] for place in browser["places"]]

    def minute(browser: Any) -> float:
        """Bytes of arriving, and of a place after the other for a minute."""
        mean = sum(places(browser, "bytes")) / len(browser["places"])
        first = browser["page_bytes"] + browser["whole"]["bytes"]
        return float(first + 60 / STAY_S * mean)

    return [
        row("the whole, s", lambda b: f"{b['whole']['seconds']:.1f}"),
        row("the page, MB", lambda b: f"{b['page_bytes'] / MB:.1f}"),
        row("the whole, MB besides", lambda b: f"{b['whole']['bytes'] / MB:.1f}"),
        row("a place, median s", lambda b: f"{_middle(places(b, 'seconds')):.1f}"),
        row("a place, most s", lambda b: f"{max(places(b, 'seconds')):.1f}"),
        row("a place, mean MB", lambda b: f"{sum(places(b, 'bytes')) / len(b['places']) / MB:.1f}"),
        row("a pan around the Earth at zoom 64, MB", lambda b: f"{b['pan']['bytes'] / MB:.1f}"),
        row("requests of it", lambda b: f"{b['pan']['requests']:,}"),
        row("memory of the page, MB", lambda b: f"{_memory(b, 'renderer') / MB:.0f}"),
        row("memory of its drawing, MB", lambda b: f"{_memory(b, 'GPU') / MB:.0f}"),
        row("egress of a viewer's minute, MB", lambda b: f"{minute(b) / MB:.0f}"),
    ]


def _pictures(results: list[Any]) -> str:
    head = ["zoom"]
    for result in results:
        head += [f"{_title(result)}, s", "MB", "RMS"]
    rows: dict[int, list[str]] = {}
    for result in results:
        for one in result["pictures"]:
            rms = f"{one['rms']:.2f}" if "rms" in one else ""
            cells = [f"{one['seconds']:.1f}", f"{one['bytes'] / MB:.1f}", rms]
            rows.setdefault(one["zoom"], []).extend(cells)
    return _table(head, [(f"{zoom:,}", *cells) for zoom, cells in rows.items()])


def _plans(result: Mapping[str, Any]) -> str:
    """Return what follows from a measurement, if a node costs what it has cost there."""
    costs = Costs(result)
    plans = [(nodes, workers) for nodes in FIELDS for workers in WORKERS]
    head = ["plan", *(f"10^{round(math.log10(n))} nodes, {w:,} workers" for n, w in plans)]

    def row(name: str, of: Any) -> Row:
        return (name, *(of(nodes, workers) for nodes, workers in plans))

    def seconds(nodes: int, workers: int) -> float:
        return costs.cpu * nodes / workers

    def asked(nodes: int, workers: int) -> str:
        rate = costs.requests * costs.tasks * nodes / seconds(nodes, workers)
        return f"{rate:,.0f}"

    rows = [
        row("levels", lambda n, _: f"{depth(n) + 1}"),
        row("tasks", lambda n, _: _count(costs.tasks * n)),
        row("objects", lambda n, _: _count(costs.objects * n)),
        row("store, GB", lambda n, _: f"{costs.stored * n / GB:,.0f}"),
        row("read, GB", lambda n, _: f"{costs.read * n / GB:,.0f}"),
        row("written, GB", lambda n, _: f"{costs.written * n / GB:,.0f}"),
        row("processor time, h", lambda n, _: f"{costs.cpu * n / 3600:,.1f}"),
        row("time, h", lambda n, w: f"{seconds(n, w) / 3600:,.2f}"),
        row("memory of all workers, GB", lambda _, w: f"{costs.worker_peak * w / GB:,.0f}"),
        row("tasks a second", lambda n, w: f"{costs.tasks * n / seconds(n, w):,.1f}"),
        row("scheduler busy", lambda n, w: _share(costs.scheduling * costs.tasks * w / costs.cpu)),
        row("requests a second", asked),
        row("GB a second, read and written", lambda _, w: _rate(costs, w)),
        row("requests to list the tiles", lambda n, _: _count(4 / 3 * n / TILE_CELLS**2 / LISTED)),
    ]
    return _table(head, rows)


def depth(nodes: float) -> int:
    """Return the level of the root of a field of this many nodes."""
    return max(math.ceil(math.log(nodes / ROOT_NODES, 4)), 0)


def _rate(costs: Costs, workers: int) -> str:
    return f"{(costs.read + costs.written) / costs.cpu * workers / GB:,.2f}"


def _share(value: float) -> str:
    return f"{100 * value:.0f} %"


def _count(value: float) -> str:
    return f"{value:,.0f}" if value < 1e5 else f"{value / 1e6:,.1f} million"


def _nodes(result: Mapping[str, Any]) -> int:
    return int(math.prod(result["size"]))


def _title(result: Mapping[str, Any]) -> str:
    return " × ".join(f"{n:,}" for n in result["size"])


def _peak(build: Mapping[str, Any], kind: str) -> int:
    return max(peak for name, peak in build["peaks"].items() if name.startswith(kind))


def _memory(browser: Mapping[str, Any], kind: str) -> float:
    return float(browser["memory"].get(kind, 0))


def _middle(values: Iterable[float]) -> float:
    some = sorted(values)
    return some[len(some) // 2]


def _told(same: bool | None) -> str:  # noqa: FBT001
    return {None: "not compared", True: "yes", False: "no"}[same]


def _table(head: list[str], rows: Iterable[Row]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
