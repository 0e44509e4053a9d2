"""Run the experiments and write the page and the numbers."""

from __future__ import annotations

import json
import platform
import time
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util import __version__
from flowtex._util.progress import track
from paper.bench import Bench
from paper.findings import Claim, Finding, Panel, Report, Section
from paper.page import write_page
from paper.sections.level_of_detail import VORTEX_STEP
from paper.views import grey, view_of

#: Modules of ``paper.sections``, and the keys of their sections in the order of the page.
MODULES = (
    "table1",
    "table2",
    "table3",
    "redundancy",
    "figures_1_2",
    "figures_3_4",
    "figure6",
    "level_of_detail",
    "step_size",
    "zooms",
    "sample_counts",
    "camera_motion",
    "depth_cues",
    "computational_space",
)
ORDER = (
    *("table1", "table2", "table3", "redundancy"),
    *("figure1", "figure2", "figure3", "figure4", "figures34_others"),
    *("figure5", "figure6", "figure7", "figure8"),
    *("section41", "zooms", "samples", "moving", "depth", "stretched"),
)
#: Significant digits of a number: more would differ from one processor to the next.
DIGITS = 6
#: Title picture: time step of the vortices, colour map, and the part of the map that is used.
TITLE_STEP, TITLE_COLOURS, TITLE_PART = 24, "viridis", (0.12, 0.95)


class SectionError(ValueError):
    """There is no section of that key."""


def sections() -> list[Section]:
    """Every section, in order."""
    modules = (import_module(f"paper.sections.{name}") for name in MODULES)
    by_key = {section.key: section for module in modules for section in module.SECTIONS}
    return [by_key[key] for key in ORDER]


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
        All findings.

    Raises
    ------
    SectionError
        When there is no section of a key; nothing is computed then.
    OSError
        When the folder cannot be written.
    """
    selection = _selection(only)
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    bench = Bench(quick=quick, seed=seed, data=None if data is None else Path(data))
    findings: list[tuple[Section, Finding]] = []
    seconds: dict[str, float] = {}
    for section in track(selection, len(selection), "The paper", show=progress):
        start = time.perf_counter()
        findings.append((section, section.run(bench)))
        seconds[section.key] = time.perf_counter() - start
    report = Report(findings, _about(bench), seconds, _title_picture(bench))
    _write_numbers(report, target / "numbers.json")
    write_page(report, target)
    return report


def _selection(only: tuple[str, ...]) -> list[Section]:
    by_key = {section.key: section for section in sections()}
    wrong = [key for key in only if key not in by_key]
    if wrong:
        msg = f"there is no section {wrong[0]!r}; there are {', '.join(by_key)}"
        raise SectionError(msg)
    return [by_key[key] for key in only] if only else list(by_key.values())


def _about(bench: Bench) -> Mapping[str, Any]:
    return {
        "flowtex": __version__,
        "python": platform.python_version(),
        "quick": bench.quick,
        "seed": bench.seed,
        "post": bench.post is not None,
    }


def _title_picture(bench: Bench) -> Panel:
    """Draw a wide view of the vortices, coloured by speed."""
    import matplotlib as mpl

    size = bench.pick((1240, 420), (300, 102))
    step = bench.pick(TITLE_STEP, VORTEX_STEP)  # which has been traced
    view = view_of(bench, bench.vortex, size, zoom=size[0] / size[1] / 0.92, step=step)
    share = np.clip(view.speed / np.quantile(view.speed, 0.98), 0, 1)
    low, high = TITLE_PART
    colour = mpl.colormaps[TITLE_COLOURS](low + (high - low) * share)[..., :3]
    image = grey(view.picture(samples=31).value, colour)
    return Panel(image, "The vortex field, coloured by speed: every streak is a pathline.")


def _write_numbers(report: Report, path: Path) -> None:
    """Write ``numbers.json``.

    ``figures`` and the claims without ``timed`` are the same for the same seed; ``timings``, and
    the claims with it, are seconds of one run.
    """
    pairs = report.findings
    timings = {section.key: finding.timings for section, finding in pairs if finding.timings}
    document = {
        "about": report.about,
        "claims": [_claim(claim) for claim in report.claims],
        "figures": {section.key: finding.numbers for section, finding in pairs},
        "timings": {"sections": report.seconds, **timings},
    }
    text = json.dumps(_plain(document), indent=1, allow_nan=False)
    path.write_text(f"{text}\n", encoding="utf-8")


def _claim(claim: Claim) -> dict[str, Any]:
    names = ("name", "holds", "value", "bound", "sense", "unit", "text", "timed")
    return {name: getattr(claim, name) for name in names}


def _plain(value: Any) -> Any:
    """Take a value to what JSON has; numbers are rounded, and what is not finite is null."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None
    return value
