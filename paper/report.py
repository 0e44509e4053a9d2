"""All findings together, and the numbers as a file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from paper.findings import Claim, Finding, Panel
from paper.registry import Section

__all__ = ["Report", "write_numbers"]

#: Significant digits of a number: more would differ from one processor to the next.
DIGITS = 6


@dataclass(frozen=True)
class Report:
    """What a run found.

    Attributes
    ----------
    found
        Sections with their findings, in order.
    about
        What was run.
    seconds
        How long each section took.
    title
        The picture above all.
    """

    found: Sequence[tuple[Section, Finding]]
    about: Mapping[str, Any]
    seconds: Mapping[str, float]
    title: Panel

    @property
    def claims(self) -> list[Claim]:
        """Every claim, in order."""
        return [claim for _, finding in self.found for claim in finding.claims]


def write_numbers(report: Report, path: Path) -> None:
    """Write ``numbers.json``.

    ``figures`` and the claims without ``timed`` are the same for the same seed; ``timings``, and
    the claims with it, are seconds of one run.
    """
    written = {
        "about": report.about,
        "claims": [_claim(claim) for claim in report.claims],
        "figures": {section.key: finding.numbers for section, finding in report.found},
        "timings": {
            "sections": report.seconds,
            **{
                section.key: finding.timings for section, finding in report.found if finding.timings
            },
        },
    }
    path.write_text(json.dumps(_plain(written), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _claim(claim: Claim) -> dict[str, Any]:
    return {
        "name": claim.name,
        "holds": claim.holds,
        "value": claim.value,
        "bound": claim.bound,
        "sense": claim.sense,
        "unit": claim.unit,
        "text": claim.text,
        "timed": claim.timed,
    }


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
