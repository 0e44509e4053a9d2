"""The record of a reading: one sentence for each thing that was done to the data."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from flowtex.errors import FieldError
from flowtex.field.arrays import STEPS, Reading, ReadingStep
from flowtex.sources.notices import notify


class Record:
    """Sentences about a reading, in the order of :data:`flowtex.field.arrays.STEPS`.

    Each step of a pipeline gets the record, and adds what it did:
    ``record("align", "v: latitude reversed to match u")``.
    """

    def __init__(self) -> None:
        self._steps: dict[ReadingStep, None] = {}

    def __call__(self, step: str, text: str, *, notable: bool = False, caption: str = "") -> None:
        """Add a sentence once; a notable one is issued as a notice by :meth:`notify`."""
        self._steps[ReadingStep(step, text, notable, caption)] = None

    @property
    def reading(self) -> Reading:
        """The sentences so far."""
        return Reading(sorted(self._steps, key=lambda item: STEPS.index(item.step)))

    def notify(self) -> None:
        """Issue the notable sentences as notices, at the line that called the package."""
        for item in self.reading:
            if item.notable:
                notify(item.text)

    @contextmanager
    def explain(self) -> Iterator[None]:
        """Add what was done so far as a note to an error in the block."""
        try:
            yield
        except FieldError as error:
            if self._steps:
                error.add_note(f"Read before the error:\n{self.reading}")
            raise
