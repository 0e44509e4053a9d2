"""The paper, reproduced and measured: ``make paper``, or ``python -m paper -o DIR``.

Every table and figure of *View-Dependent Multi-resolutional Flow Texture Advection*, by Li and
Shen, computed by flowtex, beside what the paper reports, and what goes beyond it. Each statement
of the paper is a check with a number. It is not a part of the installed package.

    run.py                  the sections in order, ``numbers.json``
    sections/               a module for each experiment
    bench.py, data_sets.py  what the experiments share: scale, seed, fields, textures
    views.py                a field seen by a camera, drawn by the renderer in NumPy
    measures.py             direction, grain and aliasing of a picture
    position_errors.py      errors of particle positions from coarser slices and fields
    redundancy/             a slice predicted from slices of shorter lag, and what is left of it
    references/             methods of the related work
    findings.py             claims, tables, pictures and plots as data
    plots.py, page.py       plots and the page, from ``templates``
"""

from __future__ import annotations

from paper.findings import Report
from paper.run import SectionError, reproduce, sections

__all__ = ["Report", "SectionError", "reproduce", "sections"]
