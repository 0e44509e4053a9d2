"""The site: ``make site`` builds it with Sphinx into ``out/site``."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import live

from flowtex import __version__

HERE = Path(__file__).parent
about = tomllib.loads((HERE.parent / "pyproject.toml").read_text())["project"]

project = "flowtex"
author = "flowtex developers"
project_copyright = "flowtex developers"
version = release = __version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.intersphinx",
    "numpydoc",
    "cyclopts.ext.sphinx",
    "myst_nb",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "live",
    "lessons",
    "outside",
]
#: Where the project lies; links to files outside of these pages lead there.
repository = about["urls"]["Repository"]
# Beside the pages of the examples lie their notebooks, for those who download them.
exclude_patterns = [
    "examples",
    "gallery.md",
    *(f"gallery/**/*.{kind}" for kind in ("ipynb", "py", "json")),
]
suppress_warnings = ["config.cache"]  # what draws the examples is no plain value

myst_enable_extensions = ["colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 3
nb_execution_mode = "force"  # what is shown is written beside the pages at each run
# Notebooks that are pages, in the folder lessons.
lessons_notebooks = [
    "lesson_1_flow_textures",
    "lesson_2_level_of_detail",
    "lesson_3_steady_and_unsteady",
    "lesson_4_which_way",
    "lesson_5_phase_portraits",
    "lesson_6_derived_quantities",
]
nb_merge_streams = True
nb_execution_timeout = 120
nb_execution_raise_on_error = True
nb_ipywidgets_js: dict[str, str] = {}  # what is live here needs no kernel and no network
nb_mime_priority_overrides = [("html", "text/html", 0)]

templates_path = ["_templates"]
autosummary_generate = True
# On disks that do not tell capitals from small letters it would be the file of movie.
autosummary_filename_map = {"flowtex.Movie": "flowtex.Movie-class"}
autodoc_typehints = "none"
numpydoc_class_members_toctree = False
numpydoc_show_class_members = False
# Of the types in docstrings the classes of the reference become links, and these of others.
public = re.findall(
    r"^   (flowtex\.[\w.]+)$",
    "\n".join(page.read_text() for page in sorted(HERE.glob("reference/*.md"))),
    re.MULTILINE,
)
others = ("numpy.ndarray", "pyvista.StructuredGrid", "xarray.Dataset", "bool", "pathlib.Path")
numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"
numpydoc_xref_aliases = {
    **{short: name for name in public if (short := name.rsplit(".", 1)[1])[0].isupper()},
    **{name: f":class:`{name}`" for name in others},
    **{"boolean": ":class:`bool`", "array_like": ":data:`~numpy.typing.ArrayLike`"},
}
nitpicky = True

# Inventories of the few names that docstrings use are kept here, as text, so that a build needs no
# network.
intersphinx_mapping = {
    "python": ("https://docs.python.org/3", "inventories/python.inv"),
    "numpy": ("https://numpy.org/doc/stable", "inventories/numpy.inv"),
    "pyvista": ("https://docs.pyvista.org", "inventories/pyvista.inv"),
    "xarray": ("https://docs.xarray.dev/en/stable", "inventories/xarray.inv"),
}

sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r".*\.py",
    "image_scrapers": (live.Scraper(),),
    "reset_modules": (live.reset,),
    "capture_repr": (),
    "remove_config_comments": True,
    "show_memory": False,
    "min_reported_time": 1e9,
    "show_signature": False,
    "download_all_examples": False,
    "thumbnail_size": live.THUMBNAIL,
    "within_subsection_order": "FileNameSortKey",
    "subsection_order": [f"examples/{name}" for name in live.SECTIONS],
    "write_computation_times": False,
}

html_theme = "pydata_sphinx_theme"
# Pages without further ones below them have no section beside them.
html_sidebars: dict[str, list[str]] = {name: [] for name in ("index", "start")}
html_title = "flowtex"
html_favicon = "_static/favicon.svg"
html_static_path = ["_static"]
smartquotes = False  # a setting's 'hann' is to be copied as it is
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_show_sourcelink = html_copy_source = False
html_theme_options = {
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "footer_start": ["copyright"],
    "footer_end": ["theme-version"],
}
