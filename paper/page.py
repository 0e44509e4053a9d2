"""The page: one HTML file from the templates beside this module, its pictures in a folder."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from itertools import groupby
from pathlib import Path
from string import Template
from typing import Any

from paper.findings import Block, Claim, Finding, Panel, Plate, Plot, Report, Section, Table

TEMPLATES = Path(__file__).parent / "templates"
#: Folders of the pictures and of the plots, and the quality of JPEG files.
PICTURES, PLOTS, JPEG_QUALITY = "pictures", "plots", 88
#: Pictures less wide than this, in pixels, are shown pixel by pixel.
SMALL_WIDTH = 200


def write_page(report: Report, folder: Path) -> None:
    """Write ``index.html``, the pictures that it shows, and its plots once more as files."""
    for name in (PICTURES, PLOTS):
        (folder / name).mkdir(exist_ok=True)
    claims = report.claims
    values = {
        "style": _template("style.css").template,
        "contents": _contents(report),
        "holding": sum(claim.holds for claim in claims),
        "count": len(claims),
        "form": "quick" if report.about["quick"] else "full",
        "seed": report.about["seed"],
        "elapsed": _duration(sum(report.seconds.values())),
        "hero": _panel(report.title, "title.jpg", folder),
        "absent": "" if report.about["post"] else _template("absent.html").template,
        "statements": _statements(report),
        "sections": _sections(report, folder),
        "version": escape(str(report.about["flowtex"])),
        "python": escape(str(report.about["python"])),
    }
    (folder / "index.html").write_text(_template("page.html").substitute(values), encoding="utf-8")


def number(value: float) -> str:
    """Write a number with three significant digits."""
    if value != value:
        return "none"
    if abs(value) >= 1000:
        return f"{value:,.0f}"
    return f"{value:.3g}".replace("-", "−")


def _template(name: str) -> Template:
    return Template((TEMPLATES / name).read_text(encoding="utf-8"))


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def _contents(report: Report) -> str:
    """List the sections by part, each with a mark for its claims."""
    lists = ['<ul><li><a href="#statements"><span class="mark"></span>All statements</a></li></ul>']
    for part, group in groupby(report.findings, key=lambda pair: pair[0].part):
        rows = [
            f'<li><a href="#{section.key}"><span class="mark{_mark(finding)}"></span>'
            f"{escape(section.title)}</a></li>"
            for section, finding in group
        ]
        lists.append(f"<h2>{escape(part)}</h2>\n<ul>{''.join(rows)}</ul>")
    return "\n".join(lists)


def _mark(finding: Finding) -> str:
    if not finding.claims:
        return ""
    return " good" if all(claim.holds for claim in finding.claims) else " bad"


def _statements(report: Report) -> str:
    """List what does not hold, and below it, folded, all claims."""
    pairs = [(section, claim) for section, finding in report.findings for claim in finding.claims]
    failing = [(section, claim) for section, claim in pairs if not claim.holds]
    first = f"<h3>Does not hold</h3>{_rows(failing)}" if failing else "<p>All of them hold.</p>"
    return f"{first}<details><summary>All {len(pairs)} statements</summary>{_rows(pairs)}</details>"


def _rows(pairs: Sequence[tuple[Section, Claim]]) -> str:
    """Table of claims with links to their sections."""
    rows = [
        f"<tr><td>{_verdict(claim)}</td>"
        f'<td><a class="plain" href="#{section.key}">{escape(claim.text)}</a></td>'
        f'<td class="number">{_value(claim)}</td><td class="number">{_bound(claim)}</td></tr>'
        for section, claim in pairs
    ]
    head = (
        "<tr><th></th><th>statement</th>"
        '<th class="number">measured</th><th class="number">bound</th></tr>'
    )
    return f'<div class="scroll"><table>{head}{"".join(rows)}</table></div>'


def _sections(report: Report, folder: Path) -> str:
    parts = []
    for part, group in groupby(report.findings, key=lambda pair: pair[0].part):
        parts.append(f'<p class="part">{escape(part)}</p>')
        parts += [_section(section, finding, folder) for section, finding in group]
    return "\n".join(parts)


def _section(section: Section, finding: Finding, folder: Path) -> str:
    blocks = [
        _block(block, f"{section.key}-{count}", folder)
        for count, block in enumerate(finding.blocks, start=1)
    ]
    return _template("section.html").substitute(
        key=section.key,
        place=escape(section.place),
        title=escape(section.title),
        states=escape(section.states),
        computes=escape(section.computes),
        blocks="\n".join(blocks),
        claims=_claims(finding.claims),
    )


def _claims(claims: Sequence[Claim]) -> str:
    rows = [
        f"<li>{_verdict(claim)}<span>{escape(claim.text)}</span>"
        f'<span class="measured">{_value(claim)}<small>{_bound(claim)}</small></span></li>'
        for claim in claims
    ]
    return f'<ul class="claims">{"".join(rows)}</ul>' if rows else ""


def _verdict(claim: Claim) -> str:
    good = "good" if claim.holds else "bad"
    return f'<span class="verdict {good}">{"holds" if claim.holds else "does not"}</span>'


def _value(claim: Claim) -> str:
    timed = '<abbr title="a time of this run">timed</abbr> ' if claim.timed else ""
    return f"{timed}{number(claim.value)}{_unit(claim)}"


def _bound(claim: Claim) -> str:
    return f"{claim.sense} {number(claim.bound)}{_unit(claim)}"


def _unit(claim: Claim) -> str:
    return f" {escape(claim.unit)}" if claim.unit else ""


def _block(block: Block, name: str, folder: Path) -> str:
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Plate):
        return _plate(block, name, folder)
    if isinstance(block, Plot):
        caption = f"<figcaption>{escape(block.caption)}</figcaption>"
        alone = _standalone(block.svg)
        (folder / PLOTS / f"{name}.svg").write_text(alone, encoding="utf-8")
        return f'<figure class="plot">{_own_names(block.svg, name)}{caption}</figure>'
    return f"<p>{escape(block.text)}</p>"


def _standalone(svg: str) -> str:
    """Make a plot its own file, with the page's colours for light and dark."""
    colours = _template("style.css").template.split("* {", 1)[0].replace(":root", "svg")
    head, body = svg.split(">", 1)
    names = 'xmlns="http://www.w3.org/2000/svg" font-family="system-ui, sans-serif"'
    return f"{head} {names}><style>{colours}</style>{body}"


def _own_names(svg: str, name: str) -> str:
    """Make the names inside an SVG its own, as all plots of the page share one space of names."""
    for before in ('id="', 'href="#', "url(#"):
        svg = svg.replace(before, f"{before}{name}-")
    return svg


def _table(table: Table) -> str:
    kinds = ["number" if _numeric(table, at) else "text" for at in range(len(table.head))]

    def row(cells: Sequence[Any], tag: str) -> str:
        parts = (
            f'<{tag} class="{kind}">{_cell(cell)}</{tag}>'
            for cell, kind in zip(cells, kinds, strict=True)
        )
        return f"<tr>{''.join(parts)}</tr>"

    caption = f"<caption>{escape(table.caption)}</caption>" if table.caption else ""
    body = "".join(row(cells, "td") for cells in table.rows)
    return (
        f'<figure class="scroll"><table>{caption}<thead>{row(table.head, "th")}</thead>'
        f"<tbody>{body}</tbody></table></figure>"
    )


def _numeric(table: Table, column: int) -> bool:
    return any(isinstance(row[column], int | float) for row in table.rows)


def _cell(cell: Any) -> str:
    if cell is None:
        return "–"
    return number(float(cell)) if isinstance(cell, int | float) else escape(str(cell))


def _plate(plate: Plate, name: str, folder: Path) -> str:
    widths = " ".join(
        f"{panel.image.shape[1] / panel.image.shape[0]:.3f}fr" for panel in plate.panels
    )
    panels = [
        _panel(panel, f"{name}-{count}.jpg", folder)
        for count, panel in enumerate(plate.panels, start=1)
    ]
    caption = f"<figcaption>{escape(plate.caption)}</figcaption>" if plate.caption else ""
    return (
        f'<figure><div class="panels" style="grid-template-columns: {widths}">'
        f"{''.join(panels)}</div>{caption}</figure>"
    )


def _panel(panel: Panel, file: str, folder: Path) -> str:
    from PIL import Image

    picture = Image.fromarray(panel.image)
    picture.save(folder / PICTURES / file, quality=JPEG_QUALITY, optimize=True, subsampling=0)
    pixels = ' class="pixels"' if picture.width < SMALL_WIDTH else ""
    return (
        f'<div class="panel"><img{pixels} src="{PICTURES}/{file}" width="{picture.width}" '
        f'height="{picture.height}" loading="lazy" alt="{escape(panel.label)}">'
        f"<p>{escape(panel.label)}</p></div>"
    )
