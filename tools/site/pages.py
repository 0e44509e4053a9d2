"""Read the built site: what its pages link to, what they load, and their words."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from urllib.parse import unquote, urlsplit

from bs4 import BeautifulSoup, Tag

#: Attributes that name a file, by element; those of ``a`` lead, the others load.
ATTRIBUTES = {"src", "href", "poster", "data", "data-scene", "srcset"}
#: Links of the head that load nothing.
WORDS_OF_HEAD = {"index", "search", "next", "prev", "canonical", "author", "alternate"}
OUTSIDE = re.compile(r"(?:https?:)?//", re.IGNORECASE)
#: How styles, and scripts, would load something from outside.
LOADS = {
    ".css": re.compile(r"""(?:url\(|@import)\s*["']?\s*((?:https?:)?//[^"')\s]+)"""),
    ".js": re.compile(
        r"(?:importScripts\(|import\(|fetch\(|\.src\s*=|\bfrom|\bimport)"
        r"""\s*["'`]((?:https?:)?//[^"'`\s]+)"""
    ),
}
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
#: What is not a text: code, names of the reference, mathematics.
NO_WORDS = "pre, code, kbd, samp, script, style, svg, .math, .sig, .headerlink, dl.field-list dt"
#: Pages that list names alone.
LISTS = {"genindex.html", "py-modindex.html", "search.html"}
BLOCKS = ("p", "li", "dt", "dd", "td", "th", "h1", "h2", "h3", "h4", "figcaption", "summary")


@cache
def parsed(page: Path) -> BeautifulSoup:
    """Return a page as a tree."""
    return BeautifulSoup(page.read_text(encoding="utf-8"), "html.parser")


@cache
def anchors(page: Path) -> frozenset[str]:
    """Return the names that a link into a page may end with."""
    tags = parsed(page).select("[id], [name]")
    return frozenset(str(tag[key]) for tag in tags for key in ("id", "name") if tag.has_attr(key))


def lacks(page: Path, place: str) -> bool:
    """Return whether a page has no place of a name."""
    return bool(place) and page.suffix == ".html" and place not in anchors(page)


def references(page: Path) -> Iterator[tuple[Tag, str]]:
    """Give the elements of a page that name something elsewhere, and what."""
    for tag in parsed(page).select("*"):
        for name in ATTRIBUTES & set(tag.attrs):
            value = str(tag[name])
            if name == "srcset":
                yield from ((tag, part.split()[0]) for part in value.split(",") if part.strip())
            elif not (name == "data" and tag.name != "object"):
                yield tag, value


def loads(tag: Tag) -> bool:
    """Return whether a browser fetches what an element names."""
    if tag.name == "link":
        return not WORDS_OF_HEAD & set(tag.get_attribute_list("rel"))
    return tag.name not in ("a", "area", "form")


def broken(site: Path) -> Iterator[str]:
    """Give a sentence for each link that leads nowhere, and each thing from outside."""
    for page in pages(site):
        name = page.relative_to(site)
        for tag, value in references(page):
            if value.startswith(("data:", "mailto:", "javascript:", "blob:")):
                continue
            if OUTSIDE.match(value):
                if loads(tag):
                    yield f"{name}: <{tag.name}> loads {value} from outside"
                continue
            parts = urlsplit(value)
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                yield f"{name}: there is no {value}"
            elif lacks(target, unquote(parts.fragment)):
                yield f"{name}: {value} has no such place in it"
    for suffix, pattern in LOADS.items():
        for file in sorted(site.rglob(f"*{suffix}")):
            text = COMMENT.sub("", file.read_text(encoding="utf-8", errors="replace"))
            for found in pattern.finditer(text):
                yield f"{file.relative_to(site)}: loads {found[1]} from outside"


def pages(site: Path) -> list[Path]:
    """Return the pages of a site, without what the theme keeps beside its files."""
    names = (page.relative_to(site) for page in sorted(site.rglob("*.html")))
    return [site / name for name in names if not name.parts[0].startswith("_")]


def words(page: Path) -> str:
    """Return the text of a page, one paragraph a line, without code and names."""
    article = BeautifulSoup(str(parsed(page).find("article") or ""), "html.parser")
    for tag in article.select(NO_WORDS):
        tag.replace_with(" … ")
    for tag in article.find_all(BLOCKS):
        tag.append("\n")
    for image in article.find_all("img"):
        image.replace_with(f" {image.get('alt', '')}\n")
    lines = (" ".join(line.split()) for line in article.get_text().splitlines())
    return "\n".join(line for line in lines if line).replace("’", "'") + "\n"


def write_words(site: Path, folder: Path) -> int:
    """Write the text of every page into a folder, for the spell checker; return how many."""
    count = 0
    for page in pages(site):
        name = page.relative_to(site)
        if name.name in LISTS:
            continue
        file = (folder / name).with_suffix(".txt")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(words(page), encoding="utf-8")
        count += 1
    return count


if __name__ == "__main__":
    site, folder = (Path(word).resolve() for word in sys.argv[1:])
    faults = list(broken(site))
    count = write_words(site, folder)
    for fault in faults:
        print(f"  {fault}")  # noqa: T201
    print(f"  {count} pages, {len(faults)} faults of links")  # noqa: T201
    sys.exit(bool(faults))
