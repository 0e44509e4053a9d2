"""The experiments, in the order in which the page shows them.

A section is a module with a :class:`Section` by the name ``SECTION``. What it states of the paper
is told in own words, with the place where the paper says it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

from paper.bench import Bench
from paper.findings import Finding

__all__ = ["ORDER", "Section", "sections"]


@dataclass(frozen=True)
class Section:
    """One table, figure or experiment.

    Attributes
    ----------
    key
        Name in ``numbers.json`` and in the page's addresses.
    title
        Headline.
    place
        Where the paper says it: a section, table or figure.
    states
        What the paper states, in own words, with its numbers.
    computes
        What is computed here, and on what.
    run
        Does it.
    part
        Part of the page: what is reproduced, or what goes beyond.
    """

    key: str
    title: str
    place: str
    states: str
    computes: str
    run: Callable[[Bench], Finding]
    part: str = "The paper, reproduced"


#: Modules of the sections.
ORDER = (
    "table1",
    "table2",
    "table3",
    "redundancy",
    "figures_1_2",
    "figures_3_4",
    "figure5",
    "figure6",
    "figure7",
    "figure8",
    "step_size",
    "grain",
    "samples",
    "moving",
    "depth",
    "stretched",
)


def sections() -> list[Section]:
    """Every section, in order."""
    found: list[Section] = []
    for name in ORDER:
        module = import_module(f"paper.sections.{name}")
        found += module.SECTIONS
    return found
