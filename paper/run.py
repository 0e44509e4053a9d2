"""Runs the experiments and writes the page and the numbers."""

from __future__ import annotations

import platform
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flowtex._util.progress import track
from flowtex._version import __version__
from paper.bench import Bench
from paper.findings import Finding
from paper.page import write_page
from paper.registry import Section, sections
from paper.report import Report, write_numbers
from paper.title import title_picture

__all__ = ["SectionError", "reproduce"]


class SectionError(ValueError):
    """A section was asked for that there is not."""


def reproduce(
    folder: str | Path,
    *,
    quick: bool = False,
    seed: int = 0,
    data: str | Path | None = None,
    only: tuple[str, ...] = (),
    progress: bool = True,
) -> Report:
    """Compute every table and figure of the paper, and write them as a page.

    Parameters
    ----------
    folder
        Where ``index.html``, ``numbers.json`` and the folder ``pictures`` are written; made when
        it is not there.
    quick
        Whether to do the reduced form: smaller pictures, fewer particles and views.
    seed
        Number that every random choice follows from.
    data
        Folder of the liquid-oxygen post's files; by default the one that the environment
        variable ``FLOWTEX_DATA`` names, or else what PyVista downloads.
    only
        Keys of the sections to compute; all of them by default.
    progress
        Whether to show a progress bar.

    Returns
    -------
    Report
        What was found.

    Raises
    ------
    SectionError
        When there is no section of a key; nothing is computed then.
    OSError
        When the folder cannot be written.
    """
    chosen = _chosen(only)
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    bench = Bench(quick=quick, seed=seed, data=None if data is None else Path(data))
    found: list[tuple[Section, Finding]] = []
    seconds: dict[str, float] = {}
    for section in track(chosen, len(chosen), "The paper", show=progress):
        started = time.perf_counter()
        found.append((section, section.run(bench)))
        seconds[section.key] = time.perf_counter() - started
    report = Report(found, _about(bench), seconds, title_picture(bench))
    write_numbers(report, place / "numbers.json")
    write_page(report, place)
    return report


def _chosen(only: tuple[str, ...]) -> list[Section]:
    known = {section.key: section for section in sections()}
    wrong = [key for key in only if key not in known]
    if wrong:
        msg = f"there is no section {wrong[0]!r}; there are {', '.join(known)}"
        raise SectionError(msg)
    return [known[key] for key in only] if only else list(known.values())


def _about(bench: Bench) -> Mapping[str, Any]:
    """Tell what was run."""
    return {
        "flowtex": __version__,
        "python": platform.python_version(),
        "quick": bench.quick,
        "seed": bench.seed,
        "post": bench.post is not None,
    }
