"""How Sphinx makes the site from this folder: ``make docs``. Nothing is loaded from elsewhere while it builds."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pneutouch

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "pneutouch"
author = "the pneutouch authors"
project_copyright = "the pneutouch authors, Apache-2.0"
version = release = pneutouch.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "formats_table",
    "mathml",
    "page_titles",
    "reference_pages",
]
exclude_patterns = ["_build", "_ext", "examples", "**/README.rst", "gallery/*.ipynb"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
nitpicky = True
# Types of other packages, whose pages are elsewhere, and of the package's inside, which no page documents; those that a
# module imports for a type checker alone have their bare names.
nitpick_ignore_regex = [
    ("py:class", "Axes|DataFrame|Path"),
    ("py:class", "CalibrationOutcome|CompareResult|DrivingRecord|Evaluation|Rating|SelectedRecord|StateRecord"),
    ("py:class", "PadModel|ResolvedPad"),
    ("py:.*", r"(collections|matplotlib|numpy|os|pandas|pathlib|typing|xarray)\..*"),
    ("py:.*", r"pneutouch\.(arrays|body|catalogue|evaluation|mechanics|parts|printability|results|workflows)\..*"),
]
keep_warnings = False

myst_enable_extensions = ["dollarmath", "deflist", "fieldlist"]
myst_heading_anchors = 4

autosummary_generate = True
autodoc_typehints = "description"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
napoleon_google_docstring = True

html_math_renderer = "mathml"
html_theme = "pydata_sphinx_theme"
html_title = "pneutouch"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
html_theme_options = {
    "navigation_depth": 2,
    "show_toc_level": 2,
    "header_links_before_dropdown": 6,
    "navbar_align": "left",
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
}

sphinx_gallery_conf = {
    "examples_dirs": ["gallery"],
    "gallery_dirs": ["auto_gallery"],
    "filename_pattern": r".*\.py",
    "ignore_pattern": r"__init__\.py",
    "abort_on_example_error": True,
    "only_warn_on_example_error": False,
    "remove_config_comments": True,
    "download_all_examples": True,
    "show_memory": False,
    # The last value of a block is no result: a legend, a list of lines.
    "capture_repr": (),
    "write_computation_times": False,
    "min_reported_time": 1e9,
    "subsection_order": [
        f"gallery/{name}" for name in ("designs", "choosing", "contact", "materials", "making", "measuring")
    ],
    "within_subsection_order": "FileNameSortKey",
    "parallel": int(os.environ.get("PNEUTOUCH_DOCS_JOBS", "2")),
    "image_srcset": [],
}
