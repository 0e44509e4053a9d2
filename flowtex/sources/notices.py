"""Notices about choices in a dataset, issued at the caller's line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from flowtex import errors
from flowtex.errors import FieldError, Notice
from flowtex.field.field_arrays import STEPS, Reading, ReadingStep
from flowtex.remedies import Remedy, sentence

#: Entry of a dataset's encoding with a sentence for the record of its reading.
NOTE = "flowtex_note"


class DatasetNotice(Notice):
    """flowtex chose something in a dataset, such as a level.

    Examples
    --------
    >>> import warnings
    >>> import flowtex
    >>> from flowtex.sources.notices import DatasetNotice
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", DatasetNotice)
    ...     field = flowtex.FlowField.from_xarray(flowtex.examples.weather())
    """


def notify(text: str, remedies: Sequence[Remedy] = ()) -> None:
    """Warn at the line that called the package."""
    errors.notify(text, DatasetNotice, remedies)


def notify_section(section: Any) -> None:
    """Warn where a vertical section, as :attr:`FlowField.section` has it, is drawn without axes."""
    if section is not None:
        notify(
            f"this is a vertical section of {section.x} and {section.y}, which need independent "
            "axis scales; use flowtex.axes or ds.flowtex.plot instead"
        )


class Record:
    """Sentences about a reading, in the order of :data:`flowtex.field.field_arrays.STEPS`.

    Each step of a pipeline gets the record, and adds what it did:
    ``record("align", "v: latitude reversed to match u")``. A choice has a :class:`Remedy`, from
    which each front end makes text that can be typed.
    """

    def __init__(self) -> None:
        self._steps: list[ReadingStep] = []

    def __call__(
        self,
        step: str,
        text: str,
        *remedies: Remedy,
        notable: bool = False,
        caption: str = "",
    ) -> None:
        """Add a sentence once; a notable one is issued as a notice by :meth:`notify`.

        The remedies are the arguments by which users draw something else.
        """
        whole = sentence(text, remedies)
        for number, known in enumerate(self._steps):
            if known.text == whole:
                self._steps[number] = known._replace(notable=known.notable or notable)
                return
        self._steps.append(ReadingStep(step, whole, notable, caption, remedies))

    @property
    def reading(self) -> Reading:
        """The sentences so far."""
        return Reading(sorted(self._steps, key=lambda item: STEPS.index(item.step)))

    def notify(self) -> None:
        """Issue the notable sentences as notices, at the line that called the package."""
        for item in self.reading:
            if item.notable:
                notify(item.text, item.remedies)

    @contextmanager
    def explain(self) -> Iterator[None]:
        """Add what was done so far as a note to an error of the ``with`` block.

        Raises
        ------
        FieldError
            When the block raises one.
        """
        try:
            yield
        except FieldError as error:
            if self._steps:
                error.add_note(f"Read before the error:\n{self.reading}")
            raise
