"""``python -m paper --quick``: every section, its claims, its numbers, and the page."""

from __future__ import annotations

import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from paper import reproduce, sections
from paper.__main__ import main
from paper.findings import Panel

pytestmark = pytest.mark.slow  #: The quick form takes half a minute, once.

#: Statements of the paper that do not hold here, in the quick form.
FAILING = {
    "frame_rate",  # a software rasteriser draws it
    "redundancy_post",
    "redundancy_shuttle",
    "redundancy_vortex",
    "figure3_slices_more_accurate_at_last",
    "figure3_slices_errors_bounded",
    "figure4_slices_more_accurate_at_last",
    "figure4_slices_errors_bounded",
    "double_gyre_100x50_slices_more_accurate",
    "figure6_no_stretched_pattern_with_levels",
}
CHEAP = ("table3", "figure2")  #: Sections that are quick to compute once more.


class Page(HTMLParser):
    """Addresses, identifiers and pictures of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.names: list[str] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        self.addresses += [v for k, v in attrs if k in ("href", "src", "xlink:href") and v]
        if values.get("id"):
            self.names.append(str(values["id"]))


@pytest.fixture(scope="module")
def data() -> Path | None:
    """Folder of the post's files; one without them where there are none, so nothing is fetched."""
    named = os.environ.get("FLOWTEX_DATA")
    return Path(named) if named else None


@pytest.fixture(scope="module")
def page_folder(data: Path | None, opengl: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("paper") / "page"
    empty = tmp_path_factory.mktemp("empty")
    words = ["-o", folder, "--quick", "--data", data or empty]
    assert main([str(word) for word in words]) == 0
    return folder


@pytest.fixture(scope="module")
def numbers(page_folder: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(
        (page_folder / "numbers.json").read_text(encoding="utf-8")
    )
    return document


@pytest.fixture(scope="module")
def text(page_folder: Path) -> str:
    return (page_folder / "index.html").read_text(encoding="utf-8")


def test_claims_are_numbers_with_bounds_and_judged_by_them(numbers: dict[str, Any]) -> None:
    names = [claim["name"] for claim in numbers["claims"]]
    assert len(names) == len(set(names)) > 50
    for claim in numbers["claims"]:
        value, bound = claim["value"], claim["bound"]
        assert isinstance(value, int | float), claim["name"]
        holds = value <= bound if claim["sense"] == "at most" else value >= bound
        assert claim["holds"] == holds, claim["name"]
        assert claim["text"].endswith((".", ")"))


def test_what_holds_is_what_was_found_to_hold(numbers: dict[str, Any]) -> None:
    # Times are the machine's and not the method's.
    failing = {c["name"] for c in numbers["claims"] if not c["holds"] and not c["timed"]}
    known = FAILING - {"frame_rate"}
    if not numbers["about"]["post"]:
        known = {name for name in known if "post" not in name}
    assert failing == known


def test_every_section_has_figures_and_stands_on_the_page(
    numbers: dict[str, Any], text: str
) -> None:
    page = Page(text)
    assert len(page.names) == len(set(page.names))
    for section in sections():
        assert section.key in page.names
        assert f"#{section.key}" in page.addresses
        assert section.key in numbers["figures"]
    for claim in numbers["claims"]:
        assert text.count(f">{claim['text']}<".replace("'", "&#x27;").replace('"', "&quot;")) >= 2


def test_the_page_needs_nothing_from_outside(page_folder: Path, text: str) -> None:
    page = Page(text)
    files = [a for a in page.addresses if not a.startswith(("#", "data:"))]
    assert [file for file in files if not (page_folder / file).is_file()] == []
    targets = {a[1:] for a in page.addresses if a.startswith("#")}
    targets |= set(re.findall(r"url\(#([^)]+)\)", text))
    assert targets <= set(page.names)
    assert not re.search(r"(?:src|href)\s*=\s*[\"']?(?:https?:)?//", text)
    assert not re.search(r"url\(\s*[\"']?(?!#)", text)
    assert "<script" not in text
    pictures = {f"pictures/{path.name}" for path in (page_folder / "pictures").iterdir()}
    assert len(pictures) > 30 and pictures <= set(page.addresses)
    # Plots take their colours from the page.
    assert "prefers-color-scheme: dark" in text
    assert text.count("<svg") >= 8
    plots = "".join(re.findall(r"<svg.*?</svg>", text, re.DOTALL))
    assert "var(--c0)" in plots and "var(--ink)" in plots
    # A marker colour that was not replaced would not follow from light to dark.
    assert not re.search(r"#0[1-4]0[1-4]0[1-4]|#11111", plots)


@pytest.fixture
def plain_title(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the title's picture, whose vortices would be traced for each page."""
    panel = Panel(np.zeros((4, 4, 3), np.uint8), "Nothing.")
    monkeypatch.setattr("paper.run._title_picture", lambda bench: panel)


@pytest.mark.usefixtures("plain_title")
def test_numbers_repeat_for_a_seed_and_differ_for_another(
    numbers: dict[str, Any], data: Path | None, tmp_path: Path
) -> None:
    figures_of = {}
    for name, seed, only in (("again", 0, CHEAP), ("other", 5, ("figure2",))):
        place = tmp_path / name
        reproduce(place, quick=True, seed=seed, data=data or tmp_path, only=only, progress=False)
        text = (place / "numbers.json").read_text(encoding="utf-8")
        figures_of[name] = json.loads(text)["figures"]
    for key in CHEAP:
        assert figures_of["again"][key] == numbers["figures"][key], key
    for key, figures in figures_of["other"].items():
        assert figures != numbers["figures"][key], key


@pytest.mark.usefixtures("plain_title")
def test_the_post_is_missed_in_words(tmp_path: Path) -> None:
    page = tmp_path / "page"
    reproduce(page, quick=True, data=tmp_path, only=("table1", "figure5"), progress=False)
    text = (page / "index.html").read_text(encoding="utf-8")
    assert "The liquid-oxygen post is not on this page." in text
    document = json.loads((page / "numbers.json").read_text(encoding="utf-8"))
    assert document["about"]["post"] is False
    assert set(document["figures"]["table1"]) == {"shuttle", "vortex"}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--seed", "-1"), "--seed is -1; expected 0 or more"),
        (("--only", "figure9"), "--only: there is no section 'figure9'"),
        (("-o", __file__), "expected a folder"),
    ],
)
def test_invalid_arguments_of_the_command_are_named(
    words: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["-o", str(tmp_path), *words])
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
