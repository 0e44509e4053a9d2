"""The paper, reproduced and measured: ``flowtex paper``.

Every table and figure of *View-Dependent Multi-resolutional Flow Texture Advection*, by Li and
Shen, computed by this package, beside what the paper reports, and what goes beyond it. Each
statement of the paper is a check with a number.

    registry.py    the sections in order; a module in ``sections`` for each experiment
    bench.py       what they share: scale, seed, fields, textures
    shots.py       views of a flow, drawn by the renderer in NumPy, and the flow in them
    measures.py    what a picture shows, in figures
    plots.py       plots in the style of the page
    page.py        the page, from ``templates``
"""

from __future__ import annotations

from paper.report import Report
from paper.run import SectionError, reproduce

__all__ = ["Report", "SectionError", "reproduce"]
