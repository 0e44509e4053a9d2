"""What an experiment is, and what it hands to the page: claims, tables, pictures, numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from flowtex._util.array_types import Bytes
from paper.bench import Bench

Sense = Literal["at most", "at least"]


@dataclass(frozen=True)
class Claim:
    """A statement of the paper as a number and what the number must be.

    Attributes
    ----------
    name
        Short name in ``numbers.json``.
    text
        The statement, in own words.
    value
        What was measured.
    bound
        What it is compared with.
    sense
        ``"at most"`` or ``"at least"``: on which side of the bound the statement holds.
    unit
        Unit of both, for the page.
    timed
        Whether the value is a time, which differs from run to run.
    """

    name: str
    text: str
    value: float
    bound: float
    sense: Sense = "at most"
    unit: str = ""
    timed: bool = False

    @property
    def holds(self) -> bool:
        """Whether the value lies on the right side of the bound; NaN never does."""
        return bool(
            self.value <= self.bound if self.sense == "at most" else self.value >= self.bound
        )


@dataclass(frozen=True)
class Table:
    """Rows under a head; numbers are set to the right."""

    head: Sequence[str]
    rows: Sequence[Sequence[Any]]
    caption: str = ""


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture, (H, W, 3) uint8, with what is written under it."""

    image: Bytes
    label: str


@dataclass(frozen=True)
class Plate:
    """Pictures side by side, with a caption."""

    panels: Sequence[Panel]
    caption: str = ""


@dataclass(frozen=True)
class Plot:
    """A drawing as SVG text, with a caption and what it shows in words for those who do not see."""

    svg: str
    caption: str
    alt: str


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str


Block = Table | Plate | Plot | Text


@dataclass(frozen=True)
class Finding:
    """What came of one experiment.

    Attributes
    ----------
    blocks
        What is shown, in order.
    numbers
        What was measured, as nested dictionaries of plain numbers; the same for the same seed.
    claims
        Statements of the paper that were put to the test.
    timings
        Seconds and rates, which differ from run to run.
    """

    blocks: Sequence[Block]
    numbers: Mapping[str, Any] = field(default_factory=dict)
    claims: Sequence[Claim] = ()
    timings: Mapping[str, Any] = field(default_factory=dict)


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


@dataclass(frozen=True)
class Report:
    """All findings of a run.

    Attributes
    ----------
    findings
        Sections with their findings, in order.
    about
        Version, Python, form, seed, and whether the post was there.
    seconds
        Seconds that each section took.
    title
        The picture above all.
    """

    findings: Sequence[tuple[Section, Finding]]
    about: Mapping[str, Any]
    seconds: Mapping[str, float]
    title: Panel

    @property
    def claims(self) -> list[Claim]:
        """Every claim, in order."""
        return [claim for _, finding in self.findings for claim in finding.claims]
